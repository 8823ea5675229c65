/* solve.cl - entries: the contact solver. */
#include "cl/entry.h"
#include "shared/solve/contact.h"
#include "shared/solve/avbd_bodies.h"
#include "shared/solve/mass_split_sum.h"
#include "shared/solve/tail.h"
#include "shared/solve/xpbd.h"
#include "shared/solve/xpbd_tail.h"

__kernel void warm_start(__global const uint *constraint_a, __global const uint *constraint_b,
                         __global const row *constraint_normal, __global const row *constraint_points,
                         __global const row *constraint_center, __global const row *constraint_normal_impulse,
                         __global const row *constraint_friction_impulse, __global const row *solver_inertia,
                         __global const row *solver_delta,
                         __global const uint *counts, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  warm_start_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                  constraint_normal_impulse, constraint_friction_impulse, solver_inertia, solver_delta, counts,
                  solver_velocity, i);
}

__kernel void warm_start_tail(__global const uint *constraint_a, __global const uint *constraint_b,
                              __global const row *constraint_normal, __global const row *constraint_points,
                              __global const row *constraint_center,
                              __global const row *constraint_normal_impulse,
                              __global const row *constraint_friction_impulse,
                              __global const row *solver_inertia, __global const row *solver_delta,
                              __global const uint *counts,
                              __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  warm_start_tail_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                       constraint_normal_impulse, constraint_friction_impulse, solver_inertia, solver_delta, counts,
                       solver_velocity, i);
}

__kernel void solve_contacts(__global const Parameters *parameters, __global const uint *constraint_a,
                             __global const uint *constraint_b, __global const row *constraint_normal,
                             __global const row *constraint_points, __global const row *constraint_center,
                             __global const row *solver_inertia, __global const row *solver_delta,
                             __global const uint *counts, __global row *constraint_normal_impulse,
                             __global row *constraint_friction_impulse, __global row *constraint_bounce,
                             __global row *solver_velocity, uint biased, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  solve_contacts_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                      constraint_center, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                      constraint_friction_impulse, constraint_bounce, solver_velocity, biased, i);
}

__kernel void solve_tail(__global const Parameters *parameters, __global const uint *constraint_a,
                         __global const uint *constraint_b, __global const row *constraint_normal,
                         __global const row *constraint_points, __global const row *constraint_center,
                         __global const row *solver_inertia, __global const row *solver_delta,
                         __global const uint *counts, __global row *constraint_normal_impulse,
                         __global row *constraint_friction_impulse, __global row *constraint_bounce,
                         __global row *solver_velocity, uint biased, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  solve_tail_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                  constraint_center, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                  constraint_friction_impulse, constraint_bounce, solver_velocity, biased, i);
}

__kernel void xpbd_prepare(__global const uint *constraint_pair, __global const uint *pair_cached,
                           __global const uint *cached_color, __global const row *cached_slip,
                           __global const row *constraint_normal, __global row *constraint_slip, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_prepare_item(constraint_pair, pair_cached, cached_color, cached_slip, constraint_normal, constraint_slip,
                    i);
}

__kernel void xpbd_positions(__global const Parameters *parameters, __global const uint *constraint_a,
                             __global const uint *constraint_b, __global const row *constraint_normal,
                             __global const row *constraint_points, __global const row *constraint_center,
                             __global const row *constraint_slip, __global const row *solver_inertia,
                             __global const row *solver_delta, __global const uint *counts,
                             __global row *constraint_normal_impulse, __global row *constraint_friction_impulse,
                             __global row *constraint_bounce, __global row *solver_velocity,
                             uint first_iteration, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_positions_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                      constraint_center, constraint_slip, solver_inertia, solver_delta, counts,
                      constraint_normal_impulse, constraint_friction_impulse, constraint_bounce,
                      solver_velocity, first_iteration, i);
}

__kernel void xpbd_positions_tail(__global const Parameters *parameters, __global const uint *constraint_a,
                                  __global const uint *constraint_b, __global const row *constraint_normal,
                                  __global const row *constraint_points, __global const row *constraint_center,
                                  __global const row *constraint_slip, __global const row *solver_inertia,
                                  __global const row *solver_delta, __global const uint *counts,
                                  __global row *constraint_normal_impulse,
                                  __global row *constraint_friction_impulse, __global row *constraint_bounce,
                                  __global row *solver_velocity, uint first_iteration, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_positions_tail_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                           constraint_center, constraint_slip, solver_inertia, solver_delta, counts,
                           constraint_normal_impulse, constraint_friction_impulse, constraint_bounce,
                           solver_velocity, first_iteration, i);
}

