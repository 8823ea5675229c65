/* mass_split.cl - entries: rows that are solved all at once. */
#include "cl/entry.h"
#include "shared/solve/mass_split_sum.h"

__kernel void split_supports(__global const uint *constraint_a, __global const uint *constraint_b,
                             __global const uint *body_traits, __global uint *split_supports, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_supports_item(constraint_a, constraint_b, body_traits, split_supports, i);
}

__kernel void split_masses(__global const uint *constraint_a, __global const uint *constraint_b,
                           __global const row *constraint_normal, __global const row *constraint_points,
                           __global const row *constraint_center, __global const row *solver_velocity,
                           __global const row *solver_inertia, __global const uint *incidence_start,
                           __global const uint *split_supports, __global const uint *counts, __global row *split_mass,
                           RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_masses_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                    solver_velocity, solver_inertia, incidence_start, split_supports, counts, split_mass, i);
}

__kernel void split_warm_start(__global const uint *constraint_a, __global const uint *constraint_b,
                               __global const row *constraint_normal, __global const row *constraint_points,
                               __global const row *constraint_center, __global const row *constraint_normal_impulse,
                               __global const row *constraint_friction_impulse, __global const row *solver_velocity,
                               __global const row *solver_inertia, __global const row *solver_delta,
                               __global const uint *counts, __global row *split_impulse, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_warm_start_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                        constraint_normal_impulse, constraint_friction_impulse, solver_velocity, solver_inertia,
                        solver_delta, counts, split_impulse, i);
}

__kernel void split_solve(__global const Parameters *parameters, __global const uint *constraint_a,
                          __global const uint *constraint_b, __global const row *constraint_normal,
                          __global const row *constraint_points, __global const row *constraint_center,
                          __global const memory_real *constraint_slop, __global const row *split_mass,
                          __global const row *solver_velocity, __global const row *solver_inertia,
                          __global const row *solver_delta, __global const uint *counts,
                          __global row *constraint_normal_impulse, __global row *constraint_friction_impulse,
                          __global row *constraint_bounce, __global row *split_pushed, __global row *split_rubbed,
                          __global row *split_impulse, uint biased, uint momentum, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_solve_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                   constraint_slop, split_mass, solver_velocity, solver_inertia, solver_delta, counts,
                   constraint_normal_impulse, constraint_friction_impulse, constraint_bounce, split_pushed,
                   split_rubbed, split_impulse, biased, momentum, i);
}

__kernel void split_restitution(__global const uint *constraint_a, __global const uint *constraint_b,
                                __global const row *constraint_normal, __global const row *constraint_points,
                                __global const row *constraint_bounce, __global const row *split_mass,
                                __global const row *solver_velocity, __global const row *solver_inertia,
                                __global const row *solver_delta, __global const uint *counts,
                                __global row *constraint_normal_impulse, __global row *split_impulse, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_restitution_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_bounce,
                         split_mass, solver_velocity, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                         split_impulse, i);
}

__kernel void split_sum(__global const uint *incidence_body, __global const uint *incidence_start,
                        __global const uint *incidence, __global const row *split_impulse, __global const uint *counts,
                        __global row *split_partial, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_sum_item(incidence_body, incidence_start, incidence, split_impulse, counts, split_partial, i);
}

__kernel void split_join(__global const uint *incidence_body, __global const uint *incidence_start,
                         __global const uint *counts, __global row *split_partial, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_join_item(incidence_body, incidence_start, counts, split_partial, i);
}

__kernel void split_apply(__global const uint *incidence_start, __global const uint *incidence,
                          __global const row *split_impulse, __global const row *split_partial,
                          __global const row *solver_inertia, __global const uint *counts,
                          __global row *solver_velocity, uint trees, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_apply_item(incidence_start, incidence, split_impulse, split_partial, solver_inertia, counts, solver_velocity,
                   trees, i);
}
