/* entry.h - what every OpenCL entry shares: the range of items, read on the device.
 *
 * A launch is a hint of size: each work-item strides over the range, so results never depend on it. */
#ifndef TANDEM_CL_ENTRY_H
#define TANDEM_CL_ENTRY_H

#include "shared/counts.h"
#include "shared/features.h"
#include "shared/platform.h"

/* Every entry ends with these arguments: the counts, and the two entries of them that bound the range. */
#define RANGE __global const uint *range, uint first, uint last

#define FOR_EACH_IN_RANGE(i)                                                                         \
  for (uint i = range[first] + (uint)get_global_id(0), end_of_range = range[last]; i < end_of_range; \
       i += (uint)get_global_size(0))

/* One work-group per TILE items. No loop stands around the phases of a group (PoCL 3.1 cannot form the
 * work-group's loops then), so a launch has at least as many groups as tiles, and functions of groups
 * leave alone what lies behind the end. */
#define GROUP_NUMBER ((uint)get_group_id(0))

/* Closes the last phase of a group. PoCL 3.1 cuts a kernel into regions at its barriers, and without one
 * here the last phase's loop and the kernel's exit fall into one region, which it compiles wrongly. */
#define END_GROUP barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)

#endif
