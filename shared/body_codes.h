/* body_codes.h - the codes stored in body_flags and body_convex, and the codes of methods, for kernels and the host.
 *
 * body_flags: bits 0-2 shape, 3-4 motion, 5 trigger, 6 joined pairs, 8-27 material, 30 continuous collision.
 */
#ifndef TANDEM_SHARED_BODY_CODES_H
#define TANDEM_SHARED_BODY_CODES_H

/* SHAPE_OTHER: body_convex names the shape, and body_shape_pose places it in the body. SHAPE_TRIANGLE: a triangle of a
 * mesh, which exists in the narrowphase alone. The other codes are those of ShapeType in
 * host/include/tandem/shapes.h. A child of a compound has SHAPE_CAPSULE if it is a capsule or a ball, and then the size
 * of one; else SHAPE_OTHER. */
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
/* The bits that hold such a code where it shares a word (sweeps/overlap_shapes.h). */
#define SHAPE_KIND_BITS 4u
#define SHAPE_KIND_MASK 15u

/* A quarantined body has been taken out of the simulation, because its state stopped being finite. */
enum { BODY_TYPE_FIXED = 0, BODY_TYPE_KINEMATIC = 1, BODY_TYPE_DYNAMIC = 2, BODY_TYPE_QUARANTINED = 3 };

/* body_lock: locked linear axes of the world, and three bits further the locked angular ones. */
enum { LOCK_X = 1, LOCK_Y = 2, LOCK_Z = 4, LOCK_ANGULAR_SHIFT = 3 };

/* A trigger is found and reported in its pairs, and is never solved. */
enum { BODY_FLAG_TRIGGER = 1 << 5 };
/* Some joint keeps the body from colliding with another: broadphase/joined_pairs.h. */
enum { BODY_FLAG_JOINED = 1 << 6 };
/* The body collides along its path through the step: narrowphase/conservative_advancement.h. */
#define BODY_FLAG_CONTINUOUS (1u << 30u)
#define MOST_MATERIALS (1u << 20u)

/* The kinds of pairs, from the rows of pairs.def. The kind selects the kernel that finds the contacts. */
enum {
#define PAIR(kind, first, second, kernel, follower, what) PAIR_KIND_##kind,
#include "shared/pairs.def"
#undef PAIR
  PAIR_KIND_NONE /* the number of kinds, and the kind of two half-spaces */
};

/* The value of body_toi_fraction that keeps the whole motion. Fractions are whole numbers, so that their minimum does
 * not depend on order. */
#define WHOLE_TOI_FRACTION (1u << 24u)
/* The method that finds the contacts of convex shapes (convex_contact.h), and the support map of hulls
 * (hull_support.h). */
enum { CONVEX_EXPANSION = 0, CONVEX_SAMPLED = 1, CONVEX_AXES = 2, CONVEX_FIELDS = 3 };
enum { SUPPORT_BRUTE_FORCE = 0, SUPPORT_HILL_CLIMBING = 1, SUPPORT_CUBE_MAP = 2 };
/* The traversal of the broadphase's hierarchy (broadphase/hierarchy_walks.h). */
enum { WALK_BY_SKIPPING = 0, WALK_BY_STACK = 1, WALK_BY_HISTORY = 2 };
/* The structure in which a query searches for bodies (queries/body_walk.h). */
enum { QUERY_HIERARCHY = 0, QUERY_GRID = 1, QUERY_EVERY_BODY = 2 };

/* Classes of bodies (substep_classes.h), and in Parameters::substep_class those that take part: every body, or those of
 * one class. NO_CLASS: of bodies that are not dynamic. */
#define EVERY_CLASS 0u
#define NO_CLASS 0u
#define FEW_SUBSTEPS 1u
#define MANY_SUBSTEPS 2u

#endif
