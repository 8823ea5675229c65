/* parallel.cl - entries of the primitives in shared/parallel. */
#include "cl/entry.h"
#include "shared/parallel/copy.h"
#include "shared/parallel/fill.h"
#include "shared/parallel/radix_sort.h"
#include "shared/parallel/scan.h"

__kernel void fill(__global uint *values, uint value, RANGE)
{
  FOR_EACH_IN_RANGE(i) fill_item(values, value, i);
}

__kernel void copy(__global const uint *from, __global uint *to, RANGE)
{
  FOR_EACH_IN_RANGE(i) copy_item(from, to, i);
}

__kernel void copy64(__global const ulong *from, __global ulong *to, RANGE)
{
  FOR_EACH_IN_RANGE(i) copy64_item(from, to, i);
}

__kernel void sequence(__global uint *values, RANGE)
{
  FOR_EACH_IN_RANGE(i) sequence_item(values, i);
}

__kernel void scan_reduce(__global const uint *counts, __global const uint *values, __global uint *sums, uint length,
                          uint unit, uint per_unit, RANGE)
{
  __local uint local_memory[SCAN_STRIPS];
  scan_reduce_group(counts, values, sums, length, unit, per_unit, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void scan_in_order(__global const uint *counts, __global const uint *values, __global uint *result,
                            __global uint *total, uint length, uint unit, uint per_unit, uint block, RANGE)
{
  __local uint local_memory[SCAN_LOCAL_WORDS];
  scan_in_order_group(counts, values, result, total, length, unit, per_unit, block, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void scan_tiles(__global const uint *counts, __global const uint *values, __global const uint *sums,
                         __global uint *result, uint length, uint unit, uint per_unit, RANGE)
{
  __local uint local_memory[SCAN_LOCAL_WORDS];
  scan_tiles_group(counts, values, sums, result, length, unit, per_unit, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void sort_histogram(__global const uint *counts, __global const uint *keys, __global uint *histogram, uint length,
                             uint shift, uint bits, RANGE)
{
  __local uint local_memory[SORT_DIGITS];
  sort_histogram_group(counts, keys, histogram, length, shift, bits, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void sort_histogram64(__global const uint *counts, __global const ulong *keys, __global uint *histogram,
                                  uint length, uint shift, uint bits, RANGE)
{
  __local uint local_memory[SORT_DIGITS];
  sort_histogram64_group(counts, keys, histogram, length, shift, bits, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void sort_scatter(__global const uint *counts, __global const uint *keys, __global const uint *offsets,
                                __global uint *sorted_keys, uint length, uint shift, uint bits, RANGE)
{
  __local uint local_memory[SORT_LOCAL_WORDS];
  sort_scatter_group(counts, keys, offsets, sorted_keys, length, shift, bits, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void sort_scatter_pairs(__global const uint *counts, __global const uint *keys, __global const uint *values,
                                 __global const uint *offsets, __global uint *sorted_keys, __global uint *sorted_values,
                                 uint length, uint shift, uint bits, RANGE)
{
  __local uint local_memory[SORT_LOCAL_WORDS];
  sort_scatter_pairs_group(counts, keys, values, offsets, sorted_keys, sorted_values, length, shift, bits, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void sort_scatter64(__global const uint *counts, __global const ulong *keys, __global const uint *offsets,
                                     __global ulong *sorted_keys, uint length, uint shift, uint bits, RANGE)
{
  __local uint local_memory[SORT_LOCAL_WORDS];
  sort_scatter64_group(counts, keys, offsets, sorted_keys, length, shift, bits, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void sort_scatter64_pairs(__global const uint *counts, __global const ulong *keys, __global const uint *values,
                                      __global const uint *offsets, __global ulong *sorted_keys, __global uint *sorted_values,
                                      uint length, uint shift, uint bits, RANGE)
{
  __local uint local_memory[SORT_LOCAL_WORDS];
  sort_scatter64_pairs_group(counts, keys, values, offsets, sorted_keys, sorted_values, length, shift, bits, local_memory, GROUP_NUMBER);
  END_GROUP;
}
