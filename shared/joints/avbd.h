/* avbd.h - the multipliers and penalties of joints in augmented vertex block descent: from step to step, from substep
 * to substep, and after each iteration. avbd_rows.h has the rows.
 *
 * A penalty grows with its violation, but no further than the mass that its row carries. With a smaller one the
 * multiplier takes many iterations to find a load; with a larger one bodies that move together hand their momentum on
 * by one part in kappa / m an iteration, so that what links turn lags behind and is lost, or gained. The mass is
 * |lambda| / |w - v*|: what hangs still is held by lambda = M g h and differs by g h from its free fall. Springs keep
 * the slow growth of contacts, because all that they are open counts in each substep.
 */
#ifndef TANDEM_SHARED_JOINTS_AVBD_H
#define TANDEM_SHARED_JOINTS_AVBD_H

#include "shared/joints/avbd_rows.h"

/* m/s, rad/s: a multiplier is at most what gives its mass this speed, so that rows that contradict each other pull with
 * a force beside which floats still tell a centimetre a second. */
#define AVBD_LAST_MULTIPLIER R(1e5)
#define AVBD_JOINT_GROWTH R(2.0)    /* of a penalty in an iteration, at most */
#define AVBD_JOINT_SHRINKING R(0.9) /* the same where it is larger than what its row carries */
#define AVBD_SPRING_GAMMA R(0.93)   /* what penalties of springs keep from one substep to the next */
#define AVBD_SLOW_SWING R(0.5)      /* rad^2 in a substep: up to this a swing is left to itself */

/* --- a step begins: the penalties of the last one --- */

SHARED void prepare_held_rows(joint j, joint_frames f, uint first, vec4 old, GLOBAL float4 *penalty, uint i)
{
  real kept[3], before[3];
  put_three(before, xyz(old));
  for (uint k = 0; k < 3u; ++k) {
    kept[k] = R(0.0);
    if (holds_row(j, first + k))
      kept[k] = kept_penalty(row_of_coordinate(j, held_coordinate(j, f, first + k)).mass, before[k], R(1.0));
  }
  store_float4(penalty, i, extend(take_three(kept), R(0.0)));
}

SHARED void prepare_avbd_axes(GLOBAL const Parameters *parameters, joint j, joint_frames f, read_joint_axes axes,
                              GLOBAL const float4 *cached, GLOBAL float4 *penalty, uint i)
{
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    uint at = joint_plane(parameters, k) + i, kind = load_uint(axes.kind, at);
    real mass = kind != (uint)JOINT_AXIS_NONE ? row_of_axis(j, f, kind).mass : R(0.0);
    vec4 old = load_float4(cached, at);
    store_float4(penalty, at,
                 make_vec4(kept_penalty(mass, old.x, R(1.0)), kept_penalty(mass, old.y, R(1.0)),
                           kept_penalty(mass, old.z, R(1.0)), kept_penalty(mass, old.w, R(1.0))));
  }
}

SHARED void avbd_prepare_joints_item(GLOBAL const Parameters *parameters, read_joints joints,
                                     read_turning_bodies bodies, read_joint_axes axes,
                                     read_cached_joint_penalties cached, GLOBAL const float4 *solver_velocity,
                                     write_joint_penalties penalties, uint i)
{
  joint j = load_joint_after(parameters, joints, bodies, solver_velocity, R(0.0), i);
  joint_frames f = frames_of(parameters, j, joints, i);
  prepare_held_rows(j, f, 0u, load_float4(cached.linear, i), penalties.linear, i);
  if (HAS_FEATURE(parameters, JOINT_FRAMES))
    prepare_held_rows(j, f, 3u, load_float4(cached.angular, i), penalties.angular, i);
  if (HAS_FEATURE(parameters, JOINT_AXES)) prepare_avbd_axes(parameters, j, f, axes, cached.axis, penalties.axis, i);
}

/* --- a substep begins --- */

/* The square of the angle by which a push of this size makes a side swing in a second, about, over its time. No push
 * turns a body about its arm. */
SHARED real swing_of_side(joint_side s, real push)
{
  real arm = length_of(s.arm), trace = (s.inertia.xx + s.inertia.yy) + s.inertia.zz, turns = R(0.333333) * trace;
  if (arm > R(0.0)) turns = R(0.5) * (trace - dot3(s.arm, symmetric_times(s.inertia, s.arm)) / (arm * arm));
  if (!(turns > R(0.0))) return R(0.0);
  return push * (arm * turns + s.velocity.inverse_mass / square_root(arm * arm + s.velocity.inverse_mass / turns));
}

