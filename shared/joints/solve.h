/* solve.h - the passes of joints in all solvers that have them: limits and drives first, then angular rows as one
 * block, then linear rows as another. Which passes a solver makes: host/pipeline/solvers/joints.h.
 *
 * A joint is a soft constraint as a contact is (solve/contact_normals.h): a pass with bias closes what is open like an
 * overdamped spring, and a relaxing pass takes the velocity of closing out again. Both blocks are solved where the
 * bodies are now, so a joint follows any turn within a step. (Catto, "Soft Constraints", GDC 2011; Box2D version 3.)
 *
 * Locked rotations are measured in frame a. If one or two are locked, what counts is how far the axis x of frame b
 * leans, because the turn about x is free:
 *
 *        x of a  ^  ,x of b        lean = x of a cross x of b
 *                | /
 */
#ifndef TANDEM_SHARED_JOINTS_SOLVE_H
#define TANDEM_SHARED_JOINTS_SOLVE_H

#include "shared/joints/axes.h"
#include "shared/joints/block.h"
#include "shared/joints/frames.h"

/* What a pass with bias wants of rows: the velocity at which they close, which share of the impulse of rigid rows they
 * take, and how much of their impulse leaks away. */
typedef struct {
  vec3 closing;
  real mass_scale, leak;
} soft_rows;

/* Where the way is so long that its closing is limited, less leaks in proportion, because a leak that stayed the same
 * would let a heavy load draw the joint out for ever. Some leaks always: joints that contradict each other would
 * otherwise pull with any force. */
SHARED soft_rows soft_rows_of(joint_softness soft, vec3 open, real fastest, real least_leak)
{
  vec3 closing = scale(open, soft.bias_rate);
  real squared = length_squared(closing);
  mask limited = squared > fastest * fastest;
  real share = choose(limited, fastest / square_root(choose(limited, squared, (real)R(1.0))), (real)R(1.0));
  soft_rows rows = {scale(closing, share), soft.mass_scale, soft.impulse_scale * maximum(share, least_leak)};
  return rows;
}

/* The impulse of a block after a pass. k: the response of its rows; leak: as that of an axis; velocity, open: of the
 * rows; old: their impulse. */
SHARED vec3 solve_rows(joint_softness soft, symmetric3 k, real leak, vec3 velocity, vec3 open, vec3 old, uint pass)
{
  if (pass != PASS_BIASED) return subtract(old, solve_symmetric(k, velocity));
  soft_rows rows = soft_rows_of(soft, open, JOINT_CLOSING, LEAST_LEAK);
  vec3 rigid = solve_symmetric(k, add(velocity, rows.closing));
  return subtract(subtract(old, scale(rigid, rows.mass_scale)), scale(old, rows.leak * leak));
}

/* How far frame b is turned from frame a, in axes of a: about all three axes, or as the lean of the axis x. */
SHARED vec3 turn_between(quat q, uint_lanes locked)
{
  real twice = choose(q.w < R(0.0), (real)R(-2.0), (real)R(2.0));
  vec3 whole = make_vec3(twice * q.x, twice * q.y, twice * q.z);
  vec3 lean = make_vec3(R(0.0), R(2.0) * (q.w * q.y - q.x * q.z), R(2.0) * (q.x * q.y + q.w * q.z));
  return choose3(locked == (uint_lanes)(uint)JOINT_XYZ, whole, lean);
}

SHARED joint solve_angular_block(GLOBAL const Parameters *parameters, joint j, real leak, joint_frames f, vec3 *impulse,
                                 uint pass)
{
  uint_lanes locked = j.modes >> (uint)JOINT_ANGULAR_SHIFT;
  mask wanted = locked != 0u;
  if (!any_of(wanted)) return j;
  symmetric3 of_a = scaled_tensor(j.a.inertia, j.a.sharing), of_b = scaled_tensor(j.b.inertia, j.b.sharing);
  symmetric3 k = rows_of_axes(locked, tensor_in_axes(f.axes, add_symmetric(of_a, of_b)));
  vec3 velocity = rotate_back(f.axes, subtract(j.b.velocity.angular, j.a.velocity.angular));
  vec3 total = solve_rows(joint_softness_of(parameters, is_crowded(&j)), k, leak, along_axes(locked, velocity),
                          along_axes(locked, turn_between(f.relative, locked)), *impulse, pass);
  vec3 change = rotate(f.axes, subtract(total, *impulse));
  *impulse = choose3(wanted, total, *impulse);
  joint moved = j;
  moved.a.velocity.angular = subtract(j.a.velocity.angular, symmetric_times(j.a.inertia, change));
  moved.b.velocity.angular = add(j.b.velocity.angular, symmetric_times(j.b.inertia, change));
  return with_joint_velocities_if(wanted, j, moved);
}

/* Some of the three directions, in axes of frame a. */
SHARED joint solve_directions(GLOBAL const Parameters *parameters, joint j, real leak, joint_frames f, vec3 *impulse,
                              uint pass)
{
  uint_lanes locked = j.modes & (uint)JOINT_XYZ;
  mask wanted = (locked != 0u) & (locked != (uint_lanes)(uint)JOINT_XYZ);
  if (!any_of(wanted)) return j;
  symmetric3 k =
      rows_of_axes(locked, tensor_in_axes(f.axes, add_symmetric(response_of_side(j.a), response_of_side(j.b))));
  vec3 gap = along_axes(locked, rotate_back(f.axes, j.gap));
  vec3 velocity = along_axes(locked, rotate_back(f.axes, closing_velocity(j)));
  vec3 total = solve_rows(joint_softness_of(parameters, is_crowded(&j)), k, leak, velocity, gap, *impulse, pass);
  vec3 change = rotate(f.axes, subtract(total, *impulse));
  *impulse = choose3(wanted, total, *impulse);
  return with_joint_velocities_if(wanted, j, apply_at_frame(j, change));
}

