/* setup.cl - entries: contact constraints. */
#include "cl/entry.h"
#include "shared/setup/contact.h"
#include "shared/setup/rolling.h"

__kernel void prepare_contacts(__global const Parameters *parameters, __global const row *material,
                               __global const uint *body_traits, __global const row *body_shape,
                               __global const row *body_mass, __global const row *body_position,
                               __global const row *solver_velocity, __global const row *solver_inertia,
                               __global const uint *pair_a, __global const uint *pair_b, __global const uint *pair_leaf,
                               __global const uint *pair_cached, __global const row *manifold_normal,
                               __global const row *manifold_points, __global const uint *manifold_count,
                               __global const uint *manifold_feature, __global const uint *cached_feature,
                               __global const row *cached_normal_impulse, __global const row *cached_friction_impulse,
                               __global const uint *sort_value, __global const uint *counts,
                               __global uint *constraint_pair, __global uint *constraint_a, __global uint *constraint_b,
                               __global row *constraint_normal, __global row *constraint_points,
                               __global row *constraint_center, __global row *constraint_normal_impulse,
                               __global row *constraint_friction_impulse, __global row *constraint_bounce,
                               __global float *constraint_slop, __global uint *body_falls, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  prepare_contacts_item(parameters, material, body_traits, body_shape, body_mass, body_position, solver_velocity,
                        solver_inertia, pair_a, pair_b, pair_leaf, pair_cached, manifold_normal, manifold_points,
                        manifold_count, manifold_feature, cached_feature, cached_normal_impulse,
                        cached_friction_impulse, sort_value, counts, constraint_pair, constraint_a, constraint_b,
                        constraint_normal, constraint_points, constraint_center, constraint_normal_impulse,
                        constraint_friction_impulse, constraint_bounce, constraint_slop, body_falls, i);
}

__kernel void prepare_rolling(__global const Parameters *parameters, __global const uint *pair_leaf,
                              __global const row *material, __global const row *material_rolling,
                              __global const uint *body_traits, __global const uint *pair_cached,
                              __global const row *cached_rolling_impulse, __global const uint *constraint_pair,
                              __global const uint *constraint_a, __global const uint *constraint_b,
                              __global const uint *counts, __global row *constraint_rolling, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  prepare_rolling_item(parameters, pair_leaf, material, material_rolling, body_traits, pair_cached,
                       cached_rolling_impulse, constraint_pair, constraint_a, constraint_b, counts, constraint_rolling,
                       i);
}
