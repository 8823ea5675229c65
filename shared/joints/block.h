/* block.h - three rows that are solved together, some of which a joint may leave free.
 *
 * Elimination without pivoting (L D L^T) suits a symmetric matrix that is positive. A pivot that is next to nothing
 * beside its own diagonal belongs to a motion that no impulse of the joint can give, such as the one that is left when
 * the bodies have locked axes. Its row takes no part.
 */
#ifndef TANDEM_SHARED_JOINTS_BLOCK_H
#define TANDEM_SHARED_JOINTS_BLOCK_H

#include "shared/joints/joint_codes.h"
#include "shared/locks.h"

#define LEAST_PIVOT R(1e-6)

SHARED real pivot_inverse(real pivot, real diagonal)
{
  mask solves = pivot > LEAST_PIVOT * diagonal;
  return choose(solves, R(1.0) / choose(solves, pivot, (real)R(1.0)), (real)R(0.0));
}

/* x with k x = right. */
SHARED vec3 solve_symmetric(symmetric3 k, vec3 right)
{
  real inverse_x = pivot_inverse(k.xx, k.xx);
  real y_of_x = k.xy * inverse_x, z_of_x = k.xz * inverse_x;
  real pivot_y = k.yy - y_of_x * k.xy, rest = k.yz - z_of_x * k.xy;
  real inverse_y = pivot_inverse(pivot_y, k.yy);
  real z_of_y = rest * inverse_y;
  real inverse_z = pivot_inverse(k.zz - z_of_x * k.xz - z_of_y * rest, k.zz);
  real y = right.y - y_of_x * right.x;
  real z = inverse_z * (right.z - z_of_x * right.x - z_of_y * y);
  y = inverse_y * y - z_of_y * z;
  return make_vec3(inverse_x * right.x - y_of_x * y - z_of_x * z, y, z);
}

/* The numbers of the axes in `axes` (JOINT_X and so on); 0 for the others. */
SHARED vec3 along_axes(uint_lanes axes, vec3 v)
{
  return make_vec3(zero_if((axes & (uint)JOINT_X) == 0u, v.x), zero_if((axes & (uint)JOINT_Y) == 0u, v.y),
                   zero_if((axes & (uint)JOINT_Z) == 0u, v.z));
}

/* The same rows of a matrix; the others get rows of the identity, whose solution is their right side, 0. */
SHARED symmetric3 rows_of_axes(uint_lanes axes, symmetric3 k)
{
  mask x = (axes & (uint)JOINT_X) != 0u, y = (axes & (uint)JOINT_Y) != 0u, z = (axes & (uint)JOINT_Z) != 0u;
  symmetric3 s = {choose(x, k.xx, (real)R(1.0)),     choose(y, k.yy, (real)R(1.0)),
                  choose(z, k.zz, (real)R(1.0)),     choose(x & y, k.xy, (real)R(0.0)),
                  choose(x & z, k.xz, (real)R(0.0)), choose(y & z, k.yz, (real)R(0.0))};
  return s;
}

/* The matrix k of the world's axes in those of the rotation r: r^T k r. */
SHARED symmetric3 tensor_in_axes(mat3 r, symmetric3 k)
{
  vec3 x = axis_x(r), y = axis_y(r), z = axis_z(r);
  vec3 of_x = symmetric_times(k, x), of_y = symmetric_times(k, y), of_z = symmetric_times(k, z);
  symmetric3 s = {dot3(x, of_x), dot3(y, of_y), dot3(z, of_z), dot3(x, of_y), dot3(x, of_z), dot3(y, of_z)};
  return s;
}

#endif
