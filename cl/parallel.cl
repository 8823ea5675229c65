/* parallel.cl - entries of the primitives in shared/parallel. */
#include "cl/entry.h"
#include "shared/parallel/bitonic_sort.h"
#include "shared/parallel/compact.h"
#include "shared/parallel/copy.h"
#include "shared/parallel/fill.h"
#include "shared/parallel/flip_float.h"
#include "shared/parallel/move.h"
#include "shared/parallel/radix_sort.h"
#include "shared/parallel/reduce.h"
#include "shared/parallel/scan.h"
#include "shared/parallel/search.h"

__kernel void fill(__global uint *values, uint value, RANGE) { FOR_EACH_IN_RANGE(i) fill_item(values, value, i); }

__kernel void copy(__global const uint *from, __global uint *to, RANGE) { FOR_EACH_IN_RANGE(i) copy_item(from, to, i); }

__kernel void copy64(__global const ulong *from, __global ulong *to, RANGE)
{
  FOR_EACH_IN_RANGE(i) copy64_item(from, to, i);
}

__kernel void sequence(__global uint *values, RANGE) { FOR_EACH_IN_RANGE(i) sequence_item(values, i); }

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

__kernel void sort_histogram(__global const uint *counts, __global const uint *keys, __global uint *histogram,
                             uint length, uint shift, uint bits, RANGE)
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
  sort_scatter_pairs_group(counts, keys, values, offsets, sorted_keys, sorted_values, length, shift, bits, local_memory,
                           GROUP_NUMBER);
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
                                   __global const uint *offsets, __global ulong *sorted_keys,
                                   __global uint *sorted_values, uint length, uint shift, uint bits, RANGE)
{
  __local uint local_memory[SORT_LOCAL_WORDS];
  sort_scatter64_pairs_group(counts, keys, values, offsets, sorted_keys, sorted_values, length, shift, bits,
                             local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void reduce_tiles(__global const uint *counts, __global const uint *values, __global uint *partial,
                           uint length, uint operation, RANGE)
{
  __local uint local_memory[REDUCE_ITEMS];
  reduce_tiles_group(counts, values, partial, length, operation, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void reduce_partials(__global const uint *counts, __global const uint *partial, __global uint *result,
                              uint length, uint operation, RANGE)
{
  __local uint local_memory[REDUCE_ITEMS];
  reduce_partials_group(counts, partial, result, length, operation, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void reduce_real_tiles(__global const uint *counts, __global const memory_real *values,
                                __global memory_real *partial, uint length, uint operation, RANGE)
{
  __local uint local_memory[REDUCE_ITEMS];
  reduce_real_tiles_group(counts, values, partial, length, operation, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void reduce_real_partials(__global const uint *counts, __global const memory_real *partial,
                                   __global memory_real *result, uint length, uint operation, RANGE)
{
  __local uint local_memory[REDUCE_ITEMS];
  reduce_real_partials_group(counts, partial, result, length, operation, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void compact_count(__global const uint *flags, __global uint *offsets, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  compact_count_item(flags, offsets, i);
}

__kernel void compact_write(__global const uint *flags, __global const uint *offsets, __global uint *indices, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  compact_write_item(flags, offsets, indices, i);
}

__kernel void compact_total(__global const uint *offsets, __global uint *counts, uint length, uint to, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  compact_total_item(offsets, counts, length, to, i);
}

__kernel void lower_bound(__global const uint *counts, __global const uint *sorted, __global const uint *queries,
                          __global uint *places, uint length, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  lower_bound_item(counts, sorted, queries, places, length, i);
}

__kernel void upper_bound(__global const uint *counts, __global const uint *sorted, __global const uint *queries,
                          __global uint *places, uint length, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  upper_bound_item(counts, sorted, queries, places, length, i);
}

__kernel void gather(__global const uint *values, __global const uint *indices, __global uint *result, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  gather_item(values, indices, result, i);
}

__kernel void scatter(__global const uint *values, __global const uint *indices, __global uint *result, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  scatter_item(values, indices, result, i);
}

__kernel void add_offset(__global uint *values, uint offset, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  add_offset_item(values, offset, i);
}

__kernel void difference(__global const uint *values, __global uint *result, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  difference_item(values, result, i);
}

__kernel void flip_float(__global uint *values, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  flip_float_item(values, i);
}

__kernel void unflip_float(__global uint *values, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  unflip_float_item(values, i);
}

__kernel void bitonic_tile(__global const uint *counts, __global uint *keys, __global uint *values, uint length,
                           uint whole, RANGE)
{
  __local uint local_memory[BITONIC_LOCAL_WORDS];
  bitonic_tile_group(counts, keys, values, length, whole, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void bitonic_step(__global const uint *counts, __global uint *keys, __global uint *values, uint length,
                           uint block, uint reach, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  bitonic_step_item(counts, keys, values, length, block, reach, i);
}
