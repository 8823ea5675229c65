/* contact.cl - entries: the rows of the soft step, which most solvers share. */
#include "cl/entry.h"
#include "shared/solve/contact.h"

__kernel void warm_start(__global const uint *constraint_a, __global const uint *constraint_b,
                         __global const row *constraint_normal, __global const row *constraint_points,
                         __global const row *constraint_center, __global const row *constraint_normal_impulse,
                         __global const row *constraint_friction_impulse, __global const row *solver_inertia,
                         __global const row *solver_delta, __global const uint *counts, __global row *solver_velocity,
                         RANGE)
{
  FOR_EACH_IN_RANGE(i)
  warm_start_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                  constraint_normal_impulse, constraint_friction_impulse, solver_inertia, solver_delta, counts,
                  solver_velocity, i);
}

__kernel void solve_contacts(__global const Parameters *parameters, __global const uint *constraint_a,
                             __global const uint *constraint_b, __global const row *constraint_normal,
                             __global const row *constraint_points, __global const row *constraint_center,
                             __global const float *constraint_slop, __global const row *solver_inertia,
                             __global const row *solver_delta, __global const uint *counts,
                             __global row *constraint_normal_impulse, __global row *constraint_friction_impulse,
                             __global row *constraint_bounce, __global row *solver_velocity, __global row *solver_push,
                             uint pass, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  solve_contacts_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                      constraint_slop, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                      constraint_friction_impulse, constraint_bounce, solver_velocity, solver_push, pass, i);
}

__kernel void apply_restitution(__global const uint *constraint_a, __global const uint *constraint_b,
                                __global const row *constraint_normal, __global const row *constraint_points,
                                __global const row *constraint_bounce, __global const row *solver_inertia,
                                __global const row *solver_delta, __global const uint *counts,
                                __global row *constraint_normal_impulse, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  apply_restitution_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_bounce,
                         solver_inertia, solver_delta, counts, constraint_normal_impulse, solver_velocity, i);
}
