/* avbd.h - augmented vertex block descent: constraints as penalties with multipliers, and their update.
 *
 * The method is that of Giles, Diaz and Yuksel, "Augmented Vertex Block Descent", SIGGRAPH 2025. Bodies minimise the
 * energy of an implicit step,
 *
 *   1/2 (w - v*)^T M (w - v*)  +  penalties     w: velocities over the substep, v*: those of inertia and gravity alone
 *
 * one body at a time with all others fixed (avbd_bodies.h). Then every constraint adds the force of its penalty to its
 * multiplier, and its penalty grows with its violation:
 *
 *   impulse    p = clamp(lambda - kappa c)      lambda <- p,   kappa <- kappa + beta m |c|  unless p was clamped
 *
 * All quantities are in velocities: c = h J w + s over h (m/s), kappa = h^2 times the paper's stiffness (kg), p = h
 * times its force (N s). kappa therefore compares with the effective mass m of its row and needs no unit of its own.
 * The change of position is h w by construction. A share of 1 - alpha of a penetration s < 0 is corrected in a step, as
 * in the paper; speculative points keep their whole distance. A penalty far above the mass that it moves locks two
 * bodies to each other's current velocity, so in an impact they would not share their momentum within the iterations of
 * a step. A penalty therefore grows freely to a few masses only and then by a factor, which takes some steps for a
 * lasting load of 1,000 masses and does not affect impacts. Normal rows act at the points, and friction (a circular
 * cone of two tangents, and a twist) at the centre of the manifold. The stiffness of a clamped row is the force that it
 * still bears over its violation.
 */
#ifndef TANDEM_SHARED_SOLVE_AVBD_H
#define TANDEM_SHARED_SOLVE_AVBD_H

#include "shared/solve/avbd_penalties.h"
#include "shared/solve/restitution.h"

/* Impulses and violations of one constraint at the present velocities. */
typedef struct {
  vec3 r_cross_n_a[4], r_cross_n_b[4];
  real impulse[4], violation[4];
  tangents along;
  vec3 arm_a, arm_b;
  real first, second, twist;     /* N s and N m s: friction */
  real slide_share, twist_share; /* 1 where friction holds, less where it was clamped */
  real slide_speed, twist_speed;
} contact_forces;

/* The violation of point k as a speed, from its penetration and approach; the constraint requires it to be 0 or
 * more. */
SHARED real point_violation(GLOBAL const Parameters *parameters, real separation, real speed)
{
  real recovered = maximum((R(1.0) - AVBD_ALPHA) * separation * parameters->inverse_substep, -parameters->push_speed);
  return choose(separation > R(0.0), separation * parameters->inverse_substep, recovered) + speed;
}

SHARED void friction_forces(contact_forces *f, contact c, arm_shift shift, vec4 center_a, vec4 center_b, vec4 penalty,
                            vec4 old, real normal_impulse_sum)
{
  real limit = c.friction * normal_impulse_sum, twist_limit = limit * old.w;
  f->along = tangents_of(c.normal);
  f->arm_a = add(xyz(center_a), shift.a);
  f->arm_b = add(xyz(center_b), shift.b);
  vec3 slide = subtract(velocity_at(c.velocity_b, f->arm_b), velocity_at(c.velocity_a, f->arm_a));
  real slide_first = dot3(slide, f->along.first), slide_second = dot3(slide, f->along.second);
  real first = old.x - penalty.x * slide_first, second = old.y - penalty.x * slide_second;
  f->slide_speed = square_root(slide_first * slide_first + slide_second * slide_second);
  f->slide_share = share_within(square_root(first * first + second * second), limit);
  f->first = first * f->slide_share;
  f->second = second * f->slide_share;
  f->twist_speed = dot3(c.normal, subtract(c.velocity_b.angular, c.velocity_a.angular));
  real twist = old.z - penalty.y * f->twist_speed;
  f->twist_share = share_within(magnitude(twist), twist_limit);
  f->twist = twist * f->twist_share;
}

