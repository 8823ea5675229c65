/* mass_split.h - contact rows that are solved at the same time, with bodies split into as many parts as they have
 * constraints.
 *
 * Colours let one constraint after the other change a body. Here every constraint works on its own parts of its bodies,
 * with mass m / n and inertia I / n if the body has n constraints. Then the n parts are joined again at their mean
 * velocity (Tonge, Benevolenski and Voroshilov, "Mass Splitting for Jitter-Free Parallel Rigid Body Simulation", 2012):
 *
 *           n = 3                    P1 acts on m/3:   v1 = v + 3 P1 / m
 *        1  2  3                     P2, P3 alike
 *        |  |  |                     mean of the parts:  v + (P1 + P2 + P3) / m
 *      [ m/3|m/3|m/3 ]
 *
 * A row therefore stores the impulse that it gave, and split_apply adds the impulses of a body in the order of its
 * list. Both bodies of a row get the same impulse, so momentum is kept to rounding in every iteration. The method never
 * overshoots, but a body of n constraints is n times as soft in each of them, so it takes more iterations than solving
 * colour after colour.
 *
 * The rows are those of shared/solve/soft_step.h, with the same fixed points. The solver `jacobi` uses them for all
 * constraints, at the same time as joints (joints/mass_split.h), the others for the overflow constraints, which have no
 * colours.
 */
#ifndef TANDEM_SHARED_SOLVE_MASS_SPLIT_H
#define TANDEM_SHARED_SOLVE_MASS_SPLIT_H

#include "shared/solve/contact_friction.h"
#include "shared/solve/restitution.h"
#include "shared/solve/parts.h"

SHARED real parts_of(GLOBAL const uint *body_constraint_start, GLOBAL const uint *split_static_constraints,
                     uint_lanes body, mask supported)
{
  uint_lanes all = load_uint(body_constraint_start, body + 1u) - load_uint(body_constraint_start, body);
  return parts_among(all, load_uint(split_static_constraints, body), supported);
}

/* Replaces the two bodies of a contact by their parts. */
SHARED contact split_contact(contact c, real parts_a, real parts_b)
{
  c.velocity_a.inverse_mass = c.velocity_a.inverse_mass * parts_a;
  c.velocity_b.inverse_mass = c.velocity_b.inverse_mass * parts_b;
  c.inertia_a = scaled_inertia(c.inertia_a, parts_a);
  c.inertia_b = scaled_inertia(c.inertia_b, parts_b);
  return c;
}

SHARED mask is_supported(contact c)
{
  return (c.velocity_a.inverse_mass == R(0.0)) | (c.velocity_b.inverse_mass == R(0.0));
}

/* The effective masses between parts, and the numbers of parts. */
SHARED void store_split_masses(contact c, read_patches patches, point_planes planes, real parts_a, real parts_b,
                               GLOBAL float4 *split_mass, item_index i)
{
  body_pair parts = bodies_of(split_contact(c, parts_a, parts_b));
  vec4 offset = load_float4(patches.offset, i), center = load_float4(patches.center, i);
  real mass[4];
  for (uint k = 0; k < 4u; ++k) {
    vec3 arm_a = load_arm_of_a(patches.points, planes, k, i);
    real whole = normal_mass(parts, arm_a, subtract(arm_a, xyz(offset)), c.normal);
    mass[k] = choose(load_point_mass(patches.points, planes, k, i) > R(0.0), whole, (real)R(0.0));
  }
  vec3 center_a = xyz(center), center_b = xyz(center_of_b(center, offset));
  store_float4(split_mass, i, make_vec4(mass[0], mass[1], mass[2], mass[3]));
  store_float4(
      split_mass, planes.stride + i,
      make_vec4(friction_mass(parts, center_a, center_b, c.normal), twist_mass(parts, c.normal), parts_a, parts_b));
}

