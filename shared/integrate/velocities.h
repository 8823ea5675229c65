/* velocities.h - applies gravity, damping and the warm start over one substep: the forces of the pipeline. */
#ifndef TANDEM_SHARED_INTEGRATE_VELOCITIES_H
#define TANDEM_SHARED_INTEGRATE_VELOCITIES_H

#include "shared/substep_classes.h"

/* The impulse of the body's constraints in the last substep, 0 in the first: linear and angular. Other solvers than
 * soft-step gather none, and theirs is a 0 from memory, because adding it turns -0 into +0 on every compiler alike. */
typedef struct {
  vec3 linear, angular;
} warm_start_impulses;

SHARED warm_start_impulses take_warm_start(GLOBAL const Parameters *parameters, GLOBAL const uint *body_class,
                                           GLOBAL float4 *warm_start_impulse, uint begins, item_index i)
{
  real zero = (real)parameters->zero;
  warm_start_impulses taken = {make_vec3(zero, zero, zero), make_vec3(zero, zero, zero)};
  if (HAS_FEATURE(parameters, SUBSTEP_WARM_START)) {
    vec4 none = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
    if (begins == 0u) {
      taken.linear = xyz(load_float4(warm_start_impulse, i * 2u));
      taken.angular = xyz(load_float4(warm_start_impulse, i * 2u + 1u));
    }
    if (moves_one_class(parameters)) {
      mask moved = is_moved(parameters, body_class, i);
      store_float4_if(moved, warm_start_impulse, i * 2u, none);
      store_float4_if(moved, warm_start_impulse, i * 2u + 1u, none);
    } else {
      store_float4(warm_start_impulse, i * 2u, none);
      store_float4(warm_start_impulse, i * 2u + 1u, none);
    }
  }
  return taken;
}

/* Before the first substep of a scene with articulations, because their contacts gather for it. */
SHARED void clear_warm_starts_item(GLOBAL float4 *warm_start_impulse, item_index i)
{
  vec4 none = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4(warm_start_impulse, i * 2u, none);
  store_float4(warm_start_impulse, i * 2u + 1u, none);
}

/* begins: nothing has been gathered in this step. Until then warm_start_impulse may be the memory of other buffers.
 * solver_free_power tells integrate_positions whether constraints push the body. */
SHARED void integrate_velocities_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_mass,
                                      GLOBAL const memory_real *body_damping, GLOBAL const float4 *body_gravity,
                                      GLOBAL const uint *body_lock, GLOBAL const uint *body_class,
                                      GLOBAL const float4 *solver_inertia, GLOBAL float4 *solver_velocity,
                                      GLOBAL float4 *warm_start_impulse, GLOBAL memory_real *solver_free_power,
                                      uint begins, item_index i)
{
  if (leaves_bodies(parameters, body_class, i)) return;
  spatial_velocity m = load_velocity(solver_velocity, i);
  real h = parameters->substep;
  vec3 gravity = gravity_at(parameters, body_gravity, i);
  mask moves = moved_among(parameters, body_class, m.inverse_mass > R(0.0), i);
  real pull = choose(moves, load_float4(body_mass, i).w * h, (real)R(0.0));
  m.linear = add_scaled(m.linear, gravity, pull);
  if (HAS_FEATURE(parameters, DAMPING)) {
    m.linear = scale(m.linear, R(1.0) / (R(1.0) + h * load_real(body_damping, i * 2u)));
    m.angular = scale(m.angular, R(1.0) / (R(1.0) + h * load_real(body_damping, i * 2u + 1u)));
  }
  if (HAS_FEATURE(parameters, LOCKS)) /* forces may have pushed as well */
    m.linear = without_locked_axes(m.linear, linear_locks(load_uint(body_lock, i)));
  real free_power = dot3(gravity, m.linear);
  warm_start_impulses taken = take_warm_start(parameters, body_class, warm_start_impulse, begins, i);
  m.linear = add_scaled(m.linear, taken.linear, m.inverse_mass);
  if (HAS_FEATURE(parameters, LOCKS)) m.linear = without_locked_axes(m.linear, linear_locks(load_uint(body_lock, i)));
  m.angular = add(m.angular, symmetric_times(load_inertia(parameters, solver_inertia, i, m), taken.angular));
  store_velocity_if(moves, solver_velocity, i, m);
  if (moves_one_class(parameters))
    free_power = choose(is_moved(parameters, body_class, i), free_power, load_real(solver_free_power, i));
  store_real(solver_free_power, i, free_power);
}

#endif
