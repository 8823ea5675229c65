/* commit.h - makes a finished step the state, or leaves the state as it was.
 *
 * One item gathers what went wrong into the status. The commit kernels have a range to run over only if the status is
 * 0, so a step that overflowed or failed has changed nothing and can be run again. If the device itself fails during
 * the commit, the host goes back to the previous side of the state, which the commit kernels only read (STATE and CACHE
 * in buffers.def).
 */
#ifndef TANDEM_SHARED_INTEGRATE_COMMIT_H
#define TANDEM_SHARED_INTEGRATE_COMMIT_H

#include "shared/friction_rows.h"
#include "shared/integrate/prepare.h"

SHARED void begin_step_item(GLOBAL uint *counts, uint i)
{
  (void)i;
  counts[COUNT_PAIRS] = 0u;
  counts[COUNT_PAIRS_NEEDED] = 0u;
  counts[COUNT_CANDIDATES_NEEDED] = 0u;
  counts[COUNT_CONSTRAINTS] = 0u;
  counts[COUNT_UNCOLORED] = 0u;
  counts[COUNT_ROUNDS] = 0u;
  counts[COUNT_COLORS] = 0u;
  counts[COUNT_STATUS] = 0u;
  counts[COUNT_DIRECT_ISLANDS] = 0u;
  counts[COUNT_DIRECT_LEFT] = 0u;
  counts[COUNT_DIRECT_STALLED] = 0u;
  counts[COUNT_NONFINITE] = INDEX_NONE;
  counts[COUNT_CONFLICTS] = 0u;
  counts[COUNT_FIRST_CONFLICT] = INDEX_NONE;
  counts[COUNT_MISBATCHED] = 0u;
  counts[COUNT_FIRST_MISBATCHED] = INDEX_NONE;
  counts[COUNT_SLEEPER_PAIRS_NEEDED] = 0u;
  counts[COUNT_TOUCHED_SLEEPERS] = 0u;
  counts[COUNT_DROWSY] = 0u;
  counts[COUNT_BROKEN_JOINTS] = 0u;
  counts[COUNT_ISLAND_ROUNDS] = 0u;
  counts[COUNT_ISLANDS_OPEN] = 0u;
  counts[COUNT_FALLING_ASLEEP] = 0u;
  counts[COUNT_LOAD_RATE] = 0u;
  counts[COUNT_BRACED_LAYERS] = 0u;
  counts[COUNT_SUBSTEP_CLASSES] = 0u;
  counts[COUNT_MANY_BODIES] = 0u;
  counts[COUNT_LATE_WISHES] = 0u;
}

/* Where the step has moved a body. */
SHARED mask moved_pose_is_finite(GLOBAL const float4 *body_position, GLOBAL const float4 *solver_delta_pose,
                                 GLOBAL const float4 *solver_orientation, item_index i)
{
  vec3 position = moved_position(load_position(body_position, i), xyz(load_float4(solver_delta_pose, i * 2u))).high;
  return is_finite(position) & quaternion_is_finite(load_float4(solver_orientation, i));
}

SHARED void check_bodies_item(GLOBAL const float4 *body_position, GLOBAL const float4 *solver_velocity,
                              GLOBAL const float4 *solver_delta_pose, GLOBAL const float4 *solver_orientation,
                              GLOBAL uint *counts, item_index i)
{
  note_nonfinite(velocity_is_finite(load_velocity(solver_velocity, i)), counts, i, NONFINITE_IN_SOLVE);
  note_nonfinite(moved_pose_is_finite(body_position, solver_delta_pose, solver_orientation, i), counts, i,
                 NONFINITE_IN_INTEGRATE);
}

/* Bodies of other classes than the step moved, or passes for bodies that are not there, after which others might lie by
 * a rounding elsewhere. classes: that the host launched passes for, 0 if for all bodies at once. */
SHARED uint are_other_classes(GLOBAL const uint *counts, uint classes)
{
  uint found = counts[COUNT_SUBSTEP_CLASSES];
  return classes != 0u && classes != (found != 0u ? found : FEW_SUBSTEPS) ? 1u : 0u;
}