/* Runs once a step. */
SHARED void split_masses_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                              GLOBAL const float4 *solver_velocity, GLOBAL const float4 *solver_inertia,
                              GLOBAL const uint *body_constraint_start, GLOBAL const uint *split_static_constraints,
                              GLOBAL const uint *counts, GLOBAL float4 *split_mass, item_index i)
{
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  mask supported = is_supported(c);
  real parts_a = parts_of(body_constraint_start, split_static_constraints, c.a, supported),
       parts_b = parts_of(body_constraint_start, split_static_constraints, c.b, supported);
  store_split_masses(c, patches, planes_of(counts), parts_a, parts_b, split_mass, i);
}

SHARED void split_masses_with_joints_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                          read_patches patches, GLOBAL const float4 *solver_velocity,
                                          GLOBAL const float4 *solver_inertia, read_body_lists body_lists,
                                          GLOBAL const uint *split_static_constraints, GLOBAL const uint *counts,
                                          GLOBAL float4 *split_mass_with_joints, item_index i)
{
  contact c = load_contact(parameters, contacts, solver_velocity, solver_inertia, i);
  mask supported = is_supported(c);
  real parts_a = parts_with_joints(body_lists, split_static_constraints, c.a, supported),
       parts_b = parts_with_joints(body_lists, split_static_constraints, c.b, supported);
  store_split_masses(c, patches, planes_of(counts), parts_a, parts_b, split_mass_with_joints, i);
}

SHARED wrench choose_wrench(mask m, wrench a, wrench b)
{
  wrench w = {choose3(m, a.impulse, b.impulse), choose3(m, a.angular_impulse_a, b.angular_impulse_a),
              choose3(m, a.angular_impulse_b, b.angular_impulse_b)};
  return w;
}

SHARED void store_wrench(GLOBAL float4 *split_impulse, uint stride, item_index i, wrench w)
{
  store_float4(split_impulse, i, extend(w.impulse, R(0.0)));
  store_float4(split_impulse, stride + i, extend(negate(w.angular_impulse_a), R(0.0)));
  store_float4(split_impulse, stride * 2u + i, extend(w.angular_impulse_b, R(0.0)));
}

/* Friction acts at the centre: a slide along the tangents and a twist about the normal. */
SHARED wrench friction_wrench(vec3 normal, vec3 center_a, vec3 center_b, real first, real second, real twist)
{
  tangents t = tangents_of(normal);
  vec3 slide = add(scale(t.first, first), scale(t.second, second)), turn = scale(normal, twist);
  wrench w = {slide, add(cross3(center_a, slide), turn), add(cross3(center_b, slide), turn)};
  return w;
}

SHARED void split_warm_start_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                  GLOBAL const float4 *constraint_normal_impulse,
                                  GLOBAL const float4 *constraint_friction_impulse, read_solver_bodies solver_bodies,
                                  GLOBAL const uint *counts, GLOBAL float4 *split_impulse, item_index i)
{
  point_planes planes = planes_of(counts);
  contact c = load_contact(parameters, contacts, solver_bodies.velocity, solver_bodies.inertia, i);
  arm_shift shift = load_arm_shift(solver_bodies.delta, c);
  vec4 offset = load_float4(patches.offset, i), center = load_float4(patches.center, i);
  normal_rows s =
      load_normal_rows(patches.points, planes, c, offset, shift, load_float4(constraint_normal_impulse, i), i);
  wrench w = wrench_of(c, s, add(xyz(center), shift.a), add(xyz(center_of_b(center, offset)), shift.b),
                       load_friction(parameters, constraint_friction_impulse, i));
  store_wrench(split_impulse, planes.stride, i, w);
}

/* The normal rows of a manifold between parts. */
SHARED normal_rows load_split_normal_rows(read_patches patches, point_planes planes, contact c, arm_shift shift,
                                          vec4 impulses, vec4 masses, item_index i)
{
  normal_rows s = load_normal_rows(patches.points, planes, c, load_float4(patches.offset, i), shift, impulses, i);
  for (uint k = 0; k < 4u; ++k) s.mass[k] = component(masses, (uint_lanes)k);
  return s;
}

