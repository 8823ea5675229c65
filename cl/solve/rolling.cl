/* rolling.cl - entries: the torques of rolling friction. */
#include "cl/entry.h"
#include "shared/solve/rolling_tail.h"

__kernel void warm_start_rolling(__global const uint *constraint_a, __global const uint *constraint_b,
                                 __global const row *constraint_normal, __global const row *constraint_rolling,
                                 __global const row *solver_inertia, __global const uint *counts,
                                 __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  warm_start_rolling_item(constraint_a, constraint_b, constraint_normal, constraint_rolling, solver_inertia, counts,
                          solver_velocity, i);
}

__kernel void warm_start_rolling_tail(__global const uint *constraint_a, __global const uint *constraint_b,
                                      __global const row *constraint_normal, __global const row *constraint_rolling,
                                      __global const row *solver_inertia, __global const uint *counts,
                                      __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  warm_start_rolling_tail_item(constraint_a, constraint_b, constraint_normal, constraint_rolling, solver_inertia,
                               counts, solver_velocity, i);
}

__kernel void solve_rolling(__global const uint *constraint_a, __global const uint *constraint_b,
                            __global const row *constraint_normal, __global const row *constraint_normal_impulse,
                            __global const row *solver_inertia, __global const uint *counts,
                            __global row *constraint_rolling, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  solve_rolling_item(constraint_a, constraint_b, constraint_normal, constraint_normal_impulse, solver_inertia, counts,
                     constraint_rolling, solver_velocity, i);
}

__kernel void solve_rolling_tail(__global const uint *constraint_a, __global const uint *constraint_b,
                                 __global const row *constraint_normal, __global const row *constraint_normal_impulse,
                                 __global const row *solver_inertia, __global const uint *counts,
                                 __global row *constraint_rolling, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  solve_rolling_tail_item(constraint_a, constraint_b, constraint_normal, constraint_normal_impulse, solver_inertia,
                          counts, constraint_rolling, solver_velocity, i);
}
