/* entry.h - the code that every OpenCL entry shares: the range of items, read on the device.
 *
 * The size of a launch is only a hint. Each work-item strides over the range, so results never depend on the size. */
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

/* One work-group processes TILE items. No loop stands around the phases of a group, because PoCL 3.1 cannot form the
 * work-group's loops then. A launch therefore has at least as many groups as tiles, and group functions return at once
 * for tiles behind the end. */
#define GROUP_NUMBER ((uint)get_group_id(0))

/* Closes the last phase of a group. PoCL 3.1 cuts a kernel into regions at its barriers. Without one here, the loop of
 * the last phase and the exit of the kernel would be in one region, which it compiles wrongly. */
#define END_GROUP barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)

#endif
