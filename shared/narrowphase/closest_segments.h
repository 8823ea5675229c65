/* closest_segments.h - the closest points of two segments, which may be points: the cores of capsules and spheres.
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

#include "shared/math.h"

/* Where on a segment of this squared half length: -1 to 1. */
SHARED real place_on_segment(real along, real squared)
{
  mask long_enough = squared > R(0.0);
  return choose(long_enough, clamped(along / choose(long_enough, squared, (real)R(1.0)), R(-1.0), R(1.0)),
                (real)R(0.0));
}

typedef struct {
  vec3 on_a, on_b;
  real place_a, place_b; /* where on the segments: -1 to 1 */
} segment_points;

/* The square of the sine of the angle from which two segments have one pair of closest points. */
#define SEGMENTS_CROSS R(1e-9)

/* half_a, half_b: from the middle to the end at 1. By vector products, because differences of products of lengths would
 * lose the small angles of long segments to rounding. */
SHARED segment_points closest_of_segments(vec3 middle_a, vec3 half_a, vec3 middle_b, vec3 half_b)
{
  vec3 between = subtract(middle_b, middle_a), across = cross3(half_a, half_b);
  real aa = length_squared(half_a), bb = length_squared(half_b), ab = dot3(half_a, half_b);
  real along_a = dot3(half_a, between), along_b = dot3(half_b, between), area = length_squared(across);
  mask crossing = area > SEGMENTS_CROSS * aa * bb;
  real crossed = dot3(across, cross3(between, half_b)) / choose(crossing, area, (real)R(1.0));
  real s = choose(crossing, clamped(crossed, R(-1.0), R(1.0)), (real)R(0.0));
  real t = place_on_segment(ab * s - along_b, bb);
  s = place_on_segment(ab * t + along_a, aa);
  segment_points p = {add_scaled(middle_a, half_a, s), add_scaled(middle_b, half_b, t), s, t};
  return p;
}

#endif