/* colors: the number that the host launched. load_rate: the largest that its substeps bear. */
SHARED void finish_step_item(GLOBAL uint *counts, uint colors, uint load_rate, uint classes, uint i)
{
  (void)i;
  uint status = counts[COUNT_STATUS] & STATUS_DEADLOCK;
  if (counts[COUNT_SLEEPER_PAIRS_NEEDED] > counts[COUNT_PAIRS_NEEDED])
    counts[COUNT_PAIRS_NEEDED] = counts[COUNT_SLEEPER_PAIRS_NEEDED];
  if (counts[COUNT_PAIRS_NEEDED] > counts[CAPACITY_PAIRS]) status |= STATUS_PAIRS;
  if (counts[COUNT_CANDIDATES_NEEDED] > counts[CAPACITY_CANDIDATES]) status |= STATUS_CANDIDATES;
  if (counts[COUNT_UNCOLORED] != 0u) status |= STATUS_ROUNDS;
  if (counts[COUNT_COLORS] > colors || (colors > COLOR_LIMIT && counts[COUNT_COLORS] <= COLOR_LIMIT))
    status |= STATUS_COLORS;
  if (counts[COUNT_NONFINITE] != INDEX_NONE) status |= STATUS_NONFINITE;
  if (counts[COUNT_ISLANDS_OPEN] != 0u) status |= STATUS_ISLANDS;
  if (counts[COUNT_TOUCHED_SLEEPERS] != 0u) status |= STATUS_WAKE;
  if (counts[COUNT_LOAD_RATE] > load_rate) status |= STATUS_SUBSTEPS;
  if (counts[COUNT_LATE_WISHES] != 0u || are_other_classes(counts, classes)) status |= STATUS_SUBSTEPS;
  uint whole = status == 0u ? 1u : 0u;
  counts[COUNT_STATUS] = status;
  counts[COUNT_COMMIT_BODIES] = whole * counts[COUNT_BODIES];
  counts[COUNT_COMMIT_BODIES_PLUS_ONE] = whole * counts[COUNT_BODIES_PLUS_ONE];
  counts[COUNT_COMMIT_PAIRS] = whole * counts[COUNT_PAIRS];
  counts[COUNT_COMMIT_CONSTRAINTS] = whole * counts[COUNT_CONSTRAINTS];
  counts[COUNT_COMMIT_JOINTS] = whole * counts[COUNT_JOINTS];
  counts[COUNT_COMMIT_COUPLINGS] = whole * counts[COUNT_COUPLINGS];
}

SHARED void commit_bodies_item(GLOBAL const float4 *solver_velocity, GLOBAL const float4 *solver_delta_pose,
                               GLOBAL const float4 *solver_orientation, GLOBAL const float4 *previous_body_position,
                               GLOBAL const float4 *body_mass, GLOBAL float4 *body_position,
                               GLOBAL float4 *body_orientation, GLOBAL float4 *body_velocity, item_index i)
{
  store_position(body_position, i,
                 moved_position(load_position(previous_body_position, i), xyz(load_float4(solver_delta_pose, i * 2u))));
  store_float4(body_orientation, i, load_float4(solver_orientation, i));
  spatial_velocity m = load_velocity(solver_velocity, i);
  store_float4(body_velocity, i * 2u, extend(m.linear, m.inverse_mass));
  store_float4(body_velocity, i * 2u + 1u, extend(m.angular, load_float4(body_mass, i).w));
}

SHARED void cache_starts_item(GLOBAL const uint *pair_start, GLOBAL uint *cached_start, uint i)
{
  cached_start[i] = pair_start[i];
}

SHARED void cache_normals_item(GLOBAL const float4 *manifold_normal, GLOBAL float4 *cached_normal, item_index i)
{
  store_float4(cached_normal, i, load_float4(manifold_normal, i));
}

SHARED void cache_pairs_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_b,
                             GLOBAL const uint *pair_color, GLOBAL const uint *manifold_feature, GLOBAL uint *cached_b,
                             GLOBAL uint *cached_color, GLOBAL uint *cached_feature,
                             write_cached_normal_impulses cached_normal_impulses,
                             GLOBAL float4 *cached_friction_impulse, item_index i)
{
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_uint(cached_b, i, load_uint(pair_b, i));
  store_uint(cached_color, i, load_uint(pair_color, i));
  store_real(cached_normal_impulses.single, i, R(0.0));
  if (HAS_FEATURE(parameters, SEVERAL_POINTS)) {
    store_uint(cached_feature, i, load_uint(manifold_feature, i));
    store_float4(cached_normal_impulses.rows, i, zero);
  }
  store_friction(parameters, cached_friction_impulse, i, zero);
}

/* Clears the rows that only pairs with a constraint will fill, because the others must not keep what an older step
 * left. */
SHARED void clear_cached_item(GLOBAL float4 *rows, uint per_item, item_index i)
{
  for (uint k = 0u; k < per_item; ++k) store_float4(rows, i * per_item + k, make_vec4(R(0.0), R(0.0), R(0.0), R(0.0)));
}

/* The next step searches by slot. Impulses stay in the order of their points, and the slots identify them. Friction is
 * stored as a vector in world axes, because its tangents turn with the normal. */
SHARED void cache_impulses_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_pair,
                                GLOBAL const float4 *constraint_normal, GLOBAL const float4 *constraint_normal_impulse,
                                GLOBAL const float4 *constraint_friction_impulse,
                                write_cached_normal_impulses cached_normal_impulses,
                                GLOBAL float4 *cached_friction_impulse, item_index i)
{
  uint_lanes pair = load_uint(constraint_pair, i);
  vec4 normal = load_float4(constraint_normal_impulse, i);
  if (HAS_FEATURE(parameters, SEVERAL_POINTS)) store_float4(cached_normal_impulses.rows, pair, normal);
  else store_real(cached_normal_impulses.single, pair, normal.x);
  if (!HAS_FEATURE(parameters, FRICTION)) return;
  vec4 friction = load_float4(constraint_friction_impulse, i);
  tangents t = tangents_of(xyz(load_float4(constraint_normal, i)));
  store_float4(cached_friction_impulse, pair,
               extend(add(scale(t.first, friction.x), scale(t.second, friction.y)), friction.z));
}

#endif