__kernel void xpbd_velocities(__global const Parameters *parameters, __global const uint *constraint_a,
                              __global const uint *constraint_b, __global const row *constraint_normal,
                              __global const row *constraint_points, __global const row *constraint_center,
                              __global const row *solver_inertia, __global const row *solver_delta,
                              __global const uint *counts, __global row *constraint_normal_impulse,
                              __global row *constraint_friction_impulse, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_velocities_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                       constraint_center, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                       constraint_friction_impulse, solver_velocity, i);
}

__kernel void xpbd_velocities_tail(__global const Parameters *parameters, __global const uint *constraint_a,
                                   __global const uint *constraint_b, __global const row *constraint_normal,
                                   __global const row *constraint_points, __global const row *constraint_center,
                                   __global const row *solver_inertia, __global const row *solver_delta,
                                   __global const uint *counts, __global row *constraint_normal_impulse,
                                   __global row *constraint_friction_impulse, __global row *solver_velocity,
                                   RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_velocities_tail_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                            constraint_center, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                            constraint_friction_impulse, solver_velocity, i);
}

__kernel void xpbd_cache(__global const uint *constraint_pair, __global const uint *constraint_a,
                         __global const uint *constraint_b, __global const row *constraint_normal,
                         __global const row *constraint_center, __global const row *constraint_slip,
                         __global const row *constraint_normal_impulse,
                         __global const row *constraint_friction_impulse, __global const row *solver_velocity,
                         __global const row *solver_inertia, __global const row *solver_delta,
                         __global const uint *counts, __global row *cached_slip, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  xpbd_cache_item(constraint_pair, constraint_a, constraint_b, constraint_normal, constraint_center,
                  constraint_slip, constraint_normal_impulse, constraint_friction_impulse, solver_velocity,
                  solver_inertia, solver_delta, counts, cached_slip, i);
}

__kernel void apply_restitution(__global const uint *constraint_a, __global const uint *constraint_b,
                                __global const row *constraint_normal, __global const row *constraint_points,
                                __global const row *constraint_bounce, __global const row *solver_inertia,
                                __global const row *solver_delta,
                                __global const uint *counts, __global row *constraint_normal_impulse,
                                __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  apply_restitution_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_bounce,
                         solver_inertia, solver_delta, counts, constraint_normal_impulse, solver_velocity, i);
}

__kernel void apply_restitution_tail(__global const uint *constraint_a, __global const uint *constraint_b,
                                     __global const row *constraint_normal,
                                     __global const row *constraint_points,
                                     __global const row *constraint_bounce, __global const row *solver_inertia,
                                     __global const row *solver_delta,
                                     __global const uint *counts, __global row *constraint_normal_impulse,
                                     __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  apply_restitution_tail_item(constraint_a, constraint_b, constraint_normal, constraint_points,
                              constraint_bounce, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                              solver_velocity, i);
}

__kernel void split_masses(__global const uint *constraint_a, __global const uint *constraint_b,
                           __global const row *constraint_normal, __global const row *constraint_points,
                           __global const row *constraint_center, __global const row *solver_velocity,
                           __global const row *solver_inertia, __global const uint *incidence_start,
                           __global const uint *counts, __global row *split_mass, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_masses_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                    solver_velocity, solver_inertia, incidence_start, counts, split_mass, i);
}

__kernel void split_warm_start(__global const uint *constraint_a, __global const uint *constraint_b,
                               __global const row *constraint_normal, __global const row *constraint_points,
                               __global const row *constraint_center,
                               __global const row *constraint_normal_impulse,
                               __global const row *constraint_friction_impulse,
                               __global const row *solver_velocity, __global const row *solver_inertia,
                               __global const row *solver_delta, __global const uint *counts,
                               __global row *split_impulse, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_warm_start_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                        constraint_normal_impulse, constraint_friction_impulse, solver_velocity, solver_inertia,
                        solver_delta, counts, split_impulse, i);
}

__kernel void split_solve(__global const Parameters *parameters, __global const uint *constraint_a,
                          __global const uint *constraint_b, __global const row *constraint_normal,
                          __global const row *constraint_points, __global const row *constraint_center,
                          __global const row *split_mass, __global const row *solver_velocity,
                          __global const row *solver_inertia, __global const row *solver_delta,
                          __global const uint *counts, __global row *constraint_normal_impulse,
                          __global row *constraint_friction_impulse, __global row *constraint_bounce,
                          __global row *split_impulse, uint biased, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_solve_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                   constraint_center, split_mass, solver_velocity, solver_inertia, solver_delta, counts,
                   constraint_normal_impulse, constraint_friction_impulse, constraint_bounce, split_impulse,
                   biased, i);
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
                         split_mass, solver_velocity, solver_inertia, solver_delta, counts,
                         constraint_normal_impulse, split_impulse, i);
}

