/* compact.h - lists the indices of the items whose flag is not 0, in order: flag, scan, write.
 *
 *   flags     0 7 0 0 1 1
 *   offsets   0 0 1 1 1 2 | 3       scan of (flag != 0); the last one is their number
 *   indices   1 4 5
 */
#ifndef TANDEM_SHARED_PARALLEL_COMPACT_H
#define TANDEM_SHARED_PARALLEL_COMPACT_H

#include "shared/platform.h"

SHARED void compact_count_item(GLOBAL const uint *flags, GLOBAL uint *offsets, uint i)
{
  offsets[i] = flags[i] != 0u ? 1u : 0u;
}

SHARED void compact_write_item(GLOBAL const uint *flags, GLOBAL const uint *offsets, GLOBAL uint *indices, uint i)
{
  if (flags[i] != 0u) indices[offsets[i]] = i;
}

/* Stores the number of flagged items in counts[to], for the launches that follow. */
SHARED void compact_total_item(GLOBAL const uint *offsets, GLOBAL uint *counts, uint length, uint to, uint i)
{
  if (i == 0u) counts[to] = offsets[counts[length]];
}

#endif
