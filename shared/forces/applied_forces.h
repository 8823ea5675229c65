/* applied_forces.h - forces and torques that a program applies to bodies for one step.
 *
 *   body_force  --begin_forces-->  solver_force  --modules add-->  apply_forces  -->  solver_velocity
 *
 * body_force holds what the calls between two steps have added up (shared/commands/apply_commands.h). It acts in every
 * substep and is cleared when the step is committed, so a step that runs again uses the same forces. Modules that
 * launch at StepPoint::forces add to solver_force in each substep. This is the box "apply forces" before "integrate" in
 * the figures of the 2009 and 2013 talks. A scene without forces has none of these kernels and buffers.
 *
 * A constant force gives the parabola of its closed form, as gravity does (integrate/positions.h): the symplectic Euler
 * step moves a body that no constraint touches half a substep's acceleration too far, and follow_forces takes that
 * back.
 */
#ifndef TANDEM_SHARED_FORCES_APPLIED_FORCES_H
#define TANDEM_SHARED_FORCES_APPLIED_FORCES_H

#include "shared/integrate/positions.h"
#include "shared/substep_classes.h"

SHARED void begin_forces_item(GLOBAL const float4 *body_force, GLOBAL float4 *solver_force, item_index i)
{
  store_float4(solver_force, i * 2u, load_float4(body_force, i * 2u));
  store_float4(solver_force, i * 2u + 1u, load_float4(body_force, i * 2u + 1u));
}

SHARED void apply_forces_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_class,
                              GLOBAL const float4 *solver_inertia, GLOBAL const float4 *solver_force,
                              GLOBAL float4 *solver_velocity, item_index i)
{
  spatial_velocity m = load_velocity(solver_velocity, i);
  real h = parameters->substep;
  vec3 force = xyz(load_float4(solver_force, i * 2u)), torque = xyz(load_float4(solver_force, i * 2u + 1u));
  m.linear = add_scaled(m.linear, force, m.inverse_mass * h);
  m.angular = add_scaled(m.angular, symmetric_times(load_inertia(parameters, solver_inertia, i, m), torque), h);
  mask pushed = is_nonzero(force) | is_nonzero(torque); /* adding 0 would turn -0 into +0 */
  pushed = moved_among(parameters, body_class, pushed & (m.inverse_mass > R(0.0)), i);
  store_velocity_if(pushed, solver_velocity, i, m);
}

SHARED void follow_forces_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_gravity,
                               GLOBAL const uint *body_lock, GLOBAL const uint *body_falls,
                               GLOBAL const uint *body_class, GLOBAL const memory_real *solver_free_power,
                               GLOBAL const float4 *solver_velocity, GLOBAL const float4 *solver_force,
                               GLOBAL float4 *solver_delta_pose, item_index i)
{
  spatial_velocity m = load_velocity(solver_velocity, i);
  real h = parameters->substep;
  mask free = (load_uint(body_falls, i) != 0u) & (m.inverse_mass > R(0.0)) &
              is_left_alone(parameters, gravity_at(parameters, body_gravity, i), m, load_real(solver_free_power, i));
  vec3 translation = xyz(load_float4(solver_delta_pose, i * 2u));
  vec3 force = xyz(load_float4(solver_force, i * 2u));
  if (HAS_FEATURE(parameters, LOCKS)) force = without_locked_axes(force, linear_locks(load_uint(body_lock, i)));
  translation = add_scaled(translation, force, R(-0.5) * h * h * m.inverse_mass);
  store_float4_if(moved_among(parameters, body_class, free, i), solver_delta_pose, i * 2u, extend(translation, R(0.0)));
}

/* The bounds hold the displacement by the force as well. */
SHARED void extend_bounds_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_velocity,
                               GLOBAL const float4 *body_force, GLOBAL float4 *bounds, item_index i)
{
  real step = parameters->step;
  real factor = load_float4(body_velocity, i * 2u).w * step * step;
  vec3 way = scale(xyz(load_float4(body_force, i * 2u)), factor);
  vec3 lower = xyz(load_float4(bounds, i * 2u)), upper = xyz(load_float4(bounds, i * 2u + 1u));
  vec3 low = make_vec3(minimum(R(0.0), way.x), minimum(R(0.0), way.y), minimum(R(0.0), way.z)),
       high = make_vec3(maximum(R(0.0), way.x), maximum(R(0.0), way.y), maximum(R(0.0), way.z));
  store_float4(bounds, i * 2u, extend(add(lower, low), R(0.0)));
  store_float4(bounds, i * 2u + 1u, extend(add(upper, high), R(0.0)));
}

SHARED void clear_forces_item(GLOBAL float4 *body_force, item_index i)
{
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4(body_force, i * 2u, zero);
  store_float4(body_force, i * 2u + 1u, zero);
}

#endif
