/* rolling.h - the torque that resists rolling and spinning at a contact.
 *
 *            n ^  spinning: |torque about n|       <= spinning_friction x normal force
 *      ( w_b ) |  rolling:  |torque across n|      <= rolling_friction x normal force
 *     ---------+---------   (a disc, not a square: no direction rolls easier)
 *        w_a
 *
 * Both act on the relative angular velocity w_b - w_a, as one torque impulse a manifold, kept as a vector of the world.
 * A ball on a floor slows down by 5/7 rolling_friction g / radius. The coefficients are lengths in metres. Twisting
 * friction (contact.h) comes from the area between contact points and adds to it.
 *
 * The torque is warm started, because it holds a ball on a slope: a torque that began at 0 in each step would let the
 * ball creep. Each solver calls this after its own rows.
 */
#ifndef TANDEM_SHARED_SOLVE_ROLLING_H
#define TANDEM_SHARED_SOLVE_ROLLING_H

#include "shared/setup/rolling.h"
#include "shared/solve/contact.h"

SHARED mask resists(vec4 resistance) { return (resistance.x > R(0.0)) | (resistance.y > R(0.0)); }

SHARED void warm_start_rolling_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                    GLOBAL const float4 *constraint_rolling, GLOBAL const float4 *solver_inertia,
                                    GLOBAL const uint *counts, GLOBAL float4 *solver_velocity, item_index i)
{
  mask wanted = resists(load_float4(constraint_rolling, counts[CAPACITY_PAIRS] + i));
  if (!any_of(wanted)) return;
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  vec3 torque = xyz(load_float4(constraint_rolling, i));
  store_contact_velocities(solver_velocity, with_velocities_if(wanted, c, apply_turn(c, torque, torque, R(1.0))));
}

/* 1 / the largest eigenvalue of the inverse inertia within the tangent plane, so that a disc can be projected as a
 * circle. It is computed at the current poses, because bodies turn within the step. */
SHARED real rolling_mass(contact c)
{
  tangents t = tangents_of(c.normal);
  vec3 first = add(symmetric_times(c.inertia_a, t.first), symmetric_times(c.inertia_b, t.first));
  vec3 second = add(symmetric_times(c.inertia_a, t.second), symmetric_times(c.inertia_b, t.second));
  real along_first = dot3(t.first, first), along_second = dot3(t.second, second), mixed = dot3(t.second, first);
  real difference = along_first - along_second;
  return inverse_or_zero(R(0.5) *
                         (along_first + along_second + square_root(difference * difference + R(4.0) * mixed * mixed)));
}

SHARED real spinning_mass(contact c)
{
  return inverse_or_zero(
      dot3(c.normal, add(symmetric_times(c.inertia_a, c.normal), symmetric_times(c.inertia_b, c.normal))));
}

/* The vector v, shortened to `limit` if it is longer. */
SHARED vec3 onto_disc(vec3 v, real limit)
{
  real squared = length_squared(v);
  mask outside = squared > limit * limit;
  return scale(v, choose(outside, limit / square_root(choose(outside, squared, (real)R(1.0))), (real)R(1.0)));
}

SHARED void solve_rolling_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                               GLOBAL const float4 *constraint_normal_impulse, GLOBAL const float4 *solver_inertia,
                               GLOBAL const uint *counts, GLOBAL float4 *constraint_rolling,
                               GLOBAL float4 *solver_velocity, item_index i)
{
  vec4 resistance = load_float4(constraint_rolling, counts[CAPACITY_PAIRS] + i);
  mask wanted = resists(resistance);
  if (!any_of(wanted)) return;
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  vec4 normal_impulses = load_float4(constraint_normal_impulse, i);
  real normal_impulse_sum = (normal_impulses.x + normal_impulses.y) + (normal_impulses.z + normal_impulses.w);
  vec3 old = xyz(load_float4(constraint_rolling, i)), speed = subtract(c.velocity_b.angular, c.velocity_a.angular);
  real old_spin = dot3(c.normal, old), spin_speed = dot3(c.normal, speed),
       spin_limit = resistance.y * normal_impulse_sum;
  real spin = clamped(old_spin - spinning_mass(c) * spin_speed, -spin_limit, spin_limit);
  vec3 rolling =
      add_scaled(add_scaled(old, c.normal, -old_spin), add_scaled(speed, c.normal, -spin_speed), -rolling_mass(c));
  vec3 torque = add_scaled(onto_disc(rolling, resistance.x * normal_impulse_sum), c.normal, spin);
  vec3 change = subtract(torque, old);
  store_float4_if(wanted, constraint_rolling, i, extend(torque, R(0.0)));
  store_contact_velocities(solver_velocity, with_velocities_if(wanted, c, apply_turn(c, change, change, R(1.0))));
}

#endif
