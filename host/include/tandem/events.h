/* events.h - what a step reports: pairs whose contact or overlap of bounds begins or ends, hits, faults of the batcher,
 * and bodies that stopped being finite. World::contact_events, hit_events, pair_events, batch_fault and quarantined
 * return these records. */
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <tandem/export.h>
#include <tandem/shapes.h>

namespace tandem {

/* A fault in the batches of a step. Only Settings::check looks for it, and it means that the batcher is wrong. */
struct BatchFault {
  uint64_t step;
  /* True: two constraints of one colour share a moving body. False: a touching pair is in no batch or in several, or a
   * pair that does not touch is in one; `color` and `body` are then meaningless. */
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
 * Solid bodies touch in a step if one of their contact points overlaps at its start or carries an impulse within it. A
 * resting contact therefore persists, and a bounce between two steps is not missed. A trigger touches what overlaps it
 * at the start of the step. `begin` means that the pair did not touch in the step before. `end` means that it touched
 * then and does no longer, because the bodies separated, their bounds no longer overlap, or one of them was taken out
 * of the simulation. */
struct ContactEvent {
  enum class Kind : uint32_t { begin, persist, end } kind;
  uint32_t a, b;    /* indices into Scene::bodies, a < b */
  bool trigger;     /* one of the two is a trigger */
  uint32_t points;  /* points that touch; 0 for an end, as all that follows is */
  float impulse;    /* N s, along the normal, over the whole step with restitution; 0 for triggers. For the solver
                       `avbd` see docs/pipeline.md */
  float separation; /* m, of the deepest point at the start of the step; negative if the two overlap */
  Point point; /* world position, at the start of the step or where the two met within it: the centre of the impulses,
                  or the mean of the points if there are none */
  Vec3 normal; /* unit, from a to b; of several parts, that of the part with the largest impulse */
  float approach_speed; /* m/s, along the normal at the point, as the step starts; 0 if the two part */
};
TANDEM_API const char *name_of(ContactEvent::Kind kind); /* "begin", "persist", "end" */

/* A contact of two solids that begins faster than Settings::hit_speed: something for sounds and damage. */
struct HitEvent {
  uint32_t a, b;        /* indices into Scene::bodies, a < b */
  Point point;          /* as that of ContactEvent */
  Vec3 normal;          /* unit, from a to b */
  float approach_speed; /* m/s */
};

/* Two bodies whose bounds overlapped in the last step, or in the one before it; in scenes with meshes and compounds,
 * the bounds of some of their parts. `begin` means that they did not overlap before, `end` that they do no longer. A
 * pair that persists keeps its cached impulses. */
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
