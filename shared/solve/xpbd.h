/* xpbd.h - extended position-based dynamics: each substep corrects positions, then velocities.
 *
 * The method is that of Mueller, Macklin, Chentanez, Jeschke and Kim, "Detailed Rigid Body Simulation with Extended
 * Position Based Dynamics", SCA 2020; Macklin and Mueller, "XPBD", MIG 2016; Macklin and others, "Small Steps in
 * Physics Simulation", 2019.
 *
 *   predict        v += h g                    x + h v is the predicted position
 *   positions      C = s + h J v, for each penetrating point dlambda = -C / (w + alpha), friction within its cone
 *   move           x += h v
 *   velocities     points with an impulse must not part, except by bouncing; friction removes the rest of the sliding
 *
 * The change of position in the substep is stored as h v and corrected there. The paper's v = (x - x before) / h then
 * holds to the last bit without a difference of positions, which would lose digits far from the origin. A correction
 * lambda of the paper is h times an impulse, and the impulses (N s) are stored. Contacts are rigid (alpha = 0), and the
 * paper's multipliers start at 0 in each substep, so there is no warm start. The paper omits static friction as soon as
 * it would leave the cone; here it is projected onto the cone, so that the velocity pass only has the remainder to do.
 * The paper undoes the sliding of one substep; here earlier slip is remembered as long as friction holds, also from
 * step to step. Otherwise the little that each iteration leaves would add up: a box would creep, a pyramid would
 * spread. Constraints of one colour share no moving body.
 */
#ifndef TANDEM_SHARED_SOLVE_XPBD_H
#define TANDEM_SHARED_SOLVE_XPBD_H

#include "shared/solve/contact_friction.h"
#include "shared/solve/restitution.h"

/* The slip at the centre since friction last held: a vector (m) and a twist about the normal (rad), as the speeds that
 * would undo it within a substep. */
typedef struct {
  vec3 slide;
  real twist;
} slipped;

SHARED slipped slip_since(vec4 before, contact c, delta_pose moved, vec3 arm_a, vec3 arm_b, real rate)
{
  vec3 turned_by = subtract(cross3(moved.rotation_b, arm_b), cross3(moved.rotation_a, arm_a));
  slipped s = {scale(add(add(xyz(before), moved.translation), turned_by), rate),
               (before.w + dot3(c.normal, subtract(moved.rotation_b, moved.rotation_a))) * rate};
  return s;
}

SHARED real limit_of(contact c, vec4 normal_impulses) { return c.friction * sum_of_points(normal_impulses); }

/* Loads the slip that the same pair still had to undo in the last step. */
SHARED void xpbd_prepare_item(GLOBAL const uint *constraint_pair, GLOBAL const uint *pair_cached,
                              GLOBAL const uint *cached_color, GLOBAL const float4 *cached_slip,
                              GLOBAL const float4 *constraint_normal, GLOBAL float4 *constraint_slip, item_index i)
{
  uint_lanes cached = load_uint(pair_cached, load_uint(constraint_pair, i));
  mask is_cached = cached != (uint_lanes)INDEX_NONE;
  uint_lanes from = choose(is_cached, cached, (uint_lanes)0u);
  mask touched = is_cached & (load_uint(cached_color, from) != (uint_lanes)COLOR_INACTIVE);
  vec4 slip = load_float4(cached_slip, from);
  vec3 normal = xyz(load_float4(constraint_normal, i)), along = add_scaled(xyz(slip), normal, -dot3(xyz(slip), normal));
  vec4 none = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4(constraint_slip, i, choose4(touched, extend(along, slip.w), none));
}

/* Solves the points of a manifold together, each by the error of its position. */
SHARED contact xpbd_press(GLOBAL const Parameters *parameters, contact c, normal_rows *s, delta_pose moved,
                          GLOBAL const memory_real *constraint_points, point_planes planes, item_index i)
{
  real closed = dot3(c.normal, moved.translation), target_impulse[4];
  for (uint k = 0; k < 4u; ++k) {
    real separation = load_separation(constraint_points, planes, k, i) + closed +
                      (dot3(s->r_cross_n_b[k], moved.rotation_b) - dot3(s->r_cross_n_a[k], moved.rotation_a));
    real wanted = maximum(separation * parameters->inverse_substep, -parameters->push_speed);
    real speed = speed_along(c, c.normal, s->r_cross_n_a[k], s->r_cross_n_b[k]);
    target_impulse[k] = maximum(s->impulse[k] - s->mass[k] * (wanted + speed), R(0.0));
  }
  return block_solve_normals(c, s, target_impulse);
}

/* Solves friction against the current sliding and earlier slip. friction: its impulse so far. */
SHARED solved xpbd_hold(GLOBAL const Parameters *parameters, contact c, delta_pose moved, arm_shift shift,
                        read_patches patches, vec4 slip_before, real limit, vec4 friction, item_index i)
{
  vec4 center_a = load_float4(patches.center, i), center_b = center_of_b(center_a, load_float4(patches.offset, i));
  vec3 arm_a = add(xyz(center_a), shift.a), arm_b = add(xyz(center_b), shift.b);
  slipped slip = slip_since(slip_before, c, moved, arm_a, arm_b, parameters->inverse_substep);
  mask stale = masses_are_stale(moved, shift, center_a, center_b);
  solved held = solve_twist(c, spin_between(c) + slip.twist, twist_mass_now(c, stale, center_b.w), limit, friction);
  vec3 slide = add(slide_between(held.c, arm_a, arm_b), slip.slide);
  return solve_slide(held.c, stale, slide, arm_a, arm_b, center_a.w, limit, held.impulse);
}

