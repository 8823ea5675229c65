/* point_rows.h - where the contact points of pairs stand in their buffers.
 *
 *   manifold_points    point 0 of all pairs | point 1 | point 2 | point 3
 *   constraint_points  point 0: x | y | z | separation | mass | point 1: x | y | z | separation | mass | ...
 *
 * A plane has `stride` rows, one for each pair that there is room for. In a scene where only balls touch, and none
 * is part of a compound, a pair has one point, and there are no planes of the others: they would be half of what a pair
 * takes. A point that has no plane, or that its pair does not use, reads as zeros, so the bits are the same with and
 * without the planes.
 *
 * Constraints are read in order, pass after pass, so their points are planes of single numbers, which lanes load
 * without a transposition. The arm of b is not stored: it is the arm of a less the offset from a to b. */
#ifndef TANDEM_SHARED_POINT_ROWS_H
#define TANDEM_SHARED_POINT_ROWS_H

#include "shared/counts.h"
#include "shared/features.h"
#include "shared/math.h"
#include "shared/point_numbers.h"

/* points: the planes of each buffer, or of each arm of it. */
typedef struct {
  uint stride, points;
} point_planes;

SHARED point_planes planes_of(GLOBAL const uint *counts)
{
#ifdef FEATURES
  point_planes planes = {counts[CAPACITY_PAIRS], MAY_OCCUR(SEVERAL_POINTS) ? 4u : 1u};
#else
  point_planes planes = {counts[CAPACITY_PAIRS], MAY_OCCUR(SEVERAL_POINTS) ? counts[CAPACITY_POINTS] : 1u};
#endif
  return planes;
}

SHARED vec4 no_point(void) { return make_vec4(R(0.0), R(0.0), R(0.0), R(0.0)); }

/* Point k of a manifold: offset from the centre of a, and separation. */
SHARED vec4 load_manifold_point(GLOBAL const float4 *manifold_points, point_planes planes, uint k, uint_lanes pair)
{
  return k < planes.points ? load_float4(manifold_points, planes.stride * k + pair) : no_point();
}

SHARED real load_of_point(GLOBAL const memory_real *constraint_points, point_planes planes, uint k, uint number,
                          any_index i)
{
  return k < planes.points ? load_real(constraint_points, planes.stride * (k * POINT_NUMBERS + number) + i)
                           : (real)R(0.0);
}
SHARED vec3 load_arm_of_a(GLOBAL const memory_real *constraint_points, point_planes planes, uint k, any_index i)
{
  return make_vec3(load_of_point(constraint_points, planes, k, POINT_X, i),
                   load_of_point(constraint_points, planes, k, POINT_Y, i),
                   load_of_point(constraint_points, planes, k, POINT_Z, i));
}
/* At the start of the step. */
SHARED real load_separation(GLOBAL const memory_real *constraint_points, point_planes planes, uint k, any_index i)
{
  return load_of_point(constraint_points, planes, k, POINT_SEPARATION, i);
}
/* The effective mass along the normal, which is 0 for a point that is not used. */
SHARED real load_point_mass(GLOBAL const memory_real *constraint_points, point_planes planes, uint k, any_index i)
{
  return load_of_point(constraint_points, planes, k, POINT_MASS, i);
}

SHARED void store_point_mass_if(mask wanted, GLOBAL memory_real *constraint_points, point_planes planes, uint k,
                                uint_lanes i, real mass)
{
  if (k < planes.points)
    store_listed_real_if(wanted, constraint_points, (uint_lanes)(planes.stride * (k * POINT_NUMBERS + POINT_MASS)) + i,
                         mass);
}
SHARED void store_point_if(mask wanted, GLOBAL memory_real *constraint_points, point_planes planes, uint k,
                           uint_lanes i, vec3 arm_of_a, real separation, real mass)
{
  if (k >= planes.points) return;
  uint_lanes first = (uint_lanes)(planes.stride * k * POINT_NUMBERS) + i, stride = (uint_lanes)planes.stride;
  store_listed_real_if(wanted, constraint_points, first, arm_of_a.x);
  store_listed_real_if(wanted, constraint_points, first + stride, arm_of_a.y);
  store_listed_real_if(wanted, constraint_points, first + (uint_lanes)2u * stride, arm_of_a.z);
  store_listed_real_if(wanted, constraint_points, first + (uint_lanes)3u * stride, separation);
  store_listed_real_if(wanted, constraint_points, first + (uint_lanes)4u * stride, mass);
}

#endif