__kernel void split_sum(__global const uint *incidence_body, __global const uint *incidence_start,
                        __global const uint *incidence, __global const row *split_impulse,
                        __global const uint *counts, __global row *split_partial, RANGE)
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
  split_apply_item(incidence_start, incidence, split_impulse, split_partial, solver_inertia, counts,
                   solver_velocity, trees, i);
}

__kernel void avbd_prepare(__global const uint *constraint_pair, __global const uint *pair_cached,
                           __global const uint *manifold_feature, __global const uint *cached_color,
                           __global const uint *cached_feature, __global const row *cached_penalty,
                           __global const row *constraint_points, __global const row *constraint_center,
                           __global const uint *counts, __global row *constraint_normal_impulse,
                           __global row *constraint_friction_impulse, __global row *constraint_penalty, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_prepare_item(constraint_pair, pair_cached, manifold_feature, cached_color, cached_feature,
                    cached_penalty, constraint_points, constraint_center, counts, constraint_normal_impulse,
                    constraint_friction_impulse, constraint_penalty, i);
}

__kernel void avbd_begin(__global const Parameters *parameters, __global const row *body_mass,
                         __global const uint *incidence_start, __global row *solver_velocity,
                         __global row *avbd_target, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_begin_item(parameters, body_mass, incidence_start, solver_velocity, avbd_target, i);
}

__kernel void avbd_bodies(__global const Parameters *parameters, __global const row *body_mass,
                          __global const uint *constraint_a, __global const uint *constraint_b,
                          __global const row *constraint_normal, __global const row *constraint_points,
                          __global const row *constraint_center, __global const row *constraint_normal_impulse,
                          __global const row *constraint_friction_impulse,
                          __global const row *constraint_penalty, __global const uint *incidence_start,
                          __global const uint *incidence, __global const uint *sort_value,
                          __global const row *avbd_target, __global const row *solver_inertia,
                          __global const row *solver_delta, __global const row *solver_orientation,
                          __global const uint *counts, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_bodies_item(parameters, body_mass, constraint_a, constraint_b, constraint_normal, constraint_points,
                   constraint_center, constraint_normal_impulse, constraint_friction_impulse,
                   constraint_penalty, incidence_start, incidence, sort_value, avbd_target, solver_inertia,
                   solver_delta, solver_orientation, counts, solver_velocity, i);
}

__kernel void avbd_rest(__global const Parameters *parameters, __global const row *body_mass,
                        __global const uint *constraint_a, __global const uint *constraint_b,
                        __global const row *constraint_normal, __global const row *constraint_points,
                        __global const row *constraint_center, __global const row *constraint_normal_impulse,
                        __global const row *constraint_friction_impulse, __global const row *constraint_penalty,
                        __global const uint *incidence_start, __global const uint *incidence,
                        __global const uint *sort_value, __global const row *avbd_target,
                        __global const row *solver_inertia, __global const row *solver_delta,
                        __global const row *solver_orientation, __global const uint *counts,
                        __global row *solver_velocity, uint color, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_rest_item(parameters, body_mass, constraint_a, constraint_b, constraint_normal, constraint_points,
                 constraint_center, constraint_normal_impulse, constraint_friction_impulse, constraint_penalty,
                 incidence_start, incidence, sort_value, avbd_target, solver_inertia, solver_delta,
                 solver_orientation, counts, solver_velocity, color, i);
}

__kernel void avbd_duals(__global const Parameters *parameters, __global const uint *constraint_a,
                         __global const uint *constraint_b, __global const row *constraint_normal,
                         __global const row *constraint_points, __global const row *constraint_center,
                         __global const row *solver_inertia, __global const row *solver_delta,
                         __global const row *solver_velocity, __global const uint *counts,
                         __global row *constraint_normal_impulse, __global row *constraint_friction_impulse,
                         __global row *constraint_penalty, __global row *constraint_bounce, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_duals_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                  constraint_center, solver_inertia, solver_delta, solver_velocity, counts,
                  constraint_normal_impulse, constraint_friction_impulse, constraint_penalty, constraint_bounce,
                  i);
}

__kernel void avbd_cache(__global const uint *constraint_pair, __global const row *constraint_penalty,
                         __global row *cached_penalty, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_cache_item(constraint_pair, constraint_penalty, cached_penalty, i);
}
