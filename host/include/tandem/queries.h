/* queries.h - queries of a World between two steps: rays, boxes and shape casts, in batches; see World::cast_rays and
 * the functions after it.
 *
 * The broadphase structure that answers a query changes no bit of the answer. If several bodies are hit at the same
 * fraction, the one with the lowest index counts as nearest. A query and a body must accept each other's groups, as two
 * bodies must. Quarantined bodies are not found.
 */
#pragma once

#include <cstdint>

#include <tandem/no_body.h>
#include <tandem/shapes.h>

namespace tandem {

struct QueryFilter {
  uint32_t group = 0xffffffffu; /* bit set of the groups the query is in */
  uint32_t mask = 0xffffffffu;  /* groups that it finds */
};

struct Ray {
  Point origin{0, 0, 0};
  Vec3 direction{0, 0, 0}; /* of any length; fractions of hits refer to it */
  float reach = 1;         /* the largest fraction that is searched, >= 0; may be infinity */
  QueryFilter filter;
};

struct Pose {
  Point position{0, 0, 0};
  Quat orientation{0, 0, 0, 1};
};

struct QueryHit {
  uint32_t body = no_body; /* index into Scene::bodies; the rest is 0 where nothing is hit */
  float fraction = 0;      /* of the direction or displacement */
  Point point{0, 0, 0};    /* on the body's surface; the start of the query if that lies inside the body */
  Vec3 normal{0, 0, 0}; /* outward unit normal of the surface there; against the direction if the query starts inside (0
                           for a shape cast of length 0) */
};

using RayHit = QueryHit;
using ShapeCastHit = QueryHit;

/* A box aligned with the axes of the world, and the displacement along which it is cast. */
struct QueryBox {
  Point center{0, 0, 0};
  Vec3 half_extents{0, 0, 0}; /* m, >= 0 */
  Vec3 displacement{0, 0, 0}; /* m; 0: the box does not move */
  QueryFilter filter;
};

/* A body whose AABB the query's box touches. Half-spaces have no AABB and always count as touched. */
struct BoxHit {
  uint32_t body = no_body;
  float fraction = 0; /* of the displacement, where the boxes first touch */
};

/* Of two bodies, in world coordinates. */
struct ClosestPoints {
  float distance = 0; /* m; 0 where the bodies overlap, and then the rest is 0 too */
  Point on_first{0, 0, 0}, on_second{0, 0, 0};
  Vec3 normal{0, 0, 0}; /* unit, from the first body to the second */
};

} // namespace tandem
