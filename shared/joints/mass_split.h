/* mass_split.h - joints that are solved at the same time as all other joints and as contacts, each on its own part of
 * its bodies, as solve/mass_split.h has it for contacts.
 *
 *     joint                      A body with n joints and contacts has n parts of mass m / n and inertia I / n. The
 *   [a/3|====|b/2]               rows of a joint are those of joints/solve.h, one block after the other, on its two
 *   [a/3|    |b/2|--contact      parts alone. Then it leaves the impulse that it gave, and split_apply_with_joints
 *   [a/3|--contact               adds the impulses of a body: its parts are joined at their mean.
 *
 * Both bodies of a joint get the same impulse at one point, so momentum is kept to rounding in every iteration. The
 * parts are as many as there are joints and contacts, so the sharing of joints/joint.h, which is for passes of one
 * joint after another, has nothing to do here. Iterations are extrapolated as those of contacts are.
 *
 * A soft row of parts leaks less than one of whole bodies, by as much as the parts are lighter, or it would be softer
 * in the end. But what leaks is also what takes impulses of earlier steps out of a body on which the iterations have
 * not agreed. So there is a least leak, which is smaller the more of them there are (LEAST_LEAK_SUM).
 */
#ifndef TANDEM_SHARED_JOINTS_MASS_SPLIT_H
#define TANDEM_SHARED_JOINTS_MASS_SPLIT_H

#include "shared/joints/solve.h"
#include "shared/solve/parts.h"

/* 0 of a side that is the world, or that cannot be pushed. */
SHARED real inverse_mass_of_side(GLOBAL const float4 *solver_velocity, uint_lanes body)
{
  real inverse_mass = load_velocity(solver_velocity, body_of_side(body)).inverse_mass;
  return MAY_OCCUR(JOINTS_TO_WORLD) ? zero_if(body == (uint_lanes)INDEX_NONE, inverse_mass) : inverse_mass;
}

/* The least leaks of the iterations of a pass make this. With half of it nets of 30 x 30 balls gain energy with four
 * iterations, and with none bodies of 24 joints do so with eight. */
#define LEAST_LEAK_SUM R(2.0)

/* Runs once a step: how many parts the bodies of a joint have, and what that leaves of the leak of its rows. rounds: of
 * a pass. */
SHARED void split_parts_of_joints_item(GLOBAL const uint *joint_a, GLOBAL const uint *joint_b,
                                       GLOBAL const float4 *solver_velocity, read_body_lists body_lists,
                                       GLOBAL const uint *split_static_constraints, GLOBAL float4 *split_joint_parts,
                                       uint rounds, item_index i)
{
  uint_lanes a = load_uint(joint_a, i), b = load_uint(joint_b, i);
  real mass_a = inverse_mass_of_side(solver_velocity, a), mass_b = inverse_mass_of_side(solver_velocity, b);
  mask supported = (mass_a == R(0.0)) | (mass_b == R(0.0));
  real parts_a = parts_with_joints(body_lists, split_static_constraints, body_of_side(a), supported),
       parts_b = parts_with_joints(body_lists, split_static_constraints, body_of_side(b), supported);
  real of_parts = parts_a * mass_a + parts_b * mass_b;
  mask moves = of_parts > R(0.0);
  real leak = choose(moves, (mass_a + mass_b) / choose(moves, of_parts, (real)R(1.0)), (real)R(1.0));
  leak = maximum(leak, minimum(LEAST_LEAK_SUM / (real)rounds, R(1.0)));
  store_float4(split_joint_parts, i, make_vec4(parts_a, parts_b, leak, R(0.0)));
}

SHARED joint_side split_side(joint_side s, real parts)
{
  s.velocity.inverse_mass = s.velocity.inverse_mass * parts;
  s.inertia = scaled_inertia(s.inertia, parts);
  s.sharing = R(1.0);
  return s;
}

/* Replaces the two bodies of a joint by their parts. */
SHARED joint split_joint(joint j, vec4 parts)
{
  j.a = split_side(j.a, parts.x);
  j.b = split_side(j.b, parts.y);
  return j;
}

SHARED void store_joint_wrench(GLOBAL const Parameters *parameters, GLOBAL float4 *split_joint_impulse, item_index i,
                               joint_wrench w)
{
  store_float4(split_joint_impulse, i, extend(w.impulse, R(0.0)));
  store_float4(split_joint_impulse, parameters->joints + i, extend(negate(w.moment_a), R(0.0)));
  store_float4(split_joint_impulse, parameters->joints * 2u + i, extend(w.moment_b, R(0.0)));
}

