/* integrate.cl - entries: bodies: forces, motion, and the end of a step. */
#include "cl/entry.h"
#include "shared/integrate/commit.h"
#include "shared/integrate/prepare.h"
#include "shared/integrate/velocities.h"
#include "shared/integrate/positions.h"
#include "shared/integrate/cache_rolling.h"
#include "shared/integrate/stop_motion.h"

__kernel void begin_step(__global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  begin_step_item(counts, i);
}

__kernel void prepare_bodies(__global const row *body_mass, __global const row *body_position,
                             __global const row *body_orientation, __global const row *body_velocity,
                             __global uint *counts, __global row *solver_velocity, __global row *solver_delta,
                             __global row *solver_push, __global row *solver_inertia, __global row *solver_orientation,
                             __global uint *body_colors, __global uint *body_bid, __global uint *body_falls, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  prepare_bodies_item(body_mass, body_position, body_orientation, body_velocity, counts, solver_velocity, solver_delta,
                      solver_push, solver_inertia, solver_orientation, body_colors, body_bid, body_falls, i);
}

__kernel void integrate_velocities(__global const Parameters *parameters, __global const row *body_mass,
                                   __global const row *solver_inertia, __global row *solver_velocity,
                                   __global row *solver_push, __global float *solver_unpushed, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  integrate_velocities_item(parameters, body_mass, solver_inertia, solver_velocity, solver_push, solver_unpushed, i);
}

__kernel void integrate_positions(__global const Parameters *parameters, __global const row *body_mass,
                                  __global const uint *body_falls, __global const float *solver_unpushed,
                                  __global row *solver_velocity, __global row *solver_delta,
                                  __global row *solver_inertia, __global row *solver_orientation, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  integrate_positions_item(parameters, body_mass, body_falls, solver_unpushed, solver_velocity, solver_delta,
                           solver_inertia, solver_orientation, i);
}

__kernel void check_bodies(__global const row *body_position, __global const row *solver_velocity,
                           __global const row *solver_delta, __global const row *solver_orientation,
                           __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  check_bodies_item(body_position, solver_velocity, solver_delta, solver_orientation, counts, i);
}

__kernel void finish_step(__global uint *counts, uint colors, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  finish_step_item(counts, colors, i);
}

__kernel void commit_bodies(__global const row *solver_velocity, __global const row *solver_delta,
                            __global const row *solver_orientation, __global const row *previous_body_position,
                            __global const row *body_mass, __global row *body_position, __global row *body_orientation,
                            __global row *body_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  commit_bodies_item(solver_velocity, solver_delta, solver_orientation, previous_body_position, body_mass,
                     body_position, body_orientation, body_velocity, i);
}

__kernel void cache_starts(__global const uint *pair_start, __global uint *cached_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  cache_starts_item(pair_start, cached_start, i);
}

__kernel void cache_normals(__global const row *manifold_normal, __global row *cached_normal, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  cache_normals_item(manifold_normal, cached_normal, i);
}

__kernel void cache_pairs(__global const uint *pair_b, __global const uint *pair_color,
                          __global const uint *manifold_feature, __global uint *cached_b, __global uint *cached_color,
                          __global uint *cached_feature, __global row *cached_normal_impulse,
                          __global row *cached_friction_impulse, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  cache_pairs_item(pair_b, pair_color, manifold_feature, cached_b, cached_color, cached_feature, cached_normal_impulse,
                   cached_friction_impulse, i);
}

__kernel void cache_impulses(__global const uint *constraint_pair, __global const row *constraint_normal,
                             __global const row *constraint_normal_impulse,
                             __global const row *constraint_friction_impulse, __global row *cached_normal_impulse,
                             __global row *cached_friction_impulse, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  cache_impulses_item(constraint_pair, constraint_normal, constraint_normal_impulse, constraint_friction_impulse,
                      cached_normal_impulse, cached_friction_impulse, i);
}

__kernel void clear_cached(__global row *rows, uint per_item, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  clear_cached_item(rows, per_item, i);
}

__kernel void cache_rolling(__global const uint *constraint_pair, __global const row *constraint_rolling,
                            __global row *cached_rolling_impulse, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  cache_rolling_item(constraint_pair, constraint_rolling, cached_rolling_impulse, i);
}

__kernel void stop_motion(__global const row *body_orientation, __global const uint *body_share,
                          __global row *solver_delta, __global row *solver_orientation, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  stop_motion_item(body_orientation, body_share, solver_delta, solver_orientation, i);
}
