/* contact.h - a contact as the solvers load it: its two bodies, the rows of its points, and what impulses do to them.
 *
 * A contact is one manifold of up to four points. Constraints of one colour share no moving body, so a solver may
 * change and store what it loads. Arms are those of the start of the step, and follow what the bodies slide past each
 * other.
 */
#ifndef TANDEM_SHARED_SOLVE_CONTACT_H
#define TANDEM_SHARED_SOLVE_CONTACT_H

#include "shared/friction_rows.h"
#include "shared/setup/contact.h"
#include "shared/solve/pass.h"

typedef struct {
  uint_lanes a, b;
  spatial_velocity velocity_a, velocity_b;
  symmetric3 inertia_a, inertia_b;
  vec3 normal;
  real friction;
  real follows; /* 1: arms follow what the bodies slide past each other; 0: they stay as they are, of bodies that pass
                   each other fast */
  real locks_a, locks_b; /* linear, as in solver_inertia */
} contact;

SHARED contact load_contact(GLOBAL const Parameters *parameters, read_contacts contacts,
                            GLOBAL const float4 *solver_velocity, GLOBAL const float4 *solver_inertia, any_index i)
{
  contact c;
  c.a = load_uint(contacts.a, i);
  c.b = load_uint(contacts.b, i);
  c.velocity_a = load_velocity(solver_velocity, c.a);
  c.velocity_b = load_velocity(solver_velocity, c.b);
  c.inertia_a = load_inertia_and_locks(parameters, solver_inertia, c.a, c.velocity_a, &c.locks_a);
  c.inertia_b = load_inertia_and_locks(parameters, solver_inertia, c.b, c.velocity_b, &c.locks_b);
  vec4 normal = load_float4(contacts.normal, i);
  c.normal = xyz(normal);
  c.friction = friction_of(normal.w);
  c.follows = choose(normal.w < R(0.0), (real)R(0.0), (real)R(1.0));
  return c;
}

/* Bodies that cannot move are never written, because constraints of one colour share them. */
SHARED void store_contact_velocities_if(mask wanted, GLOBAL float4 *solver_velocity, contact c)
{
  store_velocity_if(wanted & (c.velocity_a.inverse_mass > R(0.0)), solver_velocity, c.a, c.velocity_a);
  store_velocity_if(wanted & (c.velocity_b.inverse_mass > R(0.0)), solver_velocity, c.b, c.velocity_b);
}
SHARED void store_contact_velocities(GLOBAL float4 *solver_velocity, contact c)
{
  store_velocity_if(c.velocity_a.inverse_mass > R(0.0), solver_velocity, c.a, c.velocity_a);
  store_velocity_if(c.velocity_b.inverse_mass > R(0.0), solver_velocity, c.b, c.velocity_b);
}

/* An impulse of 0 is not applied, because adding 0 would turn -0 into +0, and the bits would depend on what shares the
 * lanes. */
SHARED contact with_velocities_if(mask wanted, contact c, contact moved)
{
  c.velocity_a.linear = choose3(wanted, moved.velocity_a.linear, c.velocity_a.linear);
  c.velocity_a.angular = choose3(wanted, moved.velocity_a.angular, c.velocity_a.angular);
  c.velocity_b.linear = choose3(wanted, moved.velocity_b.linear, c.velocity_b.linear);
  c.velocity_b.angular = choose3(wanted, moved.velocity_b.angular, c.velocity_b.angular);
  return c;
}

SHARED contact apply_turn(contact c, vec3 r_cross_n_a, vec3 r_cross_n_b, real impulse)
{
  c.velocity_a.angular = add_scaled(c.velocity_a.angular, symmetric_times(c.inertia_a, r_cross_n_a), -impulse);
  c.velocity_b.angular = add_scaled(c.velocity_b.angular, symmetric_times(c.inertia_b, r_cross_n_b), impulse);
  return c;
}

/* Impulse along a direction through arms whose cross products with it are r_cross_n_a, r_cross_n_b. */
SHARED contact apply_impulse(contact c, vec3 direction, vec3 r_cross_n_a, vec3 r_cross_n_b, real impulse)
{
  c.velocity_a.linear = pushed(c.velocity_a.linear, c.locks_a, direction, -(c.velocity_a.inverse_mass * impulse));
  c.velocity_b.linear = pushed(c.velocity_b.linear, c.locks_b, direction, c.velocity_b.inverse_mass * impulse);
  return apply_turn(c, r_cross_n_a, r_cross_n_b, impulse);
}

SHARED real speed_along(contact c, vec3 direction, vec3 r_cross_n_a, vec3 r_cross_n_b)
{
  return dot3(direction, subtract(c.velocity_b.linear, c.velocity_a.linear)) + dot3(r_cross_n_b, c.velocity_b.angular) -
         dot3(r_cross_n_a, c.velocity_a.angular);
}

