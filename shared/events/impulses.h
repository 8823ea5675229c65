/* impulses.h - the impulse that each contact carried over the whole step, and which pairs touch.
 *
 * The impulse that a solver accumulates is that of one substep: the next one starts from it and removes what it does
 * not need. The impulse of a step is therefore the sum over its substeps, with the last one as restitution left it:
 *
 *   substep            0       1          2             3         bounce
 *   accumulated        p0      p1         p2            p3    ->  p3'
 *   sum_impulses   0       p0     p0 + p1   p0 + p1 + p2
 *   pair_impulses                                                 p0 + p1 + p2 + p3'
 *
 * (Box2D version 3 sums for the same reason: totalNormalImpulse.)
 */
#ifndef TANDEM_SHARED_EVENTS_IMPULSES_H
#define TANDEM_SHARED_EVENTS_IMPULSES_H

#include "shared/point_rows.h"
#include "shared/records.h"

SHARED vec4 sum_of_rows(vec4 a, vec4 b) { return make_vec4(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w); }

/* Runs at the start of each substep. */
SHARED void sum_impulses_item(GLOBAL const float4 *constraint_normal_impulse, GLOBAL float4 *constraint_impulse,
                              uint substep, item_index i)
{
  vec4 sum = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  if (substep > 0u) sum = sum_of_rows(load_float4(constraint_impulse, i), load_float4(constraint_normal_impulse, i));
  store_float4(constraint_impulse, i, sum);
}

SHARED void pair_impulses_item(GLOBAL const uint *constraint_pair, GLOBAL const float4 *constraint_impulse,
                               GLOBAL const float4 *constraint_normal_impulse, GLOBAL float4 *pair_impulse,
                               item_index i)
{
  store_float4(pair_impulse, load_uint(constraint_pair, i),
               sum_of_rows(load_float4(constraint_impulse, i), load_float4(constraint_normal_impulse, i)));
}

/* A pair touches if some point overlaps at the start of the step or carried an impulse in it. Overlap alone would miss
 * a bounce between two starts, and would flicker where a body rests a rounding above another one. The impulse alone
 * would end the contact of a body that rests on three of four supports, and would miss triggers, which carry none. */
SHARED mask point_touches(vec4 point, real impulse) { return (point.w <= R(0.0)) | (impulse > R(0.0)); }

/* For a pair without a constraint, pair_impulse holds the value of some earlier step, so it is replaced by 0. */
SHARED vec4 impulse_of_pair(GLOBAL const uint *pair_color, GLOBAL const float4 *pair_impulse, uint_lanes pair)
{
  mask solved = load_uint(pair_color, pair) != (uint_lanes)COLOR_INACTIVE;
  return choose4(solved, load_float4(pair_impulse, pair), make_vec4(R(0.0), R(0.0), R(0.0), R(0.0)));
}

SHARED void find_touching_item(GLOBAL const uint *pair_color, GLOBAL const float4 *pair_impulse,
                               GLOBAL const float4 *manifold_points, GLOBAL const uint *manifold_count,
                               GLOBAL const uint *counts, GLOBAL uint *pair_touching, item_index i)
{
  uint_lanes points = load_uint(manifold_count, i), touching = 0u;
  vec4 impulse = impulse_of_pair(pair_color, pair_impulse, i);
  for (uint k = 0; k < 4u; ++k) {
    mask touches =
        (points > (uint_lanes)k) &
        point_touches(load_manifold_point(manifold_points, planes_of(counts), k, i), component(impulse, (uint_lanes)k));
    touching = choose(touches, (uint_lanes)1u, touching);
  }
  store_uint(pair_touching, i, touching);
}

#endif