/* The wrench of the points beyond the impulses `old`. */
SHARED wrench wrench_of_points(contact c, const normal_rows *s, vec4 old, vec4 impulses)
{
  real sum = impulses.x - old.x;
  wrench w = {c.normal, scale(s->r_cross_n_a[0], sum), scale(s->r_cross_n_b[0], sum)};
  for (uint k = 1; k < 4u; ++k) {
    real change = component(impulses, (uint_lanes)k) - component(old, (uint_lanes)k);
    sum = sum + change;
    w.angular_impulse_a = add_scaled(w.angular_impulse_a, s->r_cross_n_a[k], change);
    w.angular_impulse_b = add_scaled(w.angular_impulse_b, s->r_cross_n_b[k], change);
  }
  w.impulse = scale(c.normal, sum);
  return w;
}

SHARED wrench add_wrench(wrench a, wrench b)
{
  wrench w = {add(a.impulse, b.impulse), add(a.angular_impulse_a, b.angular_impulse_a),
              add(a.angular_impulse_b, b.angular_impulse_b)};
  return w;
}

/* Nesterov's extrapolation: continues beyond `now` by a share of the last change. */
SHARED vec4 extrapolated(vec4 now, vec4 before, real share)
{
  return make_vec4(now.x + share * (now.x - before.x), now.y + share * (now.y - before.y),
                   now.z + share * (now.z - before.z), now.w);
}

SHARED vec4 extrapolated_normal(vec4 now, vec4 before, real share)
{
  vec4 ahead = extrapolated(now, before, share);
  return make_vec4(maximum(ahead.x, R(0.0)), maximum(ahead.y, R(0.0)), maximum(ahead.z, R(0.0)),
                   maximum(now.w + share * (now.w - before.w), R(0.0)));
}

/* A contact between parts during an iteration. momentum: as in split_solve_item. */
typedef struct {
  contact c;
  delta_pose moved;
  arm_shift shift;
  vec4 point_masses;
  real friction_mass, twist_mass;
  uint momentum;
} split_row;

SHARED split_row load_split_row(GLOBAL const Parameters *parameters, read_contacts contacts,
                                GLOBAL const float4 *split_mass, read_solver_bodies solver_bodies, uint stride,
                                uint momentum, item_index i)
{
  split_row r;
  vec4 other = load_float4(split_mass, stride + i);
  r.c = split_contact(load_contact(parameters, contacts, solver_bodies.velocity, solver_bodies.inertia, i), other.z,
                      other.w);
  r.moved = load_delta_pose(solver_bodies.delta, r.c);
  r.shift = shift_of_contact(r.c, r.moved.translation);
  r.point_masses = load_float4(split_mass, i);
  r.friction_mass = other.x;
  r.twist_mass = other.y;
  r.momentum = momentum;
  return r;
}

/* Solves the friction of rows with friction, and returns its wrench beyond the impulses before. */
SHARED wrench solve_split_friction(split_row *r, mask rough, read_patches patches, real normal_impulse_sum,
                                   GLOBAL float4 *friction_impulse, GLOBAL float4 *rubbed, item_index i)
{
  vec4 center_a = load_float4(patches.center, i), center_b = center_of_b(center_a, load_float4(patches.offset, i));
  vec4 old = load_float4(friction_impulse, i);
  mask stale = masses_are_stale(r->moved, r->shift, center_a, center_b);
  solved sliding = solve_friction(r->c, stale, r->shift, extend(xyz(center_a), r->friction_mass),
                                  extend(xyz(center_b), r->twist_mass), old, normal_impulse_sum);
  r->c = with_velocities_if(rough, r->c, sliding.c);
  vec4 next = sliding.impulse;
  if (r->momentum != 0u) next = extrapolated(next, load_float4(rubbed, i), share_of_momentum(r->momentum));
  store_float4_if(rough, rubbed, i, sliding.impulse);
  store_float4_if(rough, friction_impulse, i, next);
  return friction_wrench(r->c.normal, add(xyz(center_a), r->shift.a), add(xyz(center_b), r->shift.b), next.x - old.x,
                         next.y - old.y, next.z - old.z);
}