SHARED real share_ahead(GLOBAL const Parameters *parameters, joint j, real push)
{
  real swing = parameters->substep * (swing_of_side(j.a, push) + swing_of_side(j.b, push));
  return swing > AVBD_SLOW_SWING ? R(0.5) * (R(1.0) - AVBD_SLOW_SWING / swing) : R(0.0);
}

/* What is left open of three rows. */
SHARED vec3 open_rows(GLOBAL const Parameters *parameters, joint j, joint_frames f, uint first)
{
  real open[3];
  for (uint k = 0; k < 3u; ++k)
    open[k] = holds_row(j, first + k) ? left_open(parameters, held_coordinate(j, f, first + k).value) : R(0.0);
  vec3 left = take_three(open);
  return first == 0u && (j.modes & (uint)JOINT_XYZ) == (uint)JOINT_XYZ ? rotate_back(f.axes, left) : left;
}

/* A motor has a negative damping. */
SHARED uint springs_drive(const joint_axis *axis) { return axis->damping >= R(0.0) ? 1u : 0u; }
/* A soft limit that only stops what comes carries a load as a hard one does; a range of 0 is a spring. */
SHARED uint springs_limit(const joint_axis *axis)
{
  return axis->limit_stiffness > R(0.0) && axis->lower == axis->upper ? 1u : 0u;
}

/* Stiff springs share their momentum slowly, so a penalty that is not needed any more goes down. */
SHARED void lower_spring_penalties(const joint_axis *axis, GLOBAL float4 *penalty, uint at)
{
  vec4 p = load_float4(penalty, at);
  if (springs_drive(axis)) p.x = AVBD_SPRING_GAMMA * p.x;
  if (springs_limit(axis)) p.y = AVBD_SPRING_GAMMA * p.y;
  store_float4(penalty, at, p);
}

/* How far an axis is beyond its limits. */
SHARED real beyond_limits(joint j, joint_frames f, const joint_axis *axis)
{
  if (axis->kind == (uint)JOINT_AXIS_NONE || !has_limits(axis, R(0.0))) return R(0.0);
  axis_row r = row_of_axis(j, f, axis->kind);
  real value = value_near_range(&r, axis);
  return value - clamped(value, axis->lower, axis->upper);
}

/* The size of the push of drive and limit of an axis; 0 for one that turns. */
SHARED real push_of_axis(uint kind, real drive, real limit)
{
  return kind <= (uint)JOINT_AXIS_Z || kind == (uint)JOINT_AXIS_DISTANCE ? magnitude(drive) + magnitude(limit) : R(0.0);
}

/* What axes leave open; the sum of the pushes that they had. */
SHARED real begin_avbd_axes(GLOBAL const Parameters *parameters, joint j, joint_frames f, read_joint_axes axes,
                            write_joint_duals duals, uint i)
{
  real pushes = R(0.0);
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    uint at = joint_plane(parameters, k) + i;
    joint_axis axis = load_axis(parameters, axes, k, i);
    vec4 multiplier = load_float4(duals.axis, at);
    lower_spring_penalties(&axis, duals.axis_penalty, at);
    pushes = pushes + push_of_axis(axis.kind, multiplier.x, multiplier.y);
    store_real(duals.axis_left, at, left_open(parameters, beyond_limits(j, f, &axis)));
  }
  return pushes;
}

SHARED void avbd_begin_joints_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                   read_joint_axes axes, GLOBAL const float4 *solver_velocity, write_joint_duals duals,
                                   uint i)
{
  joint j = load_joint_after(parameters, joints, bodies, solver_velocity, R(0.0), i);
  joint_frames f = frames_of(parameters, j, joints, i);
  real push = length_of(xyz(load_float4(duals.linear, i)));
  if (HAS_FEATURE(parameters, JOINT_AXES)) push = push + begin_avbd_axes(parameters, j, f, axes, duals, i);
  store_float4(duals.linear_left, i, extend(open_rows(parameters, j, f, 0u), share_ahead(parameters, j, push)));
  if (HAS_FEATURE(parameters, JOINT_FRAMES))
    store_float4(duals.angular_left, i, extend(open_rows(parameters, j, f, 3u), R(0.0)));
}

/* --- an iteration ends: multipliers take the impulses, and penalties grow --- */

