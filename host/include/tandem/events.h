/* events.h - what a step reports: contacts and neighbours that begin and end, bodies that stopped being finite. */
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <tandem/export.h>
#include <tandem/shapes.h>

namespace tandem {

/* A fault in the batches of a step, found because Settings::check asked: the batcher is wrong. */
struct BatchFault {
  uint64_t step;
  /* True: two constraints of one colour share a moving body. False: a pair that touches stands in no batch or in
   * several, or one that does not touch stands in one; then `color` and `body` say nothing. */
  bool conflict;
  uint32_t color, body; /* the lowest such colour; index into Scene::bodies */
  std::array<uint32_t, 2> pair,
      other;            /* bodies of the first pair and of the one it conflicts with, as in Scene::bodies */
  uint32_t constraints; /* how many are at fault in this step */
};
TANDEM_API std::string describe(const BatchFault &fault); /* one line */

/* Two bodies that touched in the last step, or ceased to. A pair has at most one event a step, however many points or
 * parts touch.
 *
 * Solids touch in a step when some point of theirs overlaps as it starts or carries an impulse within it, so what rests
 * persists and a bounce between two steps is not missed. A trigger touches what overlaps it as the step starts.
 * `begin`: it did not touch in the step before; `end`: it did then and does no more, or has left the neighbourhood, or
 * was taken out of the simulation. */
struct ContactEvent {
  enum class Kind : uint32_t { begin, persist, end } kind;
  uint32_t a, b;    /* indices into Scene::bodies, a < b */
  bool trigger;     /* one of the two is a trigger */
  uint32_t points;  /* points that touch; 0 for an end, as all that follows is */
  float impulse;    /* N s, along the normal, over the whole step with its bounce; 0 for triggers. Of `avbd`, see
                       docs/pipeline.md */
  float separation; /* m, of the deepest point as the step started: negative where the two overlap */
  Point point; /* of the world, as the step started or as the two met within it: where the impulse acts, or the middle
                  of the points where there is none */
  Vec3 normal; /* unit, from a to b; of several parts, that of the one that pressed hardest */
};
TANDEM_API const char *name_of(ContactEvent::Kind kind); /* "begin", "persist", "end" */

/* Two bodies whose bounds overlapped in the last step, or in the one before it; in scenes with meshes and compounds,
 * those of some of their parts. `begin`: they did not before; `end`: they do no more. A pair that persists keeps its
 * cached impulses. */
struct PairEvent {
  ContactEvent::Kind kind;
  uint32_t a, b; /* indices into Scene::bodies, a < b */
};

/* A body taken out of the simulation because it stopped being finite. */
struct Quarantine {
  uint32_t body; /* index into Scene::bodies */
  std::string name;
  std::string stage; /* where it was first seen: "start", "solve", "integrate" */
  uint64_t step;
};

} // namespace tandem
