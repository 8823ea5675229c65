/* positions.h - moves and turns bodies over one substep.
 *
 * Translation is accumulated apart from the position, which may be far from the origin. A body moves on the exact
 * parabola if all its constraints are out of reach within the step and none of them pushes it. Other bodies move by the
 * symplectic Euler step that the solver assumes, because on the parabola a body at rest would rise by half of what
 * gravity makes it fall in a substep.
 *
 * Rotation keeps the angular momentum L, not the angular velocity, constant. Let m be the middle one of the inverse
 * moments d. The energy of the spin is then a sum of parts, each of which alone is an exact rotation:
 *
 *     L.L m / 2                     about L; it is the same for every orientation, so it commutes with the others
 *     Lk Lk (dk - m) / 2            about the body's axis k; one of the three is 0, for a symmetric body two are
 *
 * They are composed symmetrically (McLachlan, "Explicit Lie-Poisson integration and the Euler equations", 1993;
 * Dullweber, Leimkuhler and McLachlan, "Symplectic splitting methods for rigid body molecular dynamics", 1997). L is
 * therefore exact to rounding, the energy oscillates within bounds and never drifts, and symmetric bodies are exact at
 * any speed of spin.
 */
#ifndef TANDEM_SHARED_INTEGRATE_POSITIONS_H
#define TANDEM_SHARED_INTEGRATE_POSITIONS_H

#include "shared/substep_classes.h"
#include "shared/trigonometry.h"

/* The angular velocity I(q)^-1 L, for principal inverse moments d. */
SHARED vec3 spin_of(quat q, vec3 inverse_moments, vec3 momentum)
{
  mat3 r = rotation_of(q);
  return rotate(r, multiply(inverse_moments, rotate_back(r, momentum)));
}

/* Whether the angular velocity of a body in world axes changes as the body turns. mass: of body_mass. */
SHARED mask is_uneven(spatial_velocity m, vec4 mass)
{
  return (m.inverse_mass > R(0.0)) & ((mass.x != mass.y) | (mass.y != mass.z));
}

typedef struct {
  quat orientation;
  vec3 angular;
} spin;

/* The orientation q rotated about its own axis x, y or z: the product of q with (sine, 0, 0, cosine) and so on. */
SHARED quat turned_about_x(quat q, real angle)
{
  angle_functions f = sine_cosine(R(0.5) * angle);
  return make_quat(q.x * f.cosine + q.w * f.sine, q.y * f.cosine + q.z * f.sine, q.z * f.cosine - q.y * f.sine,
                   q.w * f.cosine - q.x * f.sine);
}
SHARED quat turned_about_y(quat q, real angle)
{
  angle_functions f = sine_cosine(R(0.5) * angle);
  return make_quat(q.x * f.cosine - q.z * f.sine, q.y * f.cosine + q.w * f.sine, q.z * f.cosine + q.x * f.sine,
                   q.w * f.cosine - q.y * f.sine);
}
SHARED quat turned_about_z(quat q, real angle)
{
  angle_functions f = sine_cosine(R(0.5) * angle);
  return make_quat(q.x * f.cosine + q.y * f.sine, q.y * f.cosine - q.x * f.sine, q.z * f.cosine + q.w * f.sine,
                   q.w * f.cosine - q.z * f.sine);
}

/* The angular momentum in the body's axes. */
SHARED vec3 momentum_in_body(quat q, vec3 momentum) { return rotate_back(rotation_of(q), momentum); }

/* The orientation rotated within a time about each of the body's axes alone. Of a symmetric body one of these rotations
 * is there, and most bodies are symmetric: rates of 0 cost nothing. */
SHARED quat spun_about_x(quat q, real rate, vec3 momentum)
{
  mask spins = rate != R(0.0);
  if (!any_of(spins)) return q;
  quat spun = turned_about_x(q, rate * momentum_in_body(q, momentum).x);
  return quat_from(choose4(spins, quat_to_vec4(spun), quat_to_vec4(q)));
}
SHARED quat spun_about_y(quat q, real rate, vec3 momentum)
{
  mask spins = rate != R(0.0);
  if (!any_of(spins)) return q;
  quat spun = turned_about_y(q, rate * momentum_in_body(q, momentum).y);
  return quat_from(choose4(spins, quat_to_vec4(spun), quat_to_vec4(q)));
}
SHARED quat spun_about_z(quat q, real rate, vec3 momentum)
{
  mask spins = rate != R(0.0);
  if (!any_of(spins)) return q;
  quat spun = turned_about_z(q, rate * momentum_in_body(q, momentum).z);
  return quat_from(choose4(spins, quat_to_vec4(spun), quat_to_vec4(q)));
}

