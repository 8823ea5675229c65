/* point_rows.h - where the contact points of pairs stand in their buffers.
 *
 *   manifold_points    point 0 of all pairs | point 1 | point 2 | point 3
 *   constraint_points  arms of a: point 0 | 1 | 2 | 3 | arms of b: point 0 | 1 | 2 | 3
 *
 * A plane has `stride` rows, one for each pair that there is room for. In a scene where only balls touch, a pair has
 * one point, and there are no planes of the others: they would be two thirds of what a pair takes. A point that has no
 * plane, or that its pair does not use, reads as zeros, so the bits are the same with and without the planes. */
#ifndef TANDEM_SHARED_POINT_ROWS_H
#define TANDEM_SHARED_POINT_ROWS_H

#include "shared/counts.h"
#include "shared/features.h"
#include "shared/math.h"

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

/* Arm of a to point k, and the separation at the start of the step. */
SHARED vec4 load_arm_of_a(GLOBAL const float4 *constraint_points, point_planes planes, uint k, item_index i)
{
  return k < planes.points ? load_float4(constraint_points, planes.stride * k + i) : no_point();
}

/* Arm of b to point k, and the effective mass along the normal, which is 0 for a point that is not used. */
SHARED vec4 load_arm_of_b(GLOBAL const float4 *constraint_points, point_planes planes, uint k, item_index i)
{
  return k < planes.points ? load_float4(constraint_points, planes.stride * (planes.points + k) + i) : no_point();
}

SHARED void store_arm_of_a(GLOBAL float4 *constraint_points, point_planes planes, uint k, item_index i, vec4 arm)
{
  if (k < planes.points) store_float4(constraint_points, planes.stride * k + i, arm);
}
SHARED void store_arm_of_b(GLOBAL float4 *constraint_points, point_planes planes, uint k, item_index i, vec4 arm)
{
  if (k < planes.points) store_float4(constraint_points, planes.stride * (planes.points + k) + i, arm);
}

#endif
