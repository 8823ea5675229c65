/* copy.h - copies of buffers, and the sequence 0, 1, 2, .. that a sort carries along as values. */
#ifndef TANDEM_SHARED_PARALLEL_COPY_H
#define TANDEM_SHARED_PARALLEL_COPY_H

#include "shared/platform.h"

SHARED void copy_item(GLOBAL const uint *from, GLOBAL uint *to, uint i) { to[i] = from[i]; }
SHARED void copy64_item(GLOBAL const ulong *from, GLOBAL ulong *to, uint i) { to[i] = from[i]; }
SHARED void sequence_item(GLOBAL uint *values, uint i) { values[i] = i; }

#endif