/* What the velocities of a body are beside those of inertia and gravity alone. */
typedef struct {
  vec3 linear, angular;
} change_of_velocity;
typedef struct {
  change_of_velocity a, b;
} side_changes;

SHARED change_of_velocity load_change(GLOBAL const float4 *avbd_target, joint_side s)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  change_of_velocity c = {none, none};
  if (s.is_world) return c;
  spatial_velocity target = load_velocity(avbd_target, s.body);
  c.linear = subtract(s.velocity.linear, target.linear);
  c.angular = subtract(s.velocity.angular, target.angular);
  return c;
}

SHARED real kept_multiplier(avbd_row r, real mass)
{
  return clamped(r.impulse, -AVBD_LAST_MULTIPLIER * mass, AVBD_LAST_MULTIPLIER * mass);
}

/* The mass that a row carries whose bodies are faster or slower by this speed than inertia and gravity alone have
 * them. What is no more than the row's violation is no load. */
SHARED real carried_mass(real impulse, real speed, real mass, real violation)
{
  if (!(impulse > mass * magnitude(violation))) return AVBD_FREE_PENALTY * mass;
  real most = AVBD_LAST_PENALTY * mass;
  return speed * most > impulse ? maximum(impulse / speed, AVBD_FREE_PENALTY * mass) : most;
}

SHARED vec3 change_at(change_of_velocity c, vec3 arm) { return add(c.linear, cross3(c.angular, arm)); }

/* The larger one of both sides. */
SHARED real speed_at_frame(const side_changes *changes, const avbd_joint *joint)
{
  return maximum(length_of(change_at(changes->a, joint->j.a.arm)), length_of(change_at(changes->b, joint->j.b.arm)));
}
SHARED real speed_along_row(const side_changes *changes, const axis_row *at)
{
  real a = dot3(at->at.direction, changes->a.linear) + dot3(at->moment_a, changes->a.angular),
       b = dot3(at->at.direction, changes->b.linear) + dot3(at->moment_b, changes->b.angular);
  return maximum(magnitude(a), magnitude(b));
}

/* carried: the mass beyond which the penalty does not grow. It is known only as well as the iterations have converged,
 * so a penalty follows it by degrees. */
SHARED real grown_row(avbd_row r, real penalty, real mass, real carried)
{
  if (!(mass > R(0.0))) return penalty;
  if (penalty > carried) return maximum(carried, AVBD_JOINT_SHRINKING * penalty);
  if (r.holds == 0u) return penalty;
  real grown = penalty + AVBD_BETA * mass * magnitude(r.violation);
  return minimum(minimum(grown, carried), maximum(AVBD_JOINT_GROWTH * penalty, AVBD_FREE_PENALTY * mass));
}

SHARED real grown_axis_row(avbd_row r, real penalty, real mass, real speed, uint springs)
{
  if (springs != 0u) return grown_penalty(penalty, mass, r.violation, r.holds != 0u);
  return grown_row(r, penalty, mass, carried_mass(magnitude(r.impulse), speed, mass, r.violation));
}

SHARED void grow_held_rows(GLOBAL const Parameters *parameters, const avbd_joint *joint, const side_changes *changes,
                           held_rows *rows)
{
  real impulse[2] = {length_of(take_three(rows->multiplier)),
                     HAS_FEATURE(parameters, JOINT_FRAMES) ? length_of(take_three(rows->multiplier + 3)) : R(0.0)};
  real speed[2] = {speed_at_frame(changes, joint),
                   maximum(length_of(changes->a.angular), length_of(changes->b.angular))};
  for (uint k = 0; k < (HAS_FEATURE(parameters, JOINT_FRAMES) ? 6u : 3u); ++k) {
    if (!holds_row(joint->j, k)) continue;
    axis_row at = held_row_of(joint, rows, k);
    avbd_row r = held_row(rows->multiplier[k], rows->penalty[k], at.at.value * parameters->inverse_substep);
    rows->multiplier[k] = kept_multiplier(r, at.mass);
    rows->penalty[k] =
        grown_row(r, rows->penalty[k], at.mass, carried_mass(impulse[k / 3u], speed[k / 3u], at.mass, r.violation));
  }
}

/* A drive that a limit stops would push harder in every iteration. */
SHARED uint presses_limit(const avbd_axis *rows, real multiplier)
{
  return rows->drive.impulse * rows->limit.impulse < R(0.0) && magnitude(rows->drive.impulse) > magnitude(multiplier);
}
SHARED avbd_row held_as(real multiplier)
{
  avbd_row r = {multiplier, R(0.0), R(0.0), 0u};
  return r;
}