SHARED void split_warm_start_joints_item(GLOBAL const Parameters *parameters, read_joints joints,
                                         read_turning_bodies bodies, read_joint_axes axes, read_joint_impulses impulses,
                                         GLOBAL const float4 *solver_velocity, GLOBAL float4 *split_joint_impulse,
                                         item_index i)
{
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  joint_wrench w =
      joint_wrench_of(parameters, j, f, load_joint_impulses(parameters, impulses.linear, impulses.angular, i));
  if (HAS_FEATURE(parameters, JOINT_AXES)) w = with_wrench_of_axes(parameters, j, f, axes, impulses.axis, w, i);
  store_joint_wrench(parameters, split_joint_impulse, i, w);
}

/* Continues beyond `now` by a share of the last change, and keeps `now` for the next iteration. momentum: as in
 * split_solve_item. */
SHARED vec3 extrapolated_block(vec3 now, GLOBAL float4 *previous, uint momentum, item_index at)
{
  vec3 next = now;
  if (momentum != 0u)
    next = add_scaled(now, subtract(now, xyz(load_float4(previous, at))), share_of_momentum(momentum));
  store_float4(previous, at, extend(now, R(0.0)));
  return next;
}

/* A limit that pushes goes on pushing to the same side, or stops; one that holds both ways may turn. */
SHARED real extrapolated_limit(const joint_axis *axis, real now, real before, real share)
{
  real next = now + share * (now - before);
  real one_sided = choose(now > R(0.0), maximum(next, R(0.0)), choose(now < R(0.0), minimum(next, R(0.0)), now));
  return choose(axis->lower == axis->upper, next, one_sided);
}

SHARED vec4 extrapolated_axis(const joint_axis *axis, vec4 now, vec4 before, real share)
{
  return make_vec4(now.x + share * (now.x - before.x), extrapolated_limit(axis, now.y, before.y, share),
                   now.z + share * (now.z - before.z), now.w);
}

/* A joint after an iteration over its axes, and what they gave. */
typedef struct {
  joint j;
  joint_wrench given;
} solved_axes;

SHARED joint_wrench with_axis_impulse_if(mask wanted, joint_wrench w, const axis_row *r, real sum)
{
  w.impulse = choose3(wanted, add_scaled(w.impulse, r->at.direction, sum), w.impulse);
  w.moment_a = choose3(wanted, add_scaled(w.moment_a, r->moment_a, sum), w.moment_a);
  w.moment_b = choose3(wanted, add_scaled(w.moment_b, r->moment_b, sum), w.moment_b);
  return w;
}

SHARED solved_axes solve_split_axes(GLOBAL const Parameters *parameters, joint j, real leak, joint_frames f,
                                    read_joint_axes axes, GLOBAL float4 *impulse, GLOBAL float4 *previous, uint pass,
                                    uint momentum, item_index i)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  solved_axes s = {j, {none, none, none}};
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    joint_axis axis = load_axis(parameters, axes, k, i);
    mask wanted = axis.kind != (uint_lanes)(uint)JOINT_AXIS_NONE;
    if (!any_of(wanted)) continue;
    item_index at = joint_plane(parameters, k) + i;
    axis_row r = row_of_axis(s.j, f, axis.kind);
    r.leak = leak;
    vec4 now = load_float4(impulse, at);
    real sum = solve_rows_of_axis(parameters, &r, &axis, &now, pass);
    s.j = with_joint_velocities_if(wanted, s.j, apply_along(s.j, &r, sum));
    vec4 next = now;
    if (momentum != 0u) next = extrapolated_axis(&axis, now, load_float4(previous, at), share_of_momentum(momentum));
    sum = sum + ((next.x - now.x) + (next.y - now.y) + (next.z - now.z));
    store_float4_if(wanted, previous, at, now);
    store_float4_if(wanted, impulse, at, next);
    s.given = with_axis_impulse_if(wanted, s.given, &r, sum);
  }
  return s;
}

/* Of a joint without axes that is nothing, and adding 0 would turn -0 into +0. */
SHARED joint_wrench with_given_by_axes(joint_wrench w, joint_wrench more)
{
  mask wanted = is_nonzero(more.impulse) | is_nonzero(more.moment_a) | is_nonzero(more.moment_b);
  w.impulse = choose3(wanted, add(w.impulse, more.impulse), w.impulse);
  w.moment_a = choose3(wanted, add(w.moment_a, more.moment_a), w.moment_a);
  w.moment_b = choose3(wanted, add(w.moment_b, more.moment_b), w.moment_b);
  return w;
}

