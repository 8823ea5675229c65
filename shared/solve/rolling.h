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
 * The torque is warm started: it is what holds a ball on a slope, and built up anew each step it would let the ball
 * creep. Each solver calls this after its own rows.
 */
#ifndef TANDEM_SHARED_SOLVE_ROLLING_H
#define TANDEM_SHARED_SOLVE_ROLLING_H

#include "shared/setup/rolling.h"
#include "shared/solve/contact.h"

SHARED mask resists(vec4 resistance) { return (resistance.x > R(0.0)) | (resistance.y > R(0.0)); }

SHARED void warm_start_rolling_item(read_contacts contacts, GLOBAL const row *constraint_rolling,
                                    GLOBAL const row *solver_inertia, GLOBAL const uint *counts,
                                    GLOBAL row *solver_velocity, item_index i)
{
  mask wanted = resists(load_row(constraint_rolling, counts[CAPACITY_PAIRS] + i));
  if (!any_of(wanted)) return;
  contact c = load_contact(contacts, solver_velocity, solver_inertia, i);
  vec3 torque = xyz(load_row(constraint_rolling, i));
  store_contact_motion(solver_velocity, with_motion_if(wanted, c, apply_turn(c, torque, torque, R(1.0))));
}

/* 1 / largest eigenvalue of the inverse inertia within the tangent plane, so that a disc can be projected as a circle.
 * From where the bodies are now: they turn within the step. */
SHARED real rolling_mass(contact c)
{
  tangents t = tangents_of(c.normal);
  vec3 first = add(symmetric_times(c.inertia_a, t.first), symmetric_times(c.inertia_b, t.first));
  vec3 second = add(symmetric_times(c.inertia_a, t.second), symmetric_times(c.inertia_b, t.second));
  real along_first = inner(t.first, first), along_second = inner(t.second, second), mixed = inner(t.second, first);
  real difference = along_first - along_second;
  return inverse_or_zero(R(0.5) *
                         (along_first + along_second + square_root(difference * difference + R(4.0) * mixed * mixed)));
}

SHARED real spinning_mass(contact c)
{
  return inverse_or_zero(
      inner(c.normal, add(symmetric_times(c.inertia_a, c.normal), symmetric_times(c.inertia_b, c.normal))));
}

/* The longest part of v that is no longer than limit. */
SHARED vec3 onto_disc(vec3 v, real limit)
{
  real squared = length_squared(v);
  mask outside = squared > limit * limit;
  return scale(v, choose(outside, limit / square_root(choose(outside, squared, (real)R(1.0))), (real)R(1.0)));
}

SHARED void solve_rolling_item(read_contacts contacts, GLOBAL const row *constraint_normal_impulse,
                               GLOBAL const row *solver_inertia, GLOBAL const uint *counts,
                               GLOBAL row *constraint_rolling, GLOBAL row *solver_velocity, item_index i)
{
  vec4 resistance = load_row(constraint_rolling, counts[CAPACITY_PAIRS] + i);
  mask wanted = resists(resistance);
  if (!any_of(wanted)) return;
  contact c = load_contact(contacts, solver_velocity, solver_inertia, i);
  vec4 pushes = load_row(constraint_normal_impulse, i);
  real pressure = (pushes.x + pushes.y) + (pushes.z + pushes.w);
  vec3 old = xyz(load_row(constraint_rolling, i)), speed = subtract(c.motion_b.angular, c.motion_a.angular);
  real old_spin = inner(c.normal, old), spin_speed = inner(c.normal, speed), spin_limit = resistance.y * pressure;
  real spin = clamped(old_spin - spinning_mass(c) * spin_speed, -spin_limit, spin_limit);
  vec3 rolling =
      add_scaled(add_scaled(old, c.normal, -old_spin), add_scaled(speed, c.normal, -spin_speed), -rolling_mass(c));
  vec3 torque = add_scaled(onto_disc(rolling, resistance.x * pressure), c.normal, spin);
  vec3 change = subtract(torque, old);
  store_row_if(wanted, constraint_rolling, i, extend(torque, R(0.0)));
  store_contact_motion(solver_velocity, with_motion_if(wanted, c, apply_turn(c, change, change, R(1.0))));
}

#endif
