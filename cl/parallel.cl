/* parallel.cl - entries: fills, copies, scans and sorts. */
#include "cl/entry.h"
#include "shared/parallel/fill.h"
#include "shared/parallel/radix_sort.h"
#include "shared/parallel/scan.h"

__kernel void fill(__global uint *values, uint value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  fill_item(values, value, i);
}

__kernel void copy(__global const uint *from, __global uint *to, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  copy_item(from, to, i);
}

__kernel void copy64(__global const ulong *from, __global ulong *to, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  copy64_item(from, to, i);
}

__kernel void scan_tiles(__global const uint *values, __global const uint *counts, __global uint *out,
                         __global uint *sums, uint length, uint level, uint from, uint to, RANGE)
{
  __local uint local_memory[SCAN_WORDS];
  scan_tiles_group(values, counts, out, sums, length, level, from, to, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void scan_add(__global const uint *counts, __global uint *out, __global const uint *sums, uint length,
                       uint level, uint from, uint to, RANGE)
{
  __local uint local_memory[1];
  scan_add_group(counts, out, sums, length, level, from, to, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void scan_total(__global const uint *counts, __global uint *out, __global const uint *sums,
                         uint length, uint to, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  scan_total_item(counts, out, sums, length, to, i);
}

__kernel void sort_length(__global uint *counts, uint length, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sort_length_item(counts, length, i);
}

__kernel void sort_histogram(__global const uint *keys, __global const uint *counts, __global uint *histogram,
                             uint length, uint shift, RANGE)
{
  __local uint local_memory[SORT_WORDS];
  sort_histogram_group(keys, counts, histogram, length, shift, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void sort_histogram64(__global const ulong *keys, __global const uint *counts,
                               __global uint *histogram, uint length, uint shift, RANGE)
{
  __local uint local_memory[SORT_WORDS];
  sort_histogram64_group(keys, counts, histogram, length, shift, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void sort_scatter(__global const uint *keys, __global const uint *values, __global const uint *counts,
                           __global const uint *histogram, __global uint *sorted_keys,
                           __global uint *sorted_values, uint length, uint shift, RANGE)
{
  __local uint local_memory[SORT_WORDS];
  sort_scatter_group(keys, values, counts, histogram, sorted_keys, sorted_values, length, shift, local_memory,
                     GROUP_NUMBER);
  END_GROUP;
}

__kernel void sort_scatter64(__global const ulong *keys, __global const uint *counts,
                             __global const uint *histogram, __global ulong *sorted_keys, uint length,
                             uint shift, RANGE)
{
  __local uint local_memory[SORT_WORDS];
  sort_scatter64_group(keys, counts, histogram, sorted_keys, length, shift, local_memory, GROUP_NUMBER);
  END_GROUP;
}