/* The held rotations and directions, on parts; returns how much their impulses change. */
SHARED joint_impulses solve_split_blocks(GLOBAL const Parameters *parameters, joint j, real leak, joint_frames f,
                                         write_joint_impulses impulses, write_joint_iterates iterates, uint pass,
                                         uint momentum, item_index i)
{
  joint_impulses old = load_joint_impulses(parameters, impulses.linear, impulses.angular, i), now = old;
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) {
    j = solve_angular_block(parameters, j, leak, f, &now.angular, pass);
    j = solve_directions(parameters, j, leak, f, &now.linear, pass);
    now.angular = extrapolated_block(now.angular, iterates.angular, momentum, i);
    store_float4(impulses.angular, i, extend(now.angular, R(0.0)));
  }
  j = solve_point(parameters, j, leak, &now.linear, pass);
  now.linear = extrapolated_block(now.linear, iterates.linear, momentum, i);
  store_float4(impulses.linear, i, extend(now.linear, R(0.0)));
  joint_impulses change = {subtract(now.linear, old.linear), subtract(now.angular, old.angular)};
  return change;
}

SHARED void split_solve_joints_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                    read_joint_axes axes, GLOBAL const float4 *split_joint_parts,
                                    GLOBAL const float4 *solver_velocity, write_joint_impulses impulses,
                                    write_joint_iterates iterates, GLOBAL float4 *split_joint_impulse, uint pass,
                                    uint momentum, item_index i)
{
  vec4 parts = load_float4(split_joint_parts, i);
  joint j = split_joint(load_joint(parameters, joints, bodies, solver_velocity, i), parts);
  joint_frames f = frames_of(parameters, j, joints, i);
  solved_axes of_axes;
  if (HAS_FEATURE(parameters, JOINT_AXES)) {
    of_axes = solve_split_axes(parameters, j, parts.z, f, axes, impulses.axis, iterates.axis, pass, momentum, i);
    j = of_axes.j;
  }
  joint_wrench w = joint_wrench_of(
      parameters, j, f, solve_split_blocks(parameters, j, parts.z, f, impulses, iterates, pass, momentum, i));
  if (HAS_FEATURE(parameters, JOINT_AXES)) w = with_given_by_axes(w, of_axes.given);
  store_joint_wrench(parameters, split_joint_impulse, i, w);
}

#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
/* Counts the joints that each body has with what cannot be pushed, besides its contacts. */
SHARED void split_count_static_joints_item(GLOBAL const uint *joint_a, GLOBAL const uint *joint_b,
                                           GLOBAL const float4 *solver_velocity, GLOBAL uint *split_static_constraints,
                                           uint i)
{
  uint a = joint_a[i], b = joint_b[i];
  uint moves_a = inverse_mass_of_side(solver_velocity, a) > R(0.0),
       moves_b = inverse_mass_of_side(solver_velocity, b) > R(0.0);
  if (moves_a != moves_b) ATOMIC_ADD(split_static_constraints + (moves_a ? a : b), 1u);
}

/* The body in whose list the entry `at` stands. */
SHARED uint body_of_entry(GLOBAL const uint *joint_a, GLOBAL const uint *joint_b, read_body_lists lists, uint at)
{
  uint entry = lists.joint_entries[at];
  return (entry & 1u) != 0u ? joint_b[entry >> 1u] : joint_a[entry >> 1u];
}

/* An item takes two entries, because each joint has up to two. */
SHARED void split_sum_joints_item(GLOBAL const Parameters *parameters, GLOBAL const uint *joint_a,
                                  GLOBAL const uint *joint_b, read_body_lists body_lists,
                                  GLOBAL const float4 *split_joint_impulse, GLOBAL const uint *counts,
                                  GLOBAL float4 *split_joint_partial, uint i)
{
  for (uint at = 2u * i; at < 2u * i + 2u; ++at) {
    if (at >= body_lists.joint_start[counts[COUNT_BODIES]]) return;
    list_run run =
        run_of_list(body_lists.joint_start, body_of_entry(joint_a, joint_b, body_lists, at), SPLIT_CHUNK, 1u, at);
    if (run.starts != 0u)
      sum_run(run, body_lists.joint_entries, split_joint_impulse, parameters->joints, split_joint_partial, at);
  }
}

SHARED void split_join_joints_item(GLOBAL const uint *joint_a, GLOBAL const uint *joint_b, read_body_lists body_lists,
                                   GLOBAL const uint *counts, GLOBAL float4 *split_joint_partial, uint i)
{
  for (uint at = 2u * i; at < 2u * i + 2u; ++at) {
    if (at >= body_lists.joint_start[counts[COUNT_BODIES]]) return;
    list_run run = run_of_list(body_lists.joint_start, body_of_entry(joint_a, joint_b, body_lists, at),
                               SPLIT_CHUNK * SPLIT_CHUNK, SPLIT_CHUNK, at);
    if (run.starts != 0u) join_run(run, split_joint_partial);
  }
}
#endif

#endif
