/* solve.cl - entries: the contact solver. */
#include "cl/entry.h"
#include "shared/solve/contact.h"
#include "shared/solve/avbd_bodies.h"
#include "shared/solve/mass_split_sum.h"
#include "shared/solve/tail.h"
#include "shared/solve/xpbd.h"
#include "shared/solve/xpbd_tail.h"
#include "shared/solve/pgs.h"
#include "shared/solve/pgs_tail.h"
#include "shared/solve/nncg.h"
#include "shared/solve/nncg_tail.h"
#include "shared/solve/rolling.h"
#include "shared/solve/rolling_tail.h"

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
                             __global const float *constraint_slop, __global const row *solver_inertia,
                             __global const row *solver_delta, __global const uint *counts,
                             __global row *constraint_normal_impulse, __global row *constraint_friction_impulse,
                             __global row *constraint_bounce,
                             __global row *solver_velocity, __global row *solver_push, uint pass, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  solve_contacts_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                      constraint_center, constraint_slop, solver_inertia, solver_delta, counts,
                      constraint_normal_impulse, constraint_friction_impulse, constraint_bounce, solver_velocity,
                      solver_push, pass, i);
}

__kernel void solve_tail(__global const Parameters *parameters, __global const uint *constraint_a,
                         __global const uint *constraint_b, __global const row *constraint_normal,
                         __global const row *constraint_points, __global const row *constraint_center,
                         __global const float *constraint_slop, __global const row *solver_inertia,
                         __global const row *solver_delta, __global const uint *counts,
                         __global row *constraint_normal_impulse, __global row *constraint_friction_impulse,
                         __global row *constraint_bounce,
                         __global row *solver_velocity, __global row *solver_push, uint pass, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  solve_tail_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                  constraint_center, constraint_slop, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                  constraint_friction_impulse, constraint_bounce, solver_velocity, solver_push, pass, i);
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
                           __global const uint *split_supports, __global const uint *counts,
                           __global row *split_mass, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_masses_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                    solver_velocity, solver_inertia, incidence_start, split_supports, counts, split_mass, i);
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
                          __global const memory_real *constraint_slop, __global const row *split_mass,
                          __global const row *solver_velocity,
                          __global const row *solver_inertia, __global const row *solver_delta,
                          __global const uint *counts, __global row *constraint_normal_impulse,
                          __global row *constraint_friction_impulse, __global row *constraint_bounce,
                          __global row *split_pushed, __global row *split_rubbed, __global row *split_impulse,
                          uint biased, uint momentum, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  split_solve_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                   constraint_center, constraint_slop, split_mass, solver_velocity, solver_inertia, solver_delta, counts,
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

__kernel void pgs_normals(__global const Parameters *parameters, __global const uint *constraint_a,
                          __global const uint *constraint_b, __global const row *constraint_normal,
                          __global const row *constraint_points, __global const memory_real *constraint_slop,
                          __global const row *solver_inertia, __global const row *solver_delta,
                          __global const uint *counts, __global row *constraint_normal_impulse,
                          __global row *constraint_bounce, __global row *solver_velocity, uint biased, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pgs_normals_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                   constraint_slop, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                   constraint_bounce, solver_velocity, biased, i);
}

__kernel void pgs_normals_tail(__global const Parameters *parameters, __global const uint *constraint_a,
                               __global const uint *constraint_b, __global const row *constraint_normal,
                               __global const row *constraint_points,
                               __global const memory_real *constraint_slop, __global const row *solver_inertia,
                               __global const row *solver_delta, __global const uint *counts,
                               __global row *constraint_normal_impulse, __global row *constraint_bounce,
                               __global row *solver_velocity, uint biased, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pgs_normals_tail_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points,
                        constraint_slop, solver_inertia, solver_delta, counts, constraint_normal_impulse,
                        constraint_bounce, solver_velocity, biased, i);
}

__kernel void pgs_friction(__global const uint *constraint_a, __global const uint *constraint_b,
                           __global const row *constraint_normal, __global const row *constraint_center,
                           __global const row *constraint_normal_impulse, __global const row *solver_inertia,
                           __global const row *solver_delta, __global const uint *counts,
                           __global row *constraint_friction_impulse, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pgs_friction_item(constraint_a, constraint_b, constraint_normal, constraint_center,
                    constraint_normal_impulse, solver_inertia, solver_delta, counts,
                    constraint_friction_impulse, solver_velocity, i);
}