/* The motion of the bodies since the step began. */
typedef struct {
  vec3 translation, rotation_a, rotation_b;
} delta_pose;

SHARED delta_pose load_delta_pose(GLOBAL const float4 *solver_delta_pose, contact c)
{
  delta_pose d = {
      subtract(xyz(load_float4(solver_delta_pose, c.b * 2u)), xyz(load_float4(solver_delta_pose, c.a * 2u))),
      xyz(load_float4(solver_delta_pose, c.a * 2u + 1u)), xyz(load_float4(solver_delta_pose, c.b * 2u + 1u))};
  return d;
}

SHARED arm_shift shift_of_contact(contact c, vec3 slid)
{
  return shift_of_arms(c.velocity_a, c.velocity_b, scale(slid, c.follows));
}

SHARED arm_shift load_arm_shift(GLOBAL const float4 *solver_delta_pose, contact c)
{
  return shift_of_contact(
      c, subtract(xyz(load_float4(solver_delta_pose, c.b * 2u)), xyz(load_float4(solver_delta_pose, c.a * 2u))));
}

/* The normal rows of the four points of a manifold: angular Jacobians, masses and impulses. */
typedef struct {
  vec3 r_cross_n_a[4], r_cross_n_b[4];
  real mass[4], impulse[4];
} normal_rows;

/* Loads the Jacobians, masses and impulses of the points. The caller keeps their separations at the start of the step.
 * offset: of constraint_offset. */
SHARED normal_rows load_normal_rows(GLOBAL const memory_real *constraint_points, point_planes planes, contact c,
                                    vec4 offset, arm_shift shift, vec4 impulses, item_index i)
{
  normal_rows s;
  for (uint k = 0; k < 4u; ++k) {
    vec3 arm_a = load_arm_of_a(constraint_points, planes, k, i), arm_b = subtract(arm_a, xyz(offset));
    s.r_cross_n_a[k] = cross3(add(arm_a, shift.a), c.normal);
    s.r_cross_n_b[k] = cross3(add(arm_b, shift.b), c.normal);
    s.mass[k] = load_point_mass(constraint_points, planes, k, i);
    s.impulse[k] = component(impulses, (uint_lanes)k);
  }
  return s;
}

/* The arm of b to the centre of the friction patch, and the effective mass of twisting. center_a: the arm of a. */
SHARED vec4 center_of_b(vec4 center_a, vec4 offset) { return extend(subtract(xyz(center_a), xyz(offset)), offset.w); }

/* The sum of a manifold's impulses: one linear impulse, and the angular impulses on the two bodies. */
typedef struct {
  vec3 impulse, angular_impulse_a, angular_impulse_b;
} wrench;

/* friction: along the two tangents at the centre, and about the normal. */
SHARED wrench wrench_of(contact c, normal_rows s, vec3 center_a, vec3 center_b, vec4 friction)
{
  tangents t = tangents_of(c.normal);
  vec3 slide = add(scale(t.first, friction.x), scale(t.second, friction.y));
  wrench w = {slide, add(cross3(center_a, slide), scale(c.normal, friction.z)),
              add(cross3(center_b, slide), scale(c.normal, friction.z))};
  for (uint k = 0; k < 4u; ++k) {
    w.impulse = add_scaled(w.impulse, c.normal, s.impulse[k]);
    w.angular_impulse_a = add_scaled(w.angular_impulse_a, s.r_cross_n_a[k], s.impulse[k]);
    w.angular_impulse_b = add_scaled(w.angular_impulse_b, s.r_cross_n_b[k], s.impulse[k]);
  }
  return w;
}

/* The bodies of a contact in the form that setup uses. The offset is not valid, because no mass depends on it. */
SHARED body_pair bodies_of(contact c)
{
  body_pair bodies = {c.a, c.b, c.velocity_a, c.velocity_b, c.inertia_a, c.inertia_b, c.normal, c.locks_a, c.locks_b};
  return bodies;
}

/* Applies changed impulses of a manifold's rows together, so that momentum is rounded once. */
SHARED contact apply_changes(contact c, const normal_rows *s, vec4 changes)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0)), r_cross_n_a = none, r_cross_n_b = none;
  for (uint k = 0; k < 4u; ++k) {
    real change = component(changes, (uint_lanes)k);
    r_cross_n_a = add_scaled(r_cross_n_a, s->r_cross_n_a[k], change);
    r_cross_n_b = add_scaled(r_cross_n_b, s->r_cross_n_b[k], change);
  }
  real sum = (changes.x + changes.y) + (changes.z + changes.w);
  c.velocity_a.linear = pushed(c.velocity_a.linear, c.locks_a, c.normal, -(c.velocity_a.inverse_mass * sum));
  c.velocity_b.linear = pushed(c.velocity_b.linear, c.locks_b, c.normal, c.velocity_b.inverse_mass * sum);
  return apply_turn(c, r_cross_n_a, r_cross_n_b, R(1.0));
}

#endif
