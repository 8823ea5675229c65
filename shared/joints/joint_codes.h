/* joint_codes.h - what joint_modes says of a joint, for kernels and the host.
 *
 * The axes are those of the joint's frame on body a. Every type of joint is a choice of locked axes; the table of the
 * types is shared/joints.def.
 */
#ifndef TANDEM_SHARED_JOINTS_JOINT_CODES_H
#define TANDEM_SHARED_JOINTS_JOINT_CODES_H

/* Locked directions, and three bits further locked rotations. */
enum { JOINT_X = 1, JOINT_Y = 2, JOINT_Z = 4, JOINT_XYZ = 7, JOINT_ANGULAR_SHIFT = 3 };

#endif
