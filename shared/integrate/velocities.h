/* velocities.h - applies gravity, damping and the warm start over one substep: the forces of the pipeline. */
#ifndef TANDEM_SHARED_INTEGRATE_VELOCITIES_H
#define TANDEM_SHARED_INTEGRATE_VELOCITIES_H

#include "shared/records.h"

/* warm_start_impulse: the impulse of the body's constraints in the last substep, 0 in the first; this kernel applies
 * and clears it. solver_free_power tells integrate_positions whether constraints push the body. */
SHARED void integrate_velocities_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_mass,
                                      GLOBAL const float4 *body_gravity, GLOBAL const uint *body_lock,
                                      GLOBAL const float4 *solver_inertia, GLOBAL float4 *solver_velocity,
                                      GLOBAL float4 *warm_start_impulse, GLOBAL memory_real *solver_free_power,
                                      item_index i)
{
  spatial_velocity m = load_velocity(solver_velocity, i);
  real h = parameters->substep;
  vec3 gravity = gravity_at(parameters, body_gravity, i);
  mask moves = m.inverse_mass > R(0.0);
  real pull = choose(moves, load_float4(body_mass, i * 2u).w * h, (real)R(0.0));
  m.linear = add_scaled(m.linear, gravity, pull);
  if (HAS_FEATURE(parameters, DAMPING)) {
    vec4 damping = load_float4(body_mass, i * 2u + 1u);
    m.linear = scale(m.linear, R(1.0) / (R(1.0) + h * damping.x));
    m.angular = scale(m.angular, R(1.0) / (R(1.0) + h * damping.y));
  }
  if (HAS_FEATURE(parameters, LOCKS)) /* forces may have pushed as well */
    m.linear = without_locked_axes(m.linear, linear_locks(load_uint(body_lock, i)));
  real free_power = dot3(gravity, m.linear);
  m.linear = add_scaled(m.linear, xyz(load_float4(warm_start_impulse, i * 2u)), m.inverse_mass);
  if (HAS_FEATURE(parameters, LOCKS)) m.linear = without_locked_axes(m.linear, linear_locks(load_uint(body_lock, i)));
  m.angular = add(m.angular,
                  symmetric_times(load_inertia(solver_inertia, i), xyz(load_float4(warm_start_impulse, i * 2u + 1u))));
  store_velocity_if(moves, solver_velocity, i, m);
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4(warm_start_impulse, i * 2u, zero);
  store_float4(warm_start_impulse, i * 2u + 1u, zero);
  store_real(solver_free_power, i, free_power);
}

#endif
