/* body_codes.h - the numbers in body_traits and body_convex; kernels and the host both name them.
 *
 * body_traits: bits 0-2 shape, 3-4 motion, 5 trigger, 8-31 material.
 */
#ifndef TANDEM_SHARED_BODY_CODES_H
#define TANDEM_SHARED_BODY_CODES_H

/* SHAPE_OTHER: what body_convex says, where body_shape_pose says. SHAPE_TRIANGLE: one of a mesh, in the narrowphase alone. The others are
 * those of ShapeType in host/scene.h. */
enum {
  SHAPE_SPHERE = 0, SHAPE_BOX = 1, SHAPE_HALF_SPACE = 2, SHAPE_CAPSULE = 3, SHAPE_CYLINDER = 4, SHAPE_HULL = 5, SHAPE_MESH = 6, SHAPE_OTHER = 7,
  SHAPE_COMPOUND = 8, SHAPE_TRIANGLE = 9
};

/* Quarantined: taken out of the simulation, since it stopped being finite. */
enum { MOTION_FIXED = 0, MOTION_KINEMATIC = 1, MOTION_DYNAMIC = 2, MOTION_QUARANTINED = 3 };

/* Found and reported by the pairs it is in, never solved. */
enum { TRAIT_TRIGGER = 1 << 5 };

#endif
