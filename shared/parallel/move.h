/* move.h - gather, scatter, offset and adjacent difference, one item each. */
#ifndef TANDEM_SHARED_PARALLEL_MOVE_H
#define TANDEM_SHARED_PARALLEL_MOVE_H

#include "shared/platform.h"

SHARED void gather_item(GLOBAL const uint *values, GLOBAL const uint *indices, GLOBAL uint *result, uint i)
{
  result[i] = values[indices[i]];
}

/* No index may occur twice, because the two writes would be a race. */
SHARED void scatter_item(GLOBAL const uint *values, GLOBAL const uint *indices, GLOBAL uint *result, uint i)
{
  result[indices[i]] = values[i];
}

SHARED void add_offset_item(GLOBAL uint *values, uint offset, uint i) { values[i] += offset; }

/* result[0] = values[0], result[i] = values[i] - values[i - 1] modulo 2^32: the inverse of an inclusive scan. */
SHARED void difference_item(GLOBAL const uint *values, GLOBAL uint *result, uint i)
{
  result[i] = i == 0u ? values[0] : values[i] - values[i - 1u];
}

#endif