/* Solves the points of a manifold together, each toward its own target impulse. */
SHARED void press_split_points(GLOBAL const Parameters *parameters, split_row *r, normal_rows *s, read_patches patches,
                               point_planes planes, uint biased, item_index i)
{
  softness soft = softness_of(parameters, r->c);
  real slop = load_real(patches.slop, i), leak = soft.impulse_scale, closed = dot3(r->c.normal, r->moved.translation);
  real target_impulse[4];
  for (uint k = 0; k < 4u; ++k) {
    real whole = load_point_mass(patches.points, planes, k, i);
    real separation = load_separation(patches.points, planes, k, i) + closed +
                      (dot3(s->r_cross_n_b[k], r->moved.rotation_b) - dot3(s->r_cross_n_a[k], r->moved.rotation_a));
    real speed = speed_along(r->c, r->c.normal, s->r_cross_n_a[k], s->r_cross_n_b[k]);
    soft.impulse_scale =
        leak * (s->mass[k] / choose(whole > R(0.0), whole, (real)R(1.0))); /* so that parts are no softer in the end */
    target_impulse[k] = normal_impulse(parameters, soft, slop, separation, speed, s->mass[k], s->impulse[k], biased);
  }
  r->c = block_solve_normals(r->c, s, target_impulse);
}

/* Stores the normal impulses from which the next iteration starts. */
SHARED vec4 keep_split_impulses(GLOBAL const Parameters *parameters, vec4 normal_impulses, uint momentum, uint stride,
                                write_contact_impulses contact_impulses, GLOBAL float4 *pushed, item_index i)
{
  vec4 next = normal_impulses;
  if (momentum != 0u) next = extrapolated_normal(normal_impulses, load_float4(pushed, i), share_of_momentum(momentum));
  store_float4(pushed, i, normal_impulses);
  store_float4(contact_impulses.normal, i, next);
  keep_highest_impulses(parameters, contact_impulses.restitution, stride, normal_impulses, i);
  return next;
}

/* masses: of split_masses or split_masses_with_joints. momentum: the number of the iteration, from 0, and 0 again
 * for the last one, which must end within the cones. Earlier iterations are extrapolated in the direction of the
 * last change (Nesterov 1983; Mazhar and others, "Using Nesterov's Method to Accelerate Multibody Dynamics with
 * Friction and Contact", 2015). The method requires an upper bound of the coupling of rows, which splitting gives. */
SHARED void split_solve_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                             GLOBAL const float4 *masses, read_solver_bodies solver_bodies, GLOBAL const uint *counts,
                             write_contact_impulses contact_impulses, write_iterates iterates,
                             GLOBAL float4 *split_impulse, uint pass, uint momentum, item_index i)
{
  uint biased = pass == PASS_BIASED ? 1u : 0u;
  point_planes planes = planes_of(counts);
  split_row r = load_split_row(parameters, contacts, masses, solver_bodies, planes.stride, momentum, i);
  vec4 impulses = load_float4(contact_impulses.normal, i);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  wrench rubbed = {none, none, none};
  mask rough = r.c.friction > R(0.0);
  if (HAS_FEATURE(parameters, FRICTION) && any_of(rough)) {
    real normal_impulse_sum = (impulses.x + impulses.y) + (impulses.z + impulses.w);
    rubbed = solve_split_friction(&r, rough, patches, normal_impulse_sum, contact_impulses.friction,
                                  iterates.previous_friction, i);
  }
  normal_rows s = load_split_normal_rows(patches, planes, r.c, r.shift, impulses, r.point_masses, i);
  press_split_points(parameters, &r, &s, patches, planes, biased, i);
  vec4 next = keep_split_impulses(parameters, impulses_of(&s), momentum, planes.stride, contact_impulses,
                                  iterates.previous_normal, i);
  wrench given = wrench_of_points(r.c, &s, impulses, next);
  store_wrench(split_impulse, planes.stride, i, choose_wrench(rough, add_wrench(given, rubbed), given));
}

