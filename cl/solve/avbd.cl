/* avbd.cl - entries: augmented vertex block descent. */
#include "cl/entry.h"
#include "shared/solve/avbd_bodies.h"

__kernel void avbd_prepare(__global const uint *constraint_pair, __global const uint *pair_cached,
                           __global const uint *manifold_feature, __global const uint *cached_color,
                           __global const uint *cached_feature, __global const row *cached_penalty,
                           __global const row *constraint_points, __global const row *constraint_center,
                           __global const uint *counts, __global row *constraint_normal_impulse,
                           __global row *constraint_friction_impulse, __global row *constraint_penalty, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_prepare_item(constraint_pair, pair_cached, manifold_feature, cached_color, cached_feature, cached_penalty,
                    constraint_points, constraint_center, counts, constraint_normal_impulse,
                    constraint_friction_impulse, constraint_penalty, i);
}

__kernel void avbd_begin(__global const Parameters *parameters, __global const row *body_mass,
                         __global const uint *incidence_start, __global row *solver_velocity, __global row *avbd_target,
                         RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_begin_item(parameters, body_mass, incidence_start, solver_velocity, avbd_target, i);
}

__kernel void avbd_bodies(__global const Parameters *parameters, __global const row *body_mass,
                          __global const uint *constraint_a, __global const uint *constraint_b,
                          __global const row *constraint_normal, __global const row *constraint_points,
                          __global const row *constraint_center, __global const row *constraint_normal_impulse,
                          __global const row *constraint_friction_impulse, __global const row *constraint_penalty,
                          __global const uint *incidence_start, __global const uint *incidence,
                          __global const uint *sort_value, __global const row *avbd_target,
                          __global const row *solver_inertia, __global const row *solver_delta,
                          __global const row *solver_orientation, __global const uint *counts,
                          __global row *solver_velocity, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_bodies_item(parameters, body_mass, constraint_a, constraint_b, constraint_normal, constraint_points,
                   constraint_center, constraint_normal_impulse, constraint_friction_impulse, constraint_penalty,
                   incidence_start, incidence, sort_value, avbd_target, solver_inertia, solver_delta,
                   solver_orientation, counts, solver_velocity, i);
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
                 incidence_start, incidence, sort_value, avbd_target, solver_inertia, solver_delta, solver_orientation,
                 counts, solver_velocity, color, i);
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
  avbd_duals_item(parameters, constraint_a, constraint_b, constraint_normal, constraint_points, constraint_center,
                  solver_inertia, solver_delta, solver_velocity, counts, constraint_normal_impulse,
                  constraint_friction_impulse, constraint_penalty, constraint_bounce, i);
}

__kernel void avbd_cache(__global const uint *constraint_pair, __global const row *constraint_penalty,
                         __global row *cached_penalty, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  avbd_cache_item(constraint_pair, constraint_penalty, cached_penalty, i);
}
