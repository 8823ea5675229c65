/* closest_segments.h - the closest points of two cores that are segments or points, those of capsules and spheres.
 *
 *       s = -1 o-------x--------o s = 1         The points x = middle_a + s half_a and y = middle_b + t half_b are
 *                      |                        closest where neither moves along its own segment. Each is clamped to
 *            t = -1 o--y----o t = 1             its segment while the other one stays, which ends after three steps
 *                                               (Ericson, "Real-Time Collision Detection", 2005, section 5.1.9).
 *
 * That takes one evaluation, where gjk.h walks through a simplex. Nearly parallel segments have a whole range of points
 * that are closest but for rounding; any of them will do, because a manifold comes from the features at the normal.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CLOSEST_SEGMENTS_H
#define TANDEM_SHARED_NARROWPHASE_CLOSEST_SEGMENTS_H

#include "shared/narrowphase/convex.h"

/* A tapered capsule has another core. */
SHARED mask has_segment(const convex *shape)
{
  return shape->kind == (uint)SHAPE_SPHERE || (is_capsule(shape) && shape->size.x == shape->size.z);
}

/* Half of the segment, from its middle to the end at the top; 0 for a sphere. */
SHARED vec3 half_segment(const convex *shape)
{
  return from_shape_axes(shape, make_vec3(R(0.0), is_capsule(shape) ? shape->size.y : R(0.0), R(0.0)));
}

/* Where on a segment of this squared half length: -1 to 1. */
SHARED real place_on_segment(real along, real squared)
{
  return squared > R(0.0) ? clamped(along / squared, R(-1.0), R(1.0)) : R(0.0);
}

typedef struct {
  vec3 on_a, on_b;
} segment_points;

SHARED segment_points closest_of_segments(vec3 middle_a, vec3 half_a, vec3 middle_b, vec3 half_b)
{
  vec3 between = subtract(middle_b, middle_a);
  real aa = length_squared(half_a), bb = length_squared(half_b), ab = dot3(half_a, half_b);
  real along_a = dot3(half_a, between), along_b = dot3(half_b, between);
  real determinant = aa * bb - ab * ab;
  mask crossing = determinant > R(64.0) * ROUNDING * aa * bb;
  real s = crossing ? clamped((bb * along_a - ab * along_b) / determinant, R(-1.0), R(1.0)) : R(0.0);
  real t = place_on_segment(ab * s - along_b, bb);
  s = place_on_segment(ab * t + along_a, aa);
  segment_points p = {add_scaled(middle_a, half_a, s), add_scaled(middle_b, half_b, t)};
  return p;
}

#endif
