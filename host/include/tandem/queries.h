/* queries.h - what a World can be asked between two steps: rays, boxes and shape casts, by the batch; see
 * World::cast_rays and those after it.
 *
 * Which structure of the broadphase answers changes no bit of an answer. Of bodies hit at one place the one of the
 * lower index counts as nearest. A query and a body must accept each other's groups, as two bodies must. Quarantined
 * bodies are not found.
 */
#pragma once

#include <cstdint>

#include <tandem/shapes.h>

namespace tandem {

struct QueryFilter {
  uint32_t group = 0xffffffffu; /* bit set of the groups the query is in */
  uint32_t mask = 0xffffffffu;  /* groups it finds */
};

struct Ray {
  Point origin{0, 0, 0};
  Vec3 direction{0, 0, 0}; /* of any length; hits are given as fractions of it */
  float reach = 1;         /* the largest fraction looked at, >= 0; infinity: without an end */
  QueryFilter filter;
};

struct Pose {
  Point position{0, 0, 0};
  Quat orientation{0, 0, 0, 1};
};

constexpr uint32_t no_body = 0xffffffffu;

struct QueryHit {
  uint32_t body = no_body; /* index into Scene::bodies; the rest is 0 where nothing is hit */
  float fraction = 0;      /* of the direction or displacement */
  Point point{0, 0, 0};    /* of the body's surface; where the query starts inside of a body: its start */
  Vec3 normal{0, 0, 0}; /* of the body's surface there, unit, outward; from the inside against the direction (a sweep of
                           length 0 then has none) */
};

using RayHit = QueryHit;
using ShapeCastHit = QueryHit;

/* A box along the axes of the world, and where it goes. */
struct QueryBox {
  Point center{0, 0, 0};
  Vec3 half_extents{0, 0, 0}; /* m, >= 0 */
  Vec3 displacement{0, 0, 0}; /* m; 0: where it stands */
  QueryFilter filter;
};

/* A body whose own box the query's box touches. Half-spaces, which have none, always count as touched. */
struct BoxHit {
  uint32_t body = no_body;
  float fraction = 0; /* of the displacement, as the boxes first touch */
};

} // namespace tandem
