/* coupling_codes.h - the fields of coupling_kind, for kernels and the host: which coordinate of each joint is coupled
 * (JOINT_AXIS_ of joint_codes.h), and whether the coupling only pulls, as a rope does. */
#ifndef TANDEM_SHARED_JOINTS_COUPLING_CODES_H
#define TANDEM_SHARED_JOINTS_COUPLING_CODES_H

enum { COUPLING_KIND_MASK = 15, COUPLING_KIND_B_SHIFT = 4, COUPLING_ONE_SIDED = 256 };

#endif
