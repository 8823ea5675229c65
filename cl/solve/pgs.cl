/* pgs.cl - entries: projected Gauss-Seidel, and conjugate gradients over it. */
#include "cl/entry.h"
#include "shared/solve/pgs.h"
#include "shared/solve/nncg.h"

__kernel void pgs_normals(__global const Parameters *parameters, __global const uint *constraint_a,
                          __global const uint *constraint_b, __global const row *constraint_normal,
                          __global const row *constraint_points, __global const memory_real *constraint_slop,
                          __global const row *solver_inertia, __global const row *solver_delta,
                          __global const uint *counts, __global row *constraint_normal_impulse,
                          __global row *constraint_bounce, __global row *solver_velocity, uint biased, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pgs_normals_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_slop,
                   solver_inertia, solver_delta, counts, constraint_normal_impulse, constraint_bounce, solver_velocity,
                   biased, i);
}

__kernel void pgs_friction(__global const uint *constraint_a, __global const uint *constraint_b,
                           __global const row *constraint_normal, __global const row *constraint_center,
                           __global const row *constraint_normal_impulse, __global const row *solver_inertia,
                           __global const row *solver_delta, __global const uint *counts,
                           __global row *constraint_friction_impulse, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pgs_friction_item(constraint_a, constraint_b, constraint_normal, constraint_center, constraint_normal_impulse,
                    solver_inertia, solver_delta, counts, constraint_friction_impulse, solver_velocity, i);
}

__kernel void pgs_masses(__global const uint *constraint_a, __global const uint *constraint_b,
                         __global const row *constraint_normal, __global const row *solver_velocity,
                         __global const row *solver_inertia, __global const row *solver_delta,
                         __global const uint *counts, __global row *constraint_points, __global row *constraint_center,
                         RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pgs_masses_item(constraint_a, constraint_b, constraint_normal, solver_velocity, solver_inertia, solver_delta, counts,
                  constraint_points, constraint_center, i);
}

__kernel void nncg_begin(__global const row *constraint_normal_impulse, __global const row *constraint_friction_impulse,
                         __global const uint *counts, __global row *nncg_impulse, __global row *nncg_direction, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  nncg_begin_item(constraint_normal_impulse, constraint_friction_impulse, counts, nncg_impulse, nncg_direction, i);
}

__kernel void nncg_change(__global const row *constraint_points, __global const row *constraint_center,
                          __global const row *constraint_normal_impulse,
                          __global const row *constraint_friction_impulse, __global const row *nncg_impulse,
                          __global const uint *counts, __global memory_real *nncg_square, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  nncg_change_item(constraint_points, constraint_center, constraint_normal_impulse, constraint_friction_impulse,
                   nncg_impulse, counts, nncg_square, i);
}

__kernel void nncg_beta(__global const memory_real *nncg_sum, __global memory_real *nncg_state, uint begins, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  nncg_beta_item(nncg_sum, nncg_state, begins, i);
}

__kernel void nncg_advance(__global const uint *constraint_a, __global const uint *constraint_b,
                           __global const row *constraint_normal, __global const row *constraint_points,
                           __global const row *constraint_center, __global const row *solver_inertia,
                           __global const row *solver_delta, __global const memory_real *nncg_state,
                           __global const uint *counts, __global row *constraint_normal_impulse,
                           __global row *constraint_friction_impulse, __global row *nncg_impulse,
                           __global row *nncg_direction, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  nncg_advance_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center, solver_inertia,
                    solver_delta, nncg_state, counts, constraint_normal_impulse, constraint_friction_impulse,
                    nncg_impulse, nncg_direction, solver_velocity, i);
}