__kernel void pgs_friction_tail(__global const uint *constraint_a, __global const uint *constraint_b,
                                __global const row *constraint_normal, __global const row *constraint_center,
                                __global const row *constraint_normal_impulse,
                                __global const row *solver_inertia, __global const row *solver_delta,
                                __global const uint *counts, __global row *constraint_friction_impulse,
                                __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pgs_friction_tail_item(constraint_a, constraint_b, constraint_normal, constraint_center,
                         constraint_normal_impulse, solver_inertia, solver_delta, counts,
                         constraint_friction_impulse, solver_velocity, i);
}

__kernel void pgs_masses(__global const uint *constraint_a, __global const uint *constraint_b,
                         __global const row *constraint_normal, __global const row *solver_velocity,
                         __global const row *solver_inertia, __global const row *solver_delta,
                         __global const uint *counts, __global row *constraint_points,
                         __global row *constraint_center, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pgs_masses_item(constraint_a, constraint_b, constraint_normal, solver_velocity, solver_inertia, solver_delta,
                  counts, constraint_points, constraint_center, i);
}

__kernel void nncg_begin(__global const row *constraint_normal_impulse,
                         __global const row *constraint_friction_impulse, __global const uint *counts,
                         __global row *nncg_impulse, __global row *nncg_direction, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  nncg_begin_item(constraint_normal_impulse, constraint_friction_impulse, counts, nncg_impulse, nncg_direction,
                  i);
}

__kernel void nncg_change(__global const row *constraint_points, __global const row *constraint_center,
                          __global const row *constraint_normal_impulse,
                          __global const row *constraint_friction_impulse, __global const row *nncg_impulse,
                          __global const uint *counts, __global memory_real *nncg_square, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  nncg_change_item(constraint_points, constraint_center, constraint_normal_impulse,
                   constraint_friction_impulse, nncg_impulse, counts, nncg_square, i);
}

__kernel void nncg_beta(__global const memory_real *nncg_sum, __global memory_real *nncg_state, uint begins,
                        RANGE)
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
  nncg_advance_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                    solver_inertia, solver_delta, nncg_state, counts, constraint_normal_impulse,
                    constraint_friction_impulse, nncg_impulse, nncg_direction, solver_velocity, i);
}

__kernel void nncg_advance_tail(__global const uint *constraint_a, __global const uint *constraint_b,
                                __global const row *constraint_normal, __global const row *constraint_points,
                                __global const row *constraint_center, __global const row *solver_inertia,
                                __global const row *solver_delta, __global const memory_real *nncg_state,
                                __global const uint *counts, __global row *constraint_normal_impulse,
                                __global row *constraint_friction_impulse, __global row *nncg_impulse,
                                __global row *nncg_direction, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  nncg_advance_tail_item(constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                         solver_inertia, solver_delta, nncg_state, counts, constraint_normal_impulse,
                         constraint_friction_impulse, nncg_impulse, nncg_direction, solver_velocity, i);
}

__kernel void warm_start_rolling(__global const uint *constraint_a, __global const uint *constraint_b,
                                 __global const row *constraint_normal, __global const row *constraint_rolling,
                                 __global const row *solver_inertia, __global const uint *counts,
                                 __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  warm_start_rolling_item(constraint_a, constraint_b, constraint_normal, constraint_rolling, solver_inertia,
                          counts, solver_velocity, i);
}

__kernel void warm_start_rolling_tail(__global const uint *constraint_a, __global const uint *constraint_b,
                                      __global const row *constraint_normal,
                                      __global const row *constraint_rolling,
                                      __global const row *solver_inertia, __global const uint *counts,
                                      __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  warm_start_rolling_tail_item(constraint_a, constraint_b, constraint_normal, constraint_rolling,
                               solver_inertia, counts, solver_velocity, i);
}

__kernel void solve_rolling(__global const uint *constraint_a, __global const uint *constraint_b,
                            __global const row *constraint_normal,
                            __global const row *constraint_normal_impulse, __global const row *solver_inertia,
                            __global const uint *counts, __global row *constraint_rolling,
                            __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  solve_rolling_item(constraint_a, constraint_b, constraint_normal, constraint_normal_impulse, solver_inertia,
                     counts, constraint_rolling, solver_velocity, i);
}

__kernel void solve_rolling_tail(__global const uint *constraint_a, __global const uint *constraint_b,
                                 __global const row *constraint_normal,
                                 __global const row *constraint_normal_impulse,
                                 __global const row *solver_inertia, __global const uint *counts,
                                 __global row *constraint_rolling, __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  solve_rolling_tail_item(constraint_a, constraint_b, constraint_normal, constraint_normal_impulse,
                          solver_inertia, counts, constraint_rolling, solver_velocity, i);
}