/* All three directions, in axes of the world. */
SHARED joint solve_point(GLOBAL const Parameters *parameters, joint j, real leak, vec3 *impulse, uint pass)
{
  mask wanted = (j.modes & (uint)JOINT_XYZ) == (uint_lanes)(uint)JOINT_XYZ;
  if (!any_of(wanted)) return j;
  symmetric3 k = add_symmetric(response_of_side(j.a), response_of_side(j.b));
  vec3 total =
      solve_rows(joint_softness_of(parameters, is_crowded(&j)), k, leak, closing_velocity(j), j.gap, *impulse, pass);
  vec3 change = subtract(total, *impulse);
  *impulse = choose3(wanted, total, *impulse);
  return with_joint_velocities_if(wanted, j, apply_at_frame(j, change));
}

/* The impulses of a joint: of the linear rows in axes of the world if all three are locked, else in those of frame a;
 * of the angular rows in those of frame a. */
typedef struct {
  vec3 linear, angular;
} joint_impulses;

SHARED joint_impulses load_joint_impulses(GLOBAL const Parameters *parameters, GLOBAL const float4 *linear,
                                          GLOBAL const float4 *angular, item_index i)
{
  joint_impulses p = {xyz(load_float4(linear, i)), make_vec3(R(0.0), R(0.0), R(0.0))};
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) p.angular = xyz(load_float4(angular, i));
  return p;
}

/* A joint without angular rows adds no moment, because adding 0 would turn -0 into +0. */
SHARED joint_wrench joint_wrench_of(GLOBAL const Parameters *parameters, joint j, joint_frames f, joint_impulses p)
{
  joint_wrench w;
  w.impulse = p.linear;
  if (HAS_FEATURE(parameters, JOINT_FRAMES))
    w.impulse = choose3((j.modes & (uint)JOINT_XYZ) == (uint_lanes)(uint)JOINT_XYZ, p.linear, rotate(f.axes, p.linear));
  w.moment_a = cross3(j.a.arm, w.impulse);
  w.moment_b = cross3(j.b.arm, w.impulse);
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) {
    mask turns = (j.modes >> (uint)JOINT_ANGULAR_SHIFT) != 0u;
    vec3 moment = rotate(f.axes, p.angular);
    w.moment_a = choose3(turns, add(w.moment_a, moment), w.moment_a);
    w.moment_b = choose3(turns, add(w.moment_b, moment), w.moment_b);
  }
  return w;
}

/* Applies the impulses of the last step or substep. */
SHARED void warm_start_joints_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                   read_joint_axes axes, read_joint_impulses impulses, GLOBAL float4 *solver_velocity,
                                   item_index i)
{
  if (leaves_out(parameters, joints, bodies, i)) return;
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  joint_impulses p = load_joint_impulses(parameters, impulses.linear, impulses.angular, i);
  joint_wrench w = joint_wrench_of(parameters, j, f, p);
  if (HAS_FEATURE(parameters, JOINT_AXES)) w = with_wrench_of_axes(parameters, j, f, axes, impulses.axis, w, i);
  push_side(&j.a, w.impulse, w.moment_a, R(-1.0));
  push_side(&j.b, w.impulse, w.moment_b, R(1.0));
  store_joint_velocities(solver_velocity, j);
}

/* Gathers the warm start of the next substep, as add_warm_start_impulse_if does for contacts. */
SHARED void add_to_warm_start(GLOBAL float4 *warm_start_impulse, joint_side s, vec3 impulse, vec3 moment, real sign)
{
  mask moves = s.velocity.inverse_mass > R(0.0);
  vec3 linear = xyz(load_float4(warm_start_impulse, s.body * 2u)),
       angular = xyz(load_float4(warm_start_impulse, s.body * 2u + 1u));
  store_float4_if(moves, warm_start_impulse, s.body * 2u, extend(add_scaled(linear, impulse, sign), R(0.0)));
  store_float4_if(moves, warm_start_impulse, s.body * 2u + 1u, extend(add_scaled(angular, moment, sign), R(0.0)));
}

SHARED void solve_joints_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                              read_joint_axes axes, write_joint_impulses impulses, GLOBAL float4 *solver_velocity,
                              GLOBAL float4 *warm_start_impulse, uint pass, item_index i)
{
  if (leaves_out(parameters, joints, bodies, i)) return;
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  joint_impulses p = load_joint_impulses(parameters, impulses.linear, impulses.angular, i);
  if (HAS_FEATURE(parameters, JOINT_AXES)) j = solve_axes(parameters, j, f, axes, impulses.axis, pass, i);
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) {
    j = solve_angular_block(parameters, j, (real)R(1.0), f, &p.angular, pass);
    j = solve_directions(parameters, j, (real)R(1.0), f, &p.linear, pass);
    store_float4(impulses.angular, i, extend(p.angular, R(0.0)));
  }
  j = solve_point(parameters, j, (real)R(1.0), &p.linear, pass);
  store_float4(impulses.linear, i, extend(p.linear, R(0.0)));
  store_joint_velocities(solver_velocity, j);
  if (pass != PASS_RELAXING) return;
  joint_wrench w = joint_wrench_of(parameters, j, f, p);
  if (HAS_FEATURE(parameters, JOINT_AXES)) w = with_wrench_of_axes(parameters, j, f, axes, impulses.axis, w, i);
  add_to_warm_start(warm_start_impulse, j.a, w.impulse, w.moment_a, R(-1.0));
  add_to_warm_start(warm_start_impulse, j.b, w.impulse, w.moment_b, R(1.0));
}

#endif