/* The sum of the pushes of axes. */
SHARED real grow_axes(GLOBAL const Parameters *parameters, const avbd_joint *joint, const side_changes *changes,
                      read_joint_blocks blocks, write_joint_duals duals, uint i)
{
  real pushes = R(0.0);
  read_joint_axes axes = {blocks.kind, blocks.row};
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    uint at = joint_plane(parameters, k) + i;
    if (load_uint(blocks.kind, at) == (uint)JOINT_AXIS_NONE) continue;
    avbd_axis rows = load_avbd_axis(parameters, joint, blocks, k, i);
    vec4 penalty = load_float4(blocks.axis_penalty, at);
    real mass = rows.at.mass, speed = speed_along_row(changes, &rows.at);
    if (presses_limit(&rows, load_float4(blocks.axis, at).x)) rows.drive = held_as(load_float4(blocks.axis, at).x);
    store_float4(duals.axis, at,
                 make_vec4(kept_multiplier(rows.drive, mass), kept_multiplier(rows.limit, mass),
                           kept_multiplier(rows.friction, mass), kept_multiplier(rows.speed, mass)));
    joint_axis axis = load_axis(parameters, axes, k, i);
    store_float4(duals.axis_penalty, at,
                 make_vec4(grown_axis_row(rows.drive, penalty.x, mass, speed, springs_drive(&axis)),
                           grown_axis_row(rows.limit, penalty.y, mass, speed, springs_limit(&axis)),
                           grown_axis_row(rows.friction, penalty.z, mass, speed, 0u),
                           grown_axis_row(rows.speed, penalty.w, mass, speed, 0u)));
    pushes = pushes + push_of_axis(axis.kind, rows.drive.impulse, rows.limit.impulse);
  }
  return pushes;
}

SHARED void avbd_joint_duals_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                  read_joint_axes axes, GLOBAL const float4 *solver_velocity,
                                  GLOBAL const float4 *avbd_target, write_joint_duals duals, uint i)
{
  read_joint_blocks blocks = {axes.kind,
                              axes.row,
                              duals.linear,
                              duals.angular,
                              duals.axis,
                              duals.linear_penalty,
                              duals.angular_penalty,
                              duals.axis_penalty,
                              duals.linear_left,
                              duals.angular_left,
                              duals.axis_left};
  avbd_joint joint =
      load_avbd_joint(parameters, joints, bodies, solver_velocity, load_float4(duals.linear_left, i).w, i);
  held_rows rows = load_held_rows(parameters, blocks, i);
  side_changes changes = {load_change(avbd_target, joint.j.a), load_change(avbd_target, joint.j.b)};
  grow_held_rows(parameters, &joint, &changes, &rows);
  store_float4(duals.linear, i, extend(take_three(rows.multiplier), R(0.0)));
  store_float4(duals.linear_penalty, i, extend(take_three(rows.penalty), R(0.0)));
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) {
    store_float4(duals.angular, i, extend(take_three(rows.multiplier + 3), R(0.0)));
    store_float4(duals.angular_penalty, i, extend(take_three(rows.penalty + 3), R(0.0)));
  }
  real push = length_of(take_three(rows.multiplier)); /* a blow may be new in this substep */
  if (HAS_FEATURE(parameters, JOINT_AXES)) push = push + grow_axes(parameters, &joint, &changes, blocks, duals, i);
  vec4 left = load_float4(duals.linear_left, i);
  left.w = maximum(left.w, share_ahead(parameters, joint.j, push));
  store_float4(duals.linear_left, i, left);
}

/* --- a step has succeeded --- */

SHARED void avbd_cache_joints_item(GLOBAL const Parameters *parameters, read_joint_penalties penalties,
                                   write_cached_joint_penalties cached, uint i)
{
  store_float4(cached.linear, i, load_float4(penalties.linear, i));
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) store_float4(cached.angular, i, load_float4(penalties.angular, i));
  if (!HAS_FEATURE(parameters, JOINT_AXES)) return;
  for (uint k = 0; k < parameters->joint_axes; ++k)
    store_float4(cached.axis, joint_plane(parameters, k) + i,
                 load_float4(penalties.axis, joint_plane(parameters, k) + i));
}

#endif
