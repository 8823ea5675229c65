/* loads.h - the force and the torque of each joint, and how many joints break by them.
 *
 * An impulse of a substep, divided by its time, is a force. It acts at the origin of frame b, and the torque is about
 * that point. A blow may last one substep, so the largest of a step counts. The host takes broken joints out when the
 * step is made (host/world/joint_calls.cpp).
 */
#ifndef TANDEM_SHARED_JOINTS_LOADS_H
#define TANDEM_SHARED_JOINTS_LOADS_H

#include "shared/joints/solve.h"

/* What a joint gives body b, in axes of the world: an impulse at the origin of frame b, and an angular one about it. */
typedef struct {
  vec3 linear, angular;
} joint_total;

SHARED joint_total total_of_joint(GLOBAL const Parameters *parameters, joint j, joint_frames f, read_joint_axes axes,
                                  read_joint_impulses impulses, uint i)
{
  joint_impulses p = load_joint_impulses(parameters, impulses.linear, impulses.angular, i);
  joint_total total = {p.linear, p.angular};
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) {
    if ((j.modes & (uint)JOINT_XYZ) != (uint)JOINT_XYZ) total.linear = rotate(f.axes, p.linear);
    total.angular = rotate(f.axes, p.angular);
  }
  if (!HAS_FEATURE(parameters, JOINT_AXES)) return total;
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    uint kind = axes.kind[joint_plane(parameters, k) + i];
    if (kind == (uint)JOINT_AXIS_NONE) continue;
    joint_coordinate at = coordinate_of(j, f, kind);
    vec4 kept = load_float4(impulses.axis, joint_plane(parameters, k) + i);
    real sum = (kept.x + kept.y) + kept.z;
    total.linear = add_scaled(total.linear, at.direction, sum);
    total.angular = add_scaled(total.angular, at.turn, sum);
  }
  return total;
}

SHARED void measure_joint_loads_item(GLOBAL const Parameters *parameters, read_joints joints,
                                     read_turning_bodies bodies, read_joint_axes axes, read_joint_impulses impulses,
                                     GLOBAL const float4 *joint_break, GLOBAL const float4 *solver_velocity,
                                     GLOBAL float4 *joint_load, GLOBAL uint *counts, uint substep, uint ends_step,
                                     uint i)
{
  if (leaves_out(parameters, joints, bodies, i)) return;
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  joint_total total = total_of_joint(parameters, j, f, axes, impulses, i);
  real force = parameters->inverse_substep * length_of(total.linear),
       torque = parameters->inverse_substep * length_of(total.angular);
  if (substep > 0u) {
    vec4 before = load_float4(joint_load, i);
    force = maximum(force, before.x);
    torque = maximum(torque, before.y);
  }
  store_float4(joint_load, i, make_vec4(force, torque, R(0.0), R(0.0)));
  vec4 limits = load_float4(joint_break, i);
  if (ends_step != 0u && (force > limits.x || torque > limits.y)) ATOMIC_ADD(counts + COUNT_BROKEN_JOINTS, 1u);
}

#endif
