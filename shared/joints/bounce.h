/* bounce.h - what arrives at a hard limit of a joint leaves it again, with a share of its speed.
 *
 *   before the substeps    the speed of each axis is noted
 *   after each of them     the impulse of its limit, if it has one
 *   after the last one     an axis whose limit pushed, and which went towards it fast enough, gets its speed back,
 *                          turned round and times the restitution
 *
 * Contacts bounce likewise (solve/restitution.h).
 */
#ifndef TANDEM_SHARED_JOINTS_BOUNCE_H
#define TANDEM_SHARED_JOINTS_BOUNCE_H

#include "shared/joints/axes.h"

SHARED joint bounce_axis(GLOBAL const Parameters *parameters, joint j, joint_frames f, const joint_axis *axis,
                         vec4 noted)
{
  axis_row r = row_of_axis(j, f, axis->kind);
  real before = noted.x, limit = noted.y;
  mask bounces = (before * limit < R(0.0)) & (magnitude(before) > parameters->restitution_speed);
  real change = r.mass * (R(0.0) - axis->restitution * before - r.speed);
  bounces = bounces & (change * limit > R(0.0));
  return with_joint_velocities_if(bounces, j, apply_along(j, &r, change));
}

SHARED void bounce_at_limits_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                  read_joint_axes axes, GLOBAL const float4 *joint_bounce,
                                  GLOBAL float4 *solver_velocity, item_index i)
{
  if (leaves_out(parameters, joints, bodies, i)) return;
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    joint_axis axis = load_axis(parameters, axes, k, i);
    mask wanted = (axis.kind != (uint_lanes)(uint)JOINT_AXIS_NONE) & (axis.restitution > R(0.0));
    if (!any_of(wanted)) continue;
    vec4 noted = load_float4(joint_bounce, joint_plane(parameters, k) + i);
    j = with_joint_velocities_if(wanted, j, bounce_axis(parameters, j, f, &axis, noted));
  }
  store_joint_velocities(solver_velocity, j);
}

#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
#include "shared/joints/overflow.h"

/* begins: before the first substep. */
SHARED void follow_limits_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                               read_joint_axes axes, read_joint_impulses impulses, GLOBAL const float4 *solver_velocity,
                               GLOBAL float4 *joint_bounce, uint begins, uint i)
{
  if (leaves_out(parameters, joints, bodies, i)) return;
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    joint_axis axis = load_axis(parameters, axes, k, i);
    uint at = joint_plane(parameters, k) + i;
    if (axis.kind == (uint)JOINT_AXIS_NONE || !(axis.restitution > R(0.0))) continue;
    if (begins != 0u) {
      axis_row r = row_of_axis(j, f, axis.kind);
      store_float4(joint_bounce, at, make_vec4(r.speed, R(0.0), R(0.0), R(0.0)));
      continue;
    }
    vec4 noted = load_float4(joint_bounce, at);
    real limit = load_float4(impulses.axis, at).y;
    if (limit != R(0.0)) store_float4(joint_bounce, at, make_vec4(noted.x, limit, R(0.0), R(0.0)));
  }
}

SHARED void bounce_at_overflow_limits_item(GLOBAL const Parameters *parameters, read_joints joints,
                                           read_turning_bodies bodies, read_joint_axes axes,
                                           GLOBAL const float4 *joint_bounce, GLOBAL const uint *counts,
                                           GLOBAL float4 *solver_velocity, uint only)
{
  (void)only;
  FOR_EACH_OVERFLOW_JOINT(i)
  bounce_at_limits_item(parameters, joints, bodies, axes, joint_bounce, solver_velocity, i);
}
#endif

#endif