SHARED spin turn_freely(quat q, vec3 angular, vec3 inverse_moments, real h)
{
  mask finite = (inverse_moments.x > R(0.0)) & (inverse_moments.y > R(0.0)) & (inverse_moments.z > R(0.0));
  vec3 ones = make_vec3(R(1.0), R(1.0), R(1.0));
  vec3 inverse = choose3(finite, inverse_moments, ones);
  vec3 moments = make_vec3(R(1.0) / inverse.x, R(1.0) / inverse.y, R(1.0) / inverse.z);
  vec3 momentum = spin_of(q, moments, angular);
  real middle = middle_of(inverse);
  vec3 rate = scale(make_vec3(inverse.x - middle, inverse.y - middle, inverse.z - middle), h);

  quat turning = spun_about_x(q, R(0.5) * rate.x, momentum);
  turning = spun_about_y(turning, R(0.5) * rate.y, momentum);
  turning = spun_about_z(turning, rate.z, momentum);
  turning = spun_about_y(turning, R(0.5) * rate.y, momentum);
  turning = spun_about_x(turning, R(0.5) * rate.x, momentum);

  spin s;
  s.orientation = turned(turning, scale(momentum, middle * h));
  /* The spin is updated by a change, because rounding that both terms share would otherwise shrink or grow it slightly
   * in every substep. */
  s.angular = add(angular, subtract(spin_of(s.orientation, inverse, momentum), spin_of(q, inverse, momentum)));
  return s;
}

/* free_power: velocity times gravity after the forces alone (integrate_velocities). */
SHARED mask is_left_alone(GLOBAL const Parameters *parameters, vec3 gravity, spatial_velocity m, real free_power)
{
  real borne = magnitude(dot3(gravity, m.linear) - free_power);
  return borne <= WEIGHTLESS * parameters->substep * length_squared(gravity);
}

/* Since the step began. */
typedef struct {
  vec3 translation, rotation;
} motion_of_body;

SHARED void integrate_positions_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_mass,
                                     GLOBAL const float4 *body_gravity, GLOBAL const uint *body_lock,
                                     GLOBAL const uint *body_falls, GLOBAL const uint *body_class,
                                     GLOBAL const memory_real *solver_free_power, GLOBAL float4 *solver_velocity,
                                     GLOBAL float4 *solver_delta_pose, GLOBAL float4 *solver_inertia,
                                     GLOBAL float4 *solver_orientation, item_index i)
{
  if (leaves_bodies(parameters, body_class, i)) return;
  spatial_velocity m = load_velocity(solver_velocity, i);
  real h = parameters->substep;
  vec4 mass = load_float4(body_mass, i);
  vec3 gravity = gravity_at(parameters, body_gravity, i);
  mask falls = (load_uint(body_falls, i) != 0u) & (m.inverse_mass > R(0.0)) &
               is_left_alone(parameters, gravity, m, load_real(solver_free_power, i));
  real ahead = choose(falls, R(-0.5) * h * h * mass.w, (real)R(0.0));
  uint_lanes locks = HAS_FEATURE(parameters, LOCKS) ? load_uint(body_lock, i) : (uint_lanes)0u;
  if (HAS_FEATURE(parameters, LOCKS)) gravity = without_locked_axes(gravity, linear_locks(locks));

  vec3 translation = xyz(load_float4(solver_delta_pose, i * 2u)),
       rotation = xyz(load_float4(solver_delta_pose, i * 2u + 1u));
  motion_of_body way = {add_scaled(add_scaled(translation, m.linear, h), gravity, ahead),
                        add_scaled(rotation, m.angular, h)};

  quat q = quat_from(load_float4(solver_orientation, i));
  quat next = turned(q, scale(m.angular, h));
  if (HAS_FEATURE(parameters, GYROSCOPIC)) {
    /* The choice is made for each body, so that its bits do not depend on the other bodies of the scene. */
    mask uneven = moved_among(parameters, body_class, is_uneven(m, mass), i);
    /* What holds an axis takes up the torque with which the body would change its angular velocity. */
    mask turns_freely = uneven & (angular_locks(locks) == 0u);
    spin s = turn_freely(q, m.angular, xyz(mass), h);
    next = quat_from(choose4(turns_freely, quat_to_vec4(s.orientation), quat_to_vec4(next)));
    m.angular = s.angular;
    store_velocity_if(turns_freely, solver_velocity, i, m);
    store_inertia_if(uneven, solver_inertia, i, inertia_of(next, xyz(mass)));
  }
  if (moves_one_class(parameters)) {
    mask moved = is_moved(parameters, body_class, i);
    way.translation = choose3(moved, way.translation, translation);
    way.rotation = choose3(moved, way.rotation, rotation);
    next = quat_from(choose4(moved, quat_to_vec4(next), quat_to_vec4(q)));
  }
  store_float4(solver_delta_pose, i * 2u, extend(way.translation, R(0.0)));
  store_float4(solver_delta_pose, i * 2u + 1u, extend(way.rotation, R(0.0)));
  store_float4(solver_orientation, i, quat_to_vec4(next));
}

#endif
