/* xpbd.cl - entries: extended position-based dynamics. */
#include "cl/entry.h"
#include "shared/solve/xpbd_tail.h"

__kernel void xpbd_prepare(__global const uint *constraint_pair, __global const uint *pair_cached,
                           __global const uint *cached_color, __global const row *cached_slip,
                           __global const row *constraint_normal, __global row *constraint_slip, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_prepare_item(constraint_pair, pair_cached, cached_color, cached_slip, constraint_normal, constraint_slip, i);
}

__kernel void xpbd_positions(__global const Parameters *parameters, __global const uint *constraint_a,
                             __global const uint *constraint_b, __global const row *constraint_normal,
                             __global const row *constraint_points, __global const row *constraint_center,
                             __global const row *constraint_slip, __global const row *solver_inertia,
                             __global const row *solver_delta, __global const uint *counts,
                             __global row *constraint_normal_impulse, __global row *constraint_friction_impulse,
                             __global row *constraint_bounce, __global row *solver_velocity, uint first_iteration,
                             RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_positions_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                      constraint_slip, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                      constraint_friction_impulse, constraint_bounce, solver_velocity, first_iteration, i);
}

__kernel void xpbd_positions_tail(__global const Parameters *parameters, __global const uint *constraint_a,
                                  __global const uint *constraint_b, __global const row *constraint_normal,
                                  __global const row *constraint_points, __global const row *constraint_center,
                                  __global const row *constraint_slip, __global const row *solver_inertia,
                                  __global const row *solver_delta, __global const uint *counts,
                                  __global row *constraint_normal_impulse, __global row *constraint_friction_impulse,
                                  __global row *constraint_bounce, __global row *solver_velocity, uint first_iteration,
                                  RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_positions_tail_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                           constraint_center, constraint_slip, solver_inertia, solver_delta, counts,
                           constraint_normal_impulse, constraint_friction_impulse, constraint_bounce, solver_velocity,
                           first_iteration, i);
}

__kernel void xpbd_velocities(__global const Parameters *parameters, __global const uint *constraint_a,
                              __global const uint *constraint_b, __global const row *constraint_normal,
                              __global const row *constraint_points, __global const row *constraint_center,
                              __global const row *solver_inertia, __global const row *solver_delta,
                              __global const uint *counts, __global row *constraint_normal_impulse,
                              __global row *constraint_friction_impulse, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_velocities_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                       solver_inertia, solver_delta, counts, constraint_normal_impulse, constraint_friction_impulse,
                       solver_velocity, i);
}

__kernel void xpbd_velocities_tail(__global const Parameters *parameters, __global const uint *constraint_a,
                                   __global const uint *constraint_b, __global const row *constraint_normal,
                                   __global const row *constraint_points, __global const row *constraint_center,
                                   __global const row *solver_inertia, __global const row *solver_delta,
                                   __global const uint *counts, __global row *constraint_normal_impulse,
                                   __global row *constraint_friction_impulse, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_velocities_tail_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                            constraint_center, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                            constraint_friction_impulse, solver_velocity, i);
}

__kernel void xpbd_cache(__global const uint *constraint_pair, __global const uint *constraint_a,
                         __global const uint *constraint_b, __global const row *constraint_normal,
                         __global const row *constraint_center, __global const row *constraint_slip,
                         __global const row *constraint_normal_impulse, __global const row *constraint_friction_impulse,
                         __global const row *solver_velocity, __global const row *solver_inertia,
                         __global const row *solver_delta, __global const uint *counts, __global row *cached_slip,
                         RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_cache_item(constraint_pair, constraint_a, constraint_b, constraint_normal, constraint_center, constraint_slip,
                  constraint_normal_impulse, constraint_friction_impulse, solver_velocity, solver_inertia, solver_delta,
                  counts, cached_slip, i);
}
