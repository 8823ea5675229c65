/* sampled_depth.h - how deep two convex cores overlap, from a fixed set of directions: no polytope, no memory.
 *
 * Any direction gives an upper bound of the depth. Tried are 42 of them all around (the corners of an icosahedron and the
 * middles of its edges), the faces and axes of both shapes, and the direction between their middles. The best is then
 * improved by depth_refinement.h. The cheap way of talks on collision detection on GPUs (E. Coumans, 2012 and 2013): near the
 * least depth, not proven to be it. Exact wherever a face is the answer.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SAMPLED_DEPTH_H
#define TANDEM_SHARED_NARROWPHASE_SAMPLED_DEPTH_H

#include "shared/narrowphase/depth_refinement.h"
#include "shared/narrowphase/polytope.h"

#define SAMPLED_DIRECTIONS 42

/* Direction k of 42: three turns of (0, +-1, +-golden), an axis either way, and (+-1, +-1/golden, +-golden) / 2. */
SHARED vec3 sampled_direction(uint k)
{
  uint turn = k / 14u, n = k % 14u;
  real first = (n & 1u) == 1u ? R(-1.0) : R(1.0), second = (n & 2u) == 2u ? R(-1.0) : R(1.0), third = (n & 4u) == 4u ? R(-1.0) : R(1.0);
  if (n < 8u) return from_axis(turn, first * R(0.5), second * R(0.30901699437494742), third * R(0.80901699437494742));
  if (n < 12u) return from_axis(turn, R(0.0), first * R(0.52573111211913361), second * R(0.85065080835203993));
  return from_axis(turn, first, R(0.0), R(0.0));
}

/* The normals of a shape's own faces, and of its axis. sense: 1 for a, -1 for b. */
SHARED core_contact shallowest_of_own(core_contact best, const convex *a, const convex *b, const convex *shape, real sense)
{
  if (is_polytope(shape))
    for (uint k = 0u; k < faces_of(shape); ++k)
      best = shallower(best, a, b, scale(from_shape_axes(shape, xyz(plane_of_face(shape, k))), sense));
  if (shape->kind == (uint)SHAPE_CYLINDER || shape->kind == (uint)SHAPE_CAPSULE)
    for (int k = 0; k < 2; ++k)
      best = shallower(best, a, b, from_shape_axes(shape, make_vec3(R(0.0), k == 0 ? R(1.0) : R(-1.0), R(0.0))));
  return best;
}

/* Square to the axis of a round shape, toward the other: the way out of its side. */
SHARED core_contact shallower_sideways(core_contact best, const convex *a, const convex *b, const convex *shape, vec3 between)
{
  if (shape->kind != (uint)SHAPE_CYLINDER && shape->kind != (uint)SHAPE_CAPSULE) return best;
  return shallower(best, a, b, from_shape_axes(shape, around_axis(to_shape_axes(shape, between))));
}

/* hint: a unit direction worth trying, such as the largest gap that the distance query saw before it met the overlap: near
 * touching it is nearly the answer, where fixed directions are farthest from it. */
SHARED core_contact sampled_penetration(const convex *a, const convex *b, vec3 up, vec3 hint)
{
  core_contact best = {up, gap_along(a, b, up)};
  best = shallower(best, a, b, hint);
  vec3 between = subtract(b->center, a->center);
  real distance = length_of(between);
  if (distance > R(0.0)) {
    best = shallower(best, a, b, scale(between, R(1.0) / distance));
    best = shallower_sideways(best, a, b, a, between);
    best = shallower_sideways(best, a, b, b, between);
  }
  best = shallowest_of_own(best, a, b, a, R(1.0));
  best = shallowest_of_own(best, a, b, b, R(-1.0));
  for (uint k = 0u; k < (uint)SAMPLED_DIRECTIONS; ++k) best = shallower(best, a, b, sampled_direction(k));
  return refined_by_distance(best, a, b);
}

#endif