/* first_iteration: 1 in the first iteration of a substep, in which multipliers start at 0. */
SHARED void xpbd_positions_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                GLOBAL const float4 *constraint_slip, GLOBAL const float4 *solver_inertia,
                                GLOBAL const float4 *solver_delta_pose, GLOBAL const uint *counts,
                                write_contact_impulses contact_impulses, GLOBAL float4 *solver_velocity,
                                uint first_iteration, item_index i)
{
  point_planes planes = planes_of(counts);
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  vec4 impulses = load_float4(contact_impulses.normal, i),
       friction = load_friction(parameters, contact_impulses.friction, i);
  if (first_iteration != 0u) {
    impulses = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
    friction = make_vec4(R(0.0), R(0.0), R(0.0), friction.w);
    store_friction(parameters, contact_impulses.friction, i, friction);
  }
  delta_pose moved = load_delta_pose(solver_delta_pose, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  normal_rows s = load_normal_rows(patches.points, planes, c, load_float4(patches.offset, i), shift, impulses, i);
  c = xpbd_press(parameters, c, &s, moved, patches.points, planes, i);
  vec4 normal_impulses = impulses_of(&s);
  store_float4(contact_impulses.normal, i, normal_impulses);
  keep_highest_impulses(parameters, contact_impulses.restitution, planes.stride, normal_impulses, i);
  mask rough = c.friction > R(0.0);
  if (HAS_FEATURE(parameters, FRICTION) && any_of(rough)) {
    solved held = xpbd_hold(parameters, c, moved, shift, patches, load_float4(constraint_slip, i),
                            limit_of(c, normal_impulses), friction, i);
    c = with_velocities_if(rough, c, held.c);
    store_float4_if(rough, contact_impulses.friction, i, held.impulse);
  }
  store_contact_velocities(solver_velocity, c);
}

/* Removes the speed with which positions were separated, by at most the whole impulse that caused it, and the sliding
 * that the normal impulses of the whole substep still hold. */
SHARED void xpbd_velocities_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                 GLOBAL const float4 *solver_inertia, GLOBAL const float4 *solver_delta_pose,
                                 GLOBAL const uint *counts, GLOBAL float4 *constraint_normal_impulse,
                                 GLOBAL float4 *constraint_friction_impulse, GLOBAL float4 *solver_velocity,
                                 item_index i)
{
  point_planes planes = planes_of(counts);
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  vec4 impulses = load_float4(constraint_normal_impulse, i);
  mask pressing = (impulses.x > R(0.0)) | (impulses.y > R(0.0)) | (impulses.z > R(0.0)) | (impulses.w > R(0.0));
  if (!any_of(pressing)) return;
  contact before = c;
  delta_pose moved = load_delta_pose(solver_delta_pose, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  normal_rows s = load_normal_rows(patches.points, planes, c, load_float4(patches.offset, i), shift, impulses, i);
  real target_impulse[4];
  for (uint k = 0; k < 4u; ++k) {
    real resting =
        maximum(s.impulse[k] - s.mass[k] * speed_along(c, c.normal, s.r_cross_n_a[k], s.r_cross_n_b[k]), R(0.0));
    target_impulse[k] = choose(s.impulse[k] > R(0.0), resting, s.impulse[k]);
  }
  c = block_solve_normals(c, &s, target_impulse);
  store_float4_if(pressing, constraint_normal_impulse, i, impulses_of(&s));
  mask rough = pressing & (c.friction > R(0.0));
  if (HAS_FEATURE(parameters, FRICTION) && any_of(rough)) {
    vec4 center_a = load_float4(patches.center, i), center_b = center_of_b(center_a, load_float4(patches.offset, i));
    vec4 sliding = load_float4(constraint_friction_impulse, i), normal_impulses = impulses_of(&s);
    mask stale = masses_are_stale(moved, shift, center_a, center_b);
    solved held = solve_friction(c, stale, shift, center_a, center_b, sliding, sum_of_points(normal_impulses));
    c = with_velocities_if(rough, c, held.c);
    store_float4_if(rough, constraint_friction_impulse, i, held.impulse);
  }
  store_contact_velocities(solver_velocity, with_velocities_if(pressing, before, c));
}

/* Friction at its limit holds nothing, so earlier slip is then forgotten. Contacts without a normal impulse hold
 * nothing either. */
#define XPBD_HOLDS R(0.999)

SHARED void xpbd_cache_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_pair,
                            read_contacts contacts, read_patches patches, GLOBAL const float4 *constraint_slip,
                            GLOBAL const float4 *constraint_normal_impulse,
                            GLOBAL const float4 *constraint_friction_impulse, read_solver_bodies solver_bodies,
                            GLOBAL float4 *cached_slip, item_index i)
{
  contact c = load_contact(parameters, contacts, solver_bodies.velocity, solver_bodies.inertia, i);
  delta_pose moved = load_delta_pose(solver_bodies.delta, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  vec4 center_a = load_float4(patches.center, i), center_b = center_of_b(center_a, load_float4(patches.offset, i));
  slipped slip = slip_since(load_float4(constraint_slip, i), c, moved, add(xyz(center_a), shift.a),
                            add(xyz(center_b), shift.b), R(1.0));
  vec4 normal_impulses = load_float4(constraint_normal_impulse, i),
       friction = load_float4(constraint_friction_impulse, i);
  real limit =
      XPBD_HOLDS * c.friction * ((normal_impulses.x + normal_impulses.y) + (normal_impulses.z + normal_impulses.w));
  mask slides = friction.x * friction.x + friction.y * friction.y >= limit * limit;
  mask twists = magnitude(friction.z) >= limit * friction.w;
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  store_float4(cached_slip, load_uint(constraint_pair, i),
               extend(choose3(slides, none, slip.slide), choose(twists, (real)R(0.0), slip.twist)));
}

#endif
