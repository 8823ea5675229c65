/* driven.h - bodies that a spring or motor of a joint moves do not rest, however slowly they move.
 *
 * A slow hand of a clock would otherwise fall asleep on its way. A drive that holds still, at its rest, against a stop
 * or under a load, keeps nobody awake.
 */
#ifndef TANDEM_SHARED_JOINTS_DRIVEN_H
#define TANDEM_SHARED_JOINTS_DRIVEN_H

#include "shared/joints/axes.h"

/* Of Settings::sleep_speed, a share that is far above what jitters. */
#define SLOWEST_DRIVE R(0.1)

/* A spring moves towards its rest; a motor or damper moves as its velocity says, if only half as fast. */
SHARED uint drive_moves(GLOBAL const Parameters *parameters, const axis_row *r, const joint_axis *axis)
{
  real slowest = SLOWEST_DRIVE * parameters->sleep_speed, target = axis->target_speed;
  real open = distance_from(r->at.value, axis->target, is_rotation(axis->kind));
  uint pulls = axis->stiffness > R(0.0) && r->speed * open < R(0.0) && magnitude(r->speed) > slowest;
  uint turns = axis->damping != R(0.0) && r->speed * target > R(0.0) &&
               magnitude(r->speed) > minimum(slowest, R(0.5) * magnitude(target));
  return axis->largest_force > R(0.0) && (pulls || turns) ? 1u : 0u;
}

SHARED void begin_rest_anew(GLOBAL uint *rest_count, joint_side s)
{
  if (!s.is_world) ATOMIC_MIN(rest_count + s.body, 0u);
}

SHARED void disturb_driven_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                read_joint_axes axes, GLOBAL const float4 *solver_velocity, GLOBAL uint *rest_count,
                                uint i)
{
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    joint_axis axis = load_axis(parameters, axes, k, i);
    if (axis.kind == (uint)JOINT_AXIS_NONE) continue;
    axis_row r = row_of_axis(j, f, axis.kind);
    if (!drive_moves(parameters, &r, &axis)) continue;
    begin_rest_anew(rest_count, j.a);
    begin_rest_anew(rest_count, j.b);
  }
}

#endif
