/* frames.h - the frames of a joint as they are now. */
#ifndef TANDEM_SHARED_JOINTS_FRAMES_H
#define TANDEM_SHARED_JOINTS_FRAMES_H

#include "shared/joints/joint.h"

/* Where both frames are: the axes of frame a, and frame b in them. A scene of ball joints has no use for them. */
typedef struct {
  mat3 axes;
  quat relative;
} joint_frames;

SHARED joint_frames frames_of(GLOBAL const Parameters *parameters, joint j, read_joints joints, item_index i)
{
  joint_frames f = {rotation_of(j.a.orientation), j.b.orientation};
  if (!HAS_FEATURE(parameters, JOINT_FRAMES)) return f;
  quat a = quat_multiply(j.a.orientation, quat_from(load_float4(joints.frame_a, i)));
  quat b = quat_multiply(j.b.orientation, quat_from(load_float4(joints.frame_b, i)));
  quat back = make_quat(-a.x, -a.y, -a.z, a.w);
  f.axes = rotation_of(a);
  f.relative = quat_multiply(back, b);
  return f;
}

#endif
