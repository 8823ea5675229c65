/* joint_codes.h - what joint_modes and joint_axis_kind say of a joint, for kernels and the host.
 *
 * The axes are those of the joint's frame on body a. Every type of joint is a choice of locked axes; the table of the
 * types is shared/joints.def.
 */
#ifndef TANDEM_SHARED_JOINTS_JOINT_CODES_H
#define TANDEM_SHARED_JOINTS_JOINT_CODES_H

/* Locked directions, and three bits further locked rotations. */
enum { JOINT_X = 1, JOINT_Y = 2, JOINT_Z = 4, JOINT_XYZ = 7, JOINT_ANGULAR_SHIFT = 3 };

/* The coordinates that a joint may limit, drive or brake (joints/coordinates.h). */
enum {
  JOINT_AXIS_X,
  JOINT_AXIS_Y,
  JOINT_AXIS_Z,
  JOINT_AXIS_TWIST,
  JOINT_AXIS_SWING_Y,
  JOINT_AXIS_SWING_Z,
  JOINT_AXIS_TURN,
  JOINT_AXIS_SPIN,
  JOINT_AXIS_CONE,
  JOINT_AXIS_AROUND,
  JOINT_AXIS_DISTANCE,
  JOINT_AXIS_CROSS,
  JOINT_AXIS_NONE
};

/* The damping in the row of an axis whose drive is a motor. */
enum { DAMPING_OF_MOTOR = -1 };

#endif
