/* sampled_depth.h - the penetration depth of two convex cores from a fixed set of directions, without a polytope.
 *
 * Any direction gives an upper bound of the depth. The directions tried are 42 fixed ones (the corners of an
 * icosahedron and the middles of its edges), the face normals and axes of both shapes, and the direction between their
 * middles. The best is then improved by depth_refinement.h. This is the cheap method of talks on collision detection on
 * GPUs (E. Coumans, 2012 and 2013): its result is nearly the least depth, but not proven to be. It is exact wherever a
 * face normal is the answer.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_SAMPLED_DEPTH_H
#define TANDEM_SHARED_NARROWPHASE_SAMPLED_DEPTH_H

#include "shared/narrowphase/depth_refinement.h"
#include "shared/narrowphase/polytope.h"

#define SAMPLED_DIRECTIONS 42

/* Direction k of 42: cyclic permutations of (0, +-1, +-golden), of both directions of an axis, and of
 * (+-1, +-1/golden, +-golden) / 2. */
SHARED vec3 sampled_direction(uint k)
{
  uint turn = k / 14u, n = k % 14u;
  real first = (n & 1u) == 1u ? R(-1.0) : R(1.0), second = (n & 2u) == 2u ? R(-1.0) : R(1.0),
       third = (n & 4u) == 4u ? R(-1.0) : R(1.0);
  if (n < 8u) return from_axis(turn, first * R(0.5), second * R(0.30901699437494742), third * R(0.80901699437494742));
  if (n < 12u) return from_axis(turn, R(0.0), first * R(0.52573111211913361), second * R(0.85065080835203993));
  return from_axis(turn, first, R(0.0), R(0.0));
}

/* The number of normals of a shape's own faces, or of the two directions of its axis. */
SHARED uint own_normals_of(const convex *shape)
{
  return is_polytope(shape) ? faces_of(shape) : is_cylinder(shape) || is_capsule(shape) ? 2u : 0u;
}
SHARED vec3 own_normal(const convex *shape, uint k)
{
  vec3 own = is_polytope(shape) ? xyz(plane_of_face(shape, k)) : make_vec3(R(0.0), k == 0u ? R(1.0) : R(-1.0), R(0.0));
  return from_shape_axes(shape, own);
}

/* The direction perpendicular to the axis of a round shape, toward the other shape, which leads out of its side. */
SHARED vec3 sideways_of(const convex *shape, vec3 between, vec3 otherwise)
{
  if (!is_cylinder(shape) && !is_capsule(shape)) return otherwise;
  return from_shape_axes(shape, around_axis(to_shape_axes(shape, between)));
}

/* Direction k of all that are tried. `hint` takes the place of directions that a pair does not have. */
SHARED vec3 tried_normal(const convex *a, const convex *b, vec3 up, vec3 hint, uint k)
{
  vec3 between = subtract(b->center, a->center);
  real distance = length_of(between);
  uint of_a = own_normals_of(a), of_b = own_normals_of(b);
  if (k == 0u) return up;
  if (k == 1u || (k < 5u && distance <= R(0.0))) return hint;
  if (k == 2u) return scale(between, R(1.0) / distance);
  if (k == 3u) return sideways_of(a, between, hint);
  if (k == 4u) return sideways_of(b, between, hint);
  if (k < 5u + of_a) return own_normal(a, k - 5u);
  if (k < 5u + of_a + of_b) return is_polytope(b) ? negate(own_normal(b, k - 5u - of_a)) : own_normal(b, k - 5u - of_a);
  return sampled_direction(k - 5u - of_a - of_b);
}

/* hint: a unit direction worth trying, such as that of the largest gap that the distance query found before it detected
 * the overlap, which is the normal of a shallow contact. up: the direction in which shapes part that have no better
 * one. */
SHARED core_contact sampled_penetration(const convex *a, const convex *b, vec3 up, vec3 hint)
{
  core_contact best = {up, R(-1e30)};
  uint tried = 5u + own_normals_of(a) + own_normals_of(b) + (uint)SAMPLED_DIRECTIONS;
  for (uint k = 0u; k < tried; ++k) best = shallower(best, a, b, tried_normal(a, b, up, hint, k));
  return best;
}

#endif
