/* frames.h - the frames of a joint as they are now. */
#ifndef TANDEM_SHARED_JOINTS_FRAMES_H
#define TANDEM_SHARED_JOINTS_FRAMES_H

#include "shared/joints/joint.h"

/* Where both frames are: the axes of frame a, and frame b in them. A scene of ball joints has no use for them. */
typedef struct {
  mat3 axes;
  quat relative;
} joint_frames;

/* frame_a, frame_b: in the axes of their bodies. */
SHARED joint_frames frames_between(joint j, quat frame_a, quat frame_b)
{
  quat a = quat_multiply(j.a.orientation, frame_a), b = quat_multiply(j.b.orientation, frame_b);
  quat back = make_quat(-a.x, -a.y, -a.z, a.w);
  joint_frames f = {rotation_of(a), quat_multiply(back, b)};
  return f;
}

SHARED joint_frames frames_of(GLOBAL const Parameters *parameters, joint j, read_joints joints, item_index i)
{
  joint_frames f = {rotation_of(j.a.orientation), j.b.orientation};
  if (!HAS_FEATURE(parameters, JOINT_FRAMES)) return f;
  return frames_between(j, quat_from(load_float4(joints.frame_a, i)), quat_from(load_float4(joints.frame_b, i)));
}

#endif