/* Makes one round of restitution: points that carried an impulse approach their target velocity. */
SHARED void split_restitution_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                   GLOBAL const float4 *constraint_restitution, GLOBAL const float4 *split_mass,
                                   read_solver_bodies solver_bodies, GLOBAL const uint *counts,
                                   GLOBAL float4 *constraint_normal_impulse, GLOBAL float4 *split_impulse, item_index i)
{
  point_planes planes = planes_of(counts);
  vec4 target_velocity = load_float4(constraint_restitution, i),
       highest = load_float4(constraint_restitution, planes.stride + i);
  vec4 masses = load_float4(split_mass, i), other = load_float4(split_mass, planes.stride + i);
  contact c = split_contact(load_contact(parameters, contacts, solver_bodies.velocity, solver_bodies.inertia, i),
                            other.z, other.w);
  vec4 impulses = load_float4(constraint_normal_impulse, i);
  normal_rows s =
      load_split_normal_rows(patches, planes, c, load_arm_shift(solver_bodies.delta, c), impulses, masses, i);
  real normal_impulses[4];
  for (uint k = 0; k < 4u; ++k) {
    real speed = speed_along(c, c.normal, s.r_cross_n_a[k], s.r_cross_n_b[k]);
    normal_impulses[k] = maximum(bouncing_impulse(component(target_velocity, (uint_lanes)k),
                                                  component(highest, (uint_lanes)k), speed, s.mass[k], s.impulse[k]),
                                 R(0.0));
  }
  c = block_solve_normals(c, &s, normal_impulses);
  vec4 parted = make_vec4(s.impulse[0], s.impulse[1], s.impulse[2], s.impulse[3]);
  store_float4(constraint_normal_impulse, i, parted);
  store_wrench(split_impulse, planes.stride, i, wrench_of_points(c, &s, impulses, parted));
}

/* Joins the parts of a body. trees: whether the sums of bodies with long lists have been computed. */
SHARED void split_apply_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_constraint_start,
                             GLOBAL const uint *body_constraint, GLOBAL const uint *body_class,
                             GLOBAL const float4 *split_impulse, GLOBAL const float4 *split_partial,
                             GLOBAL const float4 *solver_inertia, GLOBAL const uint *counts,
                             GLOBAL float4 *solver_velocity, uint trees, item_index i)
{
  uint_lanes start = load_uint(body_constraint_start, i), entries = load_uint(body_constraint_start, i + 1u) - start;
  if (moves_one_class(parameters)) entries = choose(is_moved(parameters, body_class, i), entries, (uint_lanes)0u);
  if (!any_of(entries > (uint_lanes)0u)) return;
  impulse_sum sum =
      sum_of_entries(body_constraint, split_impulse, split_partial, counts[CAPACITY_PAIRS], start, entries, trees);
  push_whole(parameters, solver_inertia, solver_velocity, sum, i);
}

/* The same of a body whose joints are solved at the same time, too. joint_trees: as `trees`, of joints. */
SHARED void split_apply_with_joints_item(GLOBAL const Parameters *parameters, read_body_lists body_lists,
                                         read_parts parts, GLOBAL const float4 *solver_inertia,
                                         GLOBAL const uint *counts, GLOBAL float4 *solver_velocity, uint trees,
                                         uint joint_trees, item_index i)
{
  uint_lanes start = load_uint(body_lists.start, i), contacts = load_uint(body_lists.start, i + 1u) - start;
  uint_lanes first = load_uint(body_lists.joint_start, i), joints = load_uint(body_lists.joint_start, i + 1u) - first;
  mask touches = contacts > (uint_lanes)0u, is_joined = joints > (uint_lanes)0u;
  if (!any_of(touches | is_joined)) return;
  impulse_sum sum =
      sum_of_entries(body_lists.entries, parts.impulse, parts.partial, counts[CAPACITY_PAIRS], start, contacts, trees);
  if (any_of(is_joined)) {
    impulse_sum more = sum_of_entries(body_lists.joint_entries, parts.joint_impulse, parts.joint_partial,
                                      parameters->joints, first, joints, joint_trees);
    impulse_sum both = {add(sum.linear, more.linear), add(sum.angular, more.angular)};
    both.linear = choose3(touches, both.linear, more.linear);
    both.angular = choose3(touches, both.angular, more.angular);
    sum.linear = choose3(is_joined, both.linear, sum.linear);
    sum.angular = choose3(is_joined, both.angular, sum.angular);
  }
  push_whole(parameters, solver_inertia, solver_velocity, sum, i);
}

#endif
