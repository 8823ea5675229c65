/* body_codes.h - the numbers in body_traits and body_convex, and of methods; kernels and the host both name them.
 *
 * body_traits: bits 0-2 shape, 3-4 motion, 8-31 material.
 */
#ifndef TANDEM_SHARED_BODY_CODES_H
#define TANDEM_SHARED_BODY_CODES_H

/* SHAPE_OTHER: what body_convex says, where body_shape_pose says. The others are those of ShapeType in host/scene.h. */
enum { SHAPE_SPHERE = 0, SHAPE_BOX = 1, SHAPE_HALF_SPACE = 2, SHAPE_CAPSULE = 3, SHAPE_CYLINDER = 4, SHAPE_HULL = 5, SHAPE_OTHER = 7 };

/* Quarantined: taken out of the simulation, since it stopped being finite. */
enum { MOTION_FIXED = 0, MOTION_KINEMATIC = 1, MOTION_DYNAMIC = 2, MOTION_QUARANTINED = 3 };

/* Which method finds the contacts of convex shapes (convex_contact.h), and how hulls find their farthest vertex (hull_support.h). */
enum { CONVEX_EXPANSION = 0, CONVEX_SAMPLED = 1, CONVEX_AXES = 2 };
enum { SUPPORT_BRUTE_FORCE = 0, SUPPORT_HILL_CLIMBING = 1, SUPPORT_CUBE_MAP = 2 };

#endif
