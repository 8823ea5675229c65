/* body_codes.h - the numbers in body_traits and body_convex, and of methods; kernels and the host both name them.
 *
 * body_traits: bits 0-2 shape, 3-4 motion, 5 trigger, 8-27 material, 30 continuous collision.
 */
#ifndef TANDEM_SHARED_BODY_CODES_H
#define TANDEM_SHARED_BODY_CODES_H

/* SHAPE_OTHER: what body_convex says, where body_shape_pose says. SHAPE_TRIANGLE: one of a mesh, in the narrowphase
 * alone. The others are those of ShapeType in host/include/tandem/scene.h. */
enum {
  SHAPE_SPHERE = 0,
  SHAPE_BOX = 1,
  SHAPE_HALF_SPACE = 2,
  SHAPE_CAPSULE = 3,
  SHAPE_CYLINDER = 4,
  SHAPE_HULL = 5,
  SHAPE_MESH = 6,
  SHAPE_OTHER = 7,
  SHAPE_COMPOUND = 8,
  SHAPE_TRIANGLE = 9
};

/* Quarantined: taken out of the simulation, since it stopped being finite. */
enum { MOTION_FIXED = 0, MOTION_KINEMATIC = 1, MOTION_DYNAMIC = 2, MOTION_QUARANTINED = 3 };

/* Found and reported by the pairs it is in, never solved. */
enum { TRAIT_TRIGGER = 1 << 5 };
/* Collides along its way through the step: narrowphase/conservative_advancement.h. */
#define TRAIT_CONTINUOUS (1u << 30u)
#define MOST_MATERIALS (1u << 20u)

/* Kinds of pairs, from the rows of pairs.def: which kernel of the narrowphase finds their contacts. */
enum {
#define PAIR(kind, first, second, kernel, follower, what) PAIR_KIND_##kind,
#include "shared/pairs.def"
#undef PAIR
  PAIR_KIND_NONE /* how many there are, and what two half-spaces are */
};

/* In body_share: all of a motion, as whole numbers count it. */
#define WHOLE_MOTION (1u << 24u)
/* Which method finds the contacts of convex shapes (convex_contact.h), and how hulls find their farthest vertex
 * (hull_support.h). */
enum { CONVEX_EXPANSION = 0, CONVEX_SAMPLED = 1, CONVEX_AXES = 2, CONVEX_FIELDS = 3 };
enum { SUPPORT_BRUTE_FORCE = 0, SUPPORT_HILL_CLIMBING = 1, SUPPORT_CUBE_MAP = 2 };
/* How the hierarchy of the broadphase is walked (broadphase/hierarchy_walks.h). */
enum { WALK_BY_SKIPPING = 0, WALK_BY_STACK = 1, WALK_BY_HISTORY = 2 };
/* Which structure a query looks for bodies in (queries/body_walk.h). */
enum { QUERY_HIERARCHY = 0, QUERY_GRID = 1, QUERY_EVERY_BODY = 2 };

#endif