/* The second row of `penalty` holds the penalties of sliding and of twisting. */
SHARED contact_forces forces_of(GLOBAL const Parameters *parameters, read_patches patches,
                                GLOBAL const float4 *constraint_normal_impulse,
                                GLOBAL const float4 *constraint_friction_impulse,
                                GLOBAL const float4 *constraint_penalty, GLOBAL const float4 *solver_delta_pose,
                                point_planes planes, contact c, item_index i)
{
  contact_forces f;
  vec4 old = load_float4(constraint_normal_impulse, i), penalty = load_float4(constraint_penalty, i * 2u);
  delta_pose moved = load_delta_pose(solver_delta_pose, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  real closed = dot3(c.normal, moved.translation);
  vec4 offset = load_float4(patches.offset, i), center = load_float4(patches.center, i);
  for (uint k = 0; k < 4u; ++k) {
    vec3 arm_a = load_arm_of_a(patches.points, planes, k, i), arm_b = subtract(arm_a, xyz(offset));
    f.r_cross_n_a[k] = cross3(add(arm_a, shift.a), c.normal);
    f.r_cross_n_b[k] = cross3(add(arm_b, shift.b), c.normal);
    real separation = load_separation(patches.points, planes, k, i) + closed +
                      (dot3(f.r_cross_n_b[k], moved.rotation_b) - dot3(f.r_cross_n_a[k], moved.rotation_a));
    f.violation[k] =
        point_violation(parameters, separation, speed_along(c, c.normal, f.r_cross_n_a[k], f.r_cross_n_b[k]));
    /* The penalty of an unused point is 0, and so is its multiplier. */
    f.impulse[k] = maximum(component(old, (uint_lanes)k) - component(penalty, (uint_lanes)k) * f.violation[k], R(0.0));
  }
  friction_forces(&f, c, shift, center, center_of_b(center, offset), load_float4(constraint_penalty, i * 2u + 1u),
                  load_friction(parameters, constraint_friction_impulse, i),
                  (f.impulse[0] + f.impulse[1]) + (f.impulse[2] + f.impulse[3]));
  return f;
}

/* A body with constraints starts from its position without gravity, because most such bodies rest on another one. */
SHARED void avbd_begin_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_mass, read_body_lists lists,
                            GLOBAL float4 *solver_velocity, GLOBAL float4 *avbd_target, item_index i)
{
  spatial_velocity m = load_velocity(solver_velocity, i);
  store_velocity(avbd_target, i, m);
  mask touched = load_uint(lists.start, i) != load_uint(lists.start, i + 1u);
  if (HAS_FEATURE(parameters, JOINTS))
    touched = touched | (load_uint(lists.joint_start, i) != load_uint(lists.joint_start, i + 1u));
  touched = touched & (m.inverse_mass > R(0.0));
  vec3 gravity = gravity_of(parameters);
  m.linear = add_scaled(m.linear, gravity, -(load_float4(body_mass, i).w * parameters->substep));
  store_velocity_if(touched, solver_velocity, i, m);
}

