/* xpbd.h - extended position-based dynamics: each substep corrects positions, then velocities.
 *
 * Mueller, Macklin, Chentanez, Jeschke and Kim, "Detailed Rigid Body Simulation with Extended Position Based Dynamics",
 * SCA 2020; Macklin and Mueller, "XPBD", MIG 2016; Macklin and others, "Small Steps in Physics Simulation", 2019.
 *
 *   predict        v += h g                    x + h v is where the body would be
 *   positions      C = s + h J v, for each penetrating point dlambda = -C / (w + alpha), friction within its cone
 *   move           x += h v
 *   velocities     no point that was pressed parts, but by bouncing; friction takes what is left of sliding
 *
 * The substep's change of position is held as h v and corrected there: the paper's v = (x - x before) / h then holds to the
 * last bit without ever taking a difference of positions, which costs digits far from the origin. A correction lambda of
 * the paper is h times an impulse, and impulses (N s) are what is stored. Contacts are rigid (alpha = 0), and the paper's
 * multipliers start at 0 in each substep: there is no warm start. Where the paper leaves static friction out as soon as it
 * would leave the cone, it is projected on the cone, so that the velocity pass has only the remainder to do.
 * Constraints of one colour share no moving body.
 */
#ifndef TANDEM_SHARED_SOLVE_XPBD_H
#define TANDEM_SHARED_SOLVE_XPBD_H

#include "shared/solve/contact.h"

/* Friction at the centre, after the points: the multipliers start at 0, so the pressure must be known first. */
SHARED contact xpbd_friction(GLOBAL const Parameters *parameters, GLOBAL const row *constraint_center, uint stride, contact c, arm_shift shift,
                             vec4 normal_impulses, vec4 old, GLOBAL row *constraint_friction_impulse, item_index i)
{
  mask rough = c.friction > R(0.0);
  if (!HAS_FEATURE(parameters, FEATURE_FRICTION) || !any_of(rough)) return c;
  real pressure = (normal_impulses.x + normal_impulses.y) + (normal_impulses.z + normal_impulses.w);
  solved sliding = solve_friction(c, shift, load_row(constraint_center, i), load_row(constraint_center, stride + i), old, pressure);
  store_row_if(rough, constraint_friction_impulse, i, sliding.impulse);
  return with_motion_if(rough, c, sliding.c);
}

SHARED vec4 impulses_of(support s) { return make_vec4(s.impulse[0], s.impulse[1], s.impulse[2], s.impulse[3]); }

/* first_iteration: 1 in the first iteration of a substep, where multipliers start at 0. */
SHARED void xpbd_positions_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                GLOBAL const row *constraint_normal, GLOBAL const row *constraint_points, GLOBAL const row *constraint_center,
                                GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta, GLOBAL const uint *counts,
                                GLOBAL row *constraint_normal_impulse, GLOBAL row *constraint_friction_impulse,
                                GLOBAL row *constraint_bounce, GLOBAL row *solver_velocity, uint first_iteration, item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  contact c = load_contact(constraint_a, constraint_b, constraint_normal, solver_velocity, solver_inertia, i);
  vec4 impulses = load_row(constraint_normal_impulse, i), friction = load_row(constraint_friction_impulse, i);
  if (first_iteration != 0u) {
    impulses = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
    friction = make_vec4(R(0.0), R(0.0), R(0.0), friction.w);
    store_row(constraint_friction_impulse, i, friction);
  }
  drift moved = load_drift(solver_delta, c);
  arm_shift shift = shift_of_arms(c, moved.translation);
  support s = load_support(constraint_points, stride, c, shift, impulses, i);
  real closed = inner(c.normal, moved.translation);
  real wished[4];
  for (uint k = 0; k < 4u; ++k) {
    real separation = load_row(constraint_points, stride * k + i).w + closed +
                      (inner(s.turn_b[k], moved.rotation_b) - inner(s.turn_a[k], moved.rotation_a));
    real wanted = maximum(separation * parameters->inverse_substep, -parameters->push_speed);
    wished[k] = maximum(s.impulse[k] - s.mass[k] * (wanted + speed_along(c, c.normal, s.turn_a[k], s.turn_b[k])), R(0.0));
  }
  c = press_together(c, &s, wished);
  vec4 pressed = impulses_of(s);
  store_row(constraint_normal_impulse, i, pressed);
  if (HAS_FEATURE(parameters, FEATURE_RESTITUTION)) {
    vec4 highest = load_row(constraint_bounce, stride + i);
    store_row(constraint_bounce, stride + i, make_vec4(maximum(highest.x, pressed.x), maximum(highest.y, pressed.y), maximum(highest.z, pressed.z),
                                                       maximum(highest.w, pressed.w)));
  }
  c = xpbd_friction(parameters, constraint_center, stride, c, shift, pressed, friction, constraint_friction_impulse, i);
  store_contact_motion(solver_velocity, c);
}

/* Takes out the speed with which positions were pushed apart, at most all of the impulse that did it, and what sliding the
 * pressure of the whole substep still holds. */
SHARED void xpbd_velocities_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                 GLOBAL const row *constraint_normal, GLOBAL const row *constraint_points, GLOBAL const row *constraint_center,
                                 GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta, GLOBAL const uint *counts,
                                 GLOBAL row *constraint_normal_impulse, GLOBAL row *constraint_friction_impulse, GLOBAL row *solver_velocity,
                                 item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  contact c = load_contact(constraint_a, constraint_b, constraint_normal, solver_velocity, solver_inertia, i);
  vec4 impulses = load_row(constraint_normal_impulse, i);
  mask pressing = (impulses.x > R(0.0)) | (impulses.y > R(0.0)) | (impulses.z > R(0.0)) | (impulses.w > R(0.0));
  if (!any_of(pressing)) return;
  contact before = c;
  drift moved = load_drift(solver_delta, c);
  arm_shift shift = shift_of_arms(c, moved.translation);
  support s = load_support(constraint_points, stride, c, shift, impulses, i);
  real wished[4];
  for (uint k = 0; k < 4u; ++k) {
    real resting = maximum(s.impulse[k] - s.mass[k] * speed_along(c, c.normal, s.turn_a[k], s.turn_b[k]), R(0.0));
    wished[k] = choose(s.impulse[k] > R(0.0), resting, s.impulse[k]);
  }
  c = press_together(c, &s, wished);
  store_row_if(pressing, constraint_normal_impulse, i, impulses_of(s));
  c = xpbd_friction(parameters, constraint_center, stride, c, shift, impulses_of(s), load_row(constraint_friction_impulse, i),
                    constraint_friction_impulse, i);
  store_contact_motion(solver_velocity, with_motion_if(pressing, before, c));
}

#endif