/* The penalties of the same features in the last step; a pair that did not touch then has none. */
SHARED void avbd_prepare_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_pair,
                              GLOBAL const uint *pair_cached, GLOBAL const uint *manifold_feature,
                              GLOBAL const uint *cached_color, GLOBAL const uint *cached_feature,
                              GLOBAL const float4 *cached_penalty, read_patches patches, GLOBAL const uint *counts,
                              write_duals duals, item_index i)
{
  point_planes planes = planes_of(counts);
  uint_lanes pair = load_uint(constraint_pair, i), cached = load_uint(pair_cached, pair), feature = 0u,
             old_feature = 0u;
  mask is_cached = cached != (uint_lanes)INDEX_NONE;
  uint_lanes from = choose(is_cached, cached, (uint_lanes)0u);
  is_cached = is_cached & (load_uint(cached_color, from) != (uint_lanes)COLOR_INACTIVE);
  if (planes.points > 1u) {
    feature = load_uint(manifold_feature, pair);
    old_feature = load_uint(cached_feature, from);
  }
  vec4 old = load_float4(cached_penalty, from * 2u), old_friction = load_float4(cached_penalty, from * 2u + 1u);
  real penalty[4];
  for (uint k = 0; k < 4u; ++k)
    penalty[k] =
        kept_penalty(load_point_mass(patches.points, planes, k, i),
                     choose(is_cached, cached_impulse(feature, k, old_feature, old), (real)R(0.0)), AVBD_GAMMA);
  store_float4(duals.penalty, i * 2u, make_vec4(penalty[0], penalty[1], penalty[2], penalty[3]));
  store_float4(
      duals.penalty, i * 2u + 1u,
      make_vec4(
          kept_penalty(load_float4(patches.center, i).w, choose(is_cached, old_friction.x, (real)R(0.0)), AVBD_GAMMA),
          kept_penalty(load_float4(patches.offset, i).w, choose(is_cached, old_friction.y, (real)R(0.0)), AVBD_GAMMA),
          R(0.0), R(0.0)));
  real kept = AVBD_ALPHA * AVBD_GAMMA;
  vec4 impulse = load_float4(duals.normal, i), friction = load_friction(parameters, duals.friction, i);
  store_float4(duals.normal, i, make_vec4(kept * impulse.x, kept * impulse.y, kept * impulse.z, kept * impulse.w));
  store_friction(parameters, duals.friction, i,
                 make_vec4(kept * friction.x, kept * friction.y, kept * friction.z, friction.w));
}

SHARED void avbd_duals_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                            GLOBAL const float4 *solver_inertia, GLOBAL const float4 *solver_delta_pose,
                            GLOBAL const float4 *solver_velocity, GLOBAL const uint *counts, write_duals duals,
                            GLOBAL float4 *constraint_restitution, item_index i)
{
  point_planes planes = planes_of(counts);
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  contact_forces f =
      forces_of(parameters, patches, duals.normal, duals.friction, duals.penalty, solver_delta_pose, planes, c, i);
  vec4 penalty = load_float4(duals.penalty, i * 2u), friction_penalty = load_float4(duals.penalty, i * 2u + 1u);
  real grown[4];
  for (uint k = 0; k < 4u; ++k)
    grown[k] = grown_penalty(component(penalty, (uint_lanes)k), load_point_mass(patches.points, planes, k, i),
                             f.violation[k], f.impulse[k] > R(0.0));
  store_float4(duals.penalty, i * 2u, make_vec4(grown[0], grown[1], grown[2], grown[3]));
  store_float4(
      duals.penalty, i * 2u + 1u,
      make_vec4(
          grown_penalty(friction_penalty.x, load_float4(patches.center, i).w, f.slide_speed, f.slide_share == R(1.0)),
          grown_penalty(friction_penalty.y, load_float4(patches.offset, i).w, f.twist_speed, f.twist_share == R(1.0)),
          R(0.0), R(0.0)));
  vec4 normal_impulses = make_vec4(f.impulse[0], f.impulse[1], f.impulse[2], f.impulse[3]);
  store_float4(duals.normal, i, normal_impulses);
  store_friction(parameters, duals.friction, i,
                 make_vec4(f.first, f.second, f.twist, load_friction(parameters, duals.friction, i).w));
  keep_highest_impulses(parameters, constraint_restitution, planes.stride, normal_impulses, i);
}

SHARED void avbd_cache_item(GLOBAL const uint *constraint_pair, GLOBAL const float4 *constraint_penalty,
                            GLOBAL float4 *cached_penalty, item_index i)
{
  uint_lanes pair = load_uint(constraint_pair, i);
  store_float4(cached_penalty, pair * 2u, load_float4(constraint_penalty, i * 2u));
  store_float4(cached_penalty, pair * 2u + 1u, load_float4(constraint_penalty, i * 2u + 1u));
}

#endif
