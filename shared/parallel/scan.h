/* scan.h - exclusive prefix sum of uint, at most 2^32 - 1: result[i] = values[0] + .. + values[i - 1], result[n] =
 * total.
 *
 * Every "count, scan, write" of the pipeline uses it. No stage appends by an atomic counter, so no order depends on
 * scheduling. It takes three launches for any length (reduce, then scan; Merrill and Grimshaw, "Parallel Scan for
 * Stream Architectures", 2009):
 *
 *   values       | tile 0 | tile 1 | tile 2 | ..      SCAN_TILE items each
 *   scan_reduce    s0       s1       s2               one group a tile: sums
 *   scan_in_order  0        s0       s0+s1            one group: sums of all tiles before
 *   scan_tiles   | 0 a ab | ...                       one group a tile: values again, plus the tile's start
 *
 * values and result may be the same buffer. Sums saturate at 2^32 - 1, so that a stage cannot take an overflow for a
 * small number.
 */
#ifndef TANDEM_SHARED_PARALLEL_SCAN_H
#define TANDEM_SHARED_PARALLEL_SCAN_H

#include "shared/parallel/length.h"
#include "shared/platform.h"

#define SCAN_TILE 4096u
#define SCAN_CHUNKS CHUNKS(256u)

/* The chunks of small tables: each of SMALL_CHUNKS items runs over one. */
#define SMALL_CHUNKS CHUNKS(32u)

/* The layout of local memory, in words: the tile, spread so that chunks start in different banks; sums of chunks. */
#define SCAN_SPREAD(i) ((i) + (i) / 16u)
#define SCAN_SUMS_AT (SCAN_TILE + SCAN_TILE / 16u)
#define SCAN_SMALL_AT (SCAN_SUMS_AT + 256u)
#define SCAN_LOCAL_WORDS (SCAN_SMALL_AT + 64u)

/* Replaces n values in local memory by their exclusive sums, and stores the total in scratch[SMALL_CHUNKS]. n is a
 * multiple of SMALL_CHUNKS; scratch holds SMALL_CHUNKS + 1 words. */
SHARED void scan_small(LOCAL uint *values, uint n, LOCAL uint *scratch)
{
  const uint chunk = n / SMALL_CHUNKS;
  FOR_EACH_ITEM(s, SMALL_CHUNKS)
  {
    uint sum = 0u;
    for (uint k = s * chunk; k < (s + 1u) * chunk; ++k) sum = saturated_sum(sum, values[k]);
    scratch[s] = sum;
  }
  FOR_EACH_ITEM(s, SMALL_CHUNKS)
  {
    uint sum = 0u;
    for (uint k = 0u; k < s; ++k) sum = saturated_sum(sum, scratch[k]);
    for (uint k = s * chunk; k < (s + 1u) * chunk; ++k) {
      const uint value = values[k];
      values[k] = sum;
      sum = saturated_sum(sum, value);
    }
    if (s == SMALL_CHUNKS - 1u) scratch[SMALL_CHUNKS] = sum;
  }
}

/* The items of a chunk, so that few items take little time. */
SHARED uint scan_chunk(uint count) { return units_of(count, SCAN_CHUNKS); }

/* Loads the first `count` items of a tile and stores, for each chunk, the sum of the chunks before it. The tile's total
 * goes to local_memory[SCAN_SMALL_AT + SMALL_CHUNKS]. Items past `count` are 0. */
SHARED void scan_load(GLOBAL const uint *values, uint first, uint count, LOCAL uint *local_memory)
{
  const uint chunk = scan_chunk(count);
  LOCAL uint *sums = local_memory + SCAN_SUMS_AT;
  FOR_EACH_ITEM(i, SCAN_CHUNKS * chunk) local_memory[SCAN_SPREAD(i)] = i < count ? values[first + i] : 0u;
  FOR_EACH_ITEM(s, SCAN_CHUNKS)
  {
    uint sum = 0u;
    for (uint i = s * chunk; i < (s + 1u) * chunk; ++i)
      sum = saturated_sum(sum, local_memory[SCAN_SPREAD(i)]);
    sums[s] = sum;
  }
  scan_small(sums, SCAN_CHUNKS, local_memory + SCAN_SMALL_AT);
}

/* Turns the loaded tile into exclusive sums that start at `start`, and writes them. */
SHARED void scan_store(GLOBAL uint *result, uint first, uint count, uint start, LOCAL uint *local_memory)
{
  const uint chunk = scan_chunk(count);
  LOCAL const uint *sums = local_memory + SCAN_SUMS_AT;
  FOR_EACH_ITEM(s, SCAN_CHUNKS)
  {
    uint sum = saturated_sum(start, sums[s]);
    for (uint i = s * chunk; i < (s + 1u) * chunk; ++i) {
      const uint value = local_memory[SCAN_SPREAD(i)];
      local_memory[SCAN_SPREAD(i)] = sum;
      sum = saturated_sum(sum, value);
    }
  }
  FOR_EACH_ITEM(i, count) result[first + i] = local_memory[SCAN_SPREAD(i)];
}

/* sums[group] = the sum of tile `group`. */
SHARED void scan_reduce_group(GLOBAL const uint *counts, GLOBAL const uint *values, GLOBAL uint *sums, uint length,
                              uint unit, uint per_unit, LOCAL uint *local_memory, uint group)
{
  const uint words = units_of(counts[length], unit) * per_unit;
  const uint count = items_in_tile(words, SCAN_TILE, group);
  const uint first = group * SCAN_TILE;
  if (count == 0u) return;
  FOR_EACH_ITEM(s, SCAN_CHUNKS)
  {
    uint sum = 0u;
    for (uint i = s; i < count; i += SCAN_CHUNKS) sum = saturated_sum(sum, values[first + i]);
    local_memory[s] = sum;
  }
  for (uint width = SCAN_CHUNKS / 2u; width > 0u; width /= 2u)
    FOR_EACH_ITEM(s, width) local_memory[s] = saturated_sum(local_memory[s], local_memory[s + width]);
  FOR_EACH_ITEM(s, 1u) sums[group] = local_memory[0];
}

/* One group writes the exclusive sums of the first ceil(words / block) values, tile after tile; total[words] = their
 * sum. */
SHARED void scan_in_order_group(GLOBAL const uint *counts, GLOBAL const uint *values, GLOBAL uint *result,
                                GLOBAL uint *total, uint length, uint unit, uint per_unit, uint block,
                                LOCAL uint *local_memory, uint group)
{
  const uint words = units_of(counts[length], unit) * per_unit;
  const uint n = units_of(words, block);
  LOCAL uint *carry = local_memory + SCAN_SMALL_AT + 48u; /* sum of the tiles before an even, an odd tile */
  if (group != 0u) return;
  FOR_EACH_ITEM(s, 1u) carry[0] = 0u;
  for (uint tile = 0u; tile < units_of(n, SCAN_TILE); ++tile) {
    const uint count = items_in_tile(n, SCAN_TILE, tile);
    scan_load(values, tile * SCAN_TILE, count, local_memory);
    FOR_EACH_ITEM(s, SCAN_CHUNKS)
    local_memory[SCAN_SUMS_AT + s] = saturated_sum(local_memory[SCAN_SUMS_AT + s], carry[tile & 1u]);
    FOR_EACH_ITEM(s, 1u)
    carry[(tile + 1u) & 1u] = saturated_sum(carry[tile & 1u], local_memory[SCAN_SMALL_AT + SMALL_CHUNKS]);
    scan_store(result, tile * SCAN_TILE, count, 0u, local_memory);
  }
  FOR_EACH_ITEM(s, 1u) total[words] = carry[units_of(n, SCAN_TILE) & 1u];
}

/* Writes the exclusive sums of tile `group`, which start at sums[group]. */
SHARED void scan_tiles_group(GLOBAL const uint *counts, GLOBAL const uint *values, GLOBAL const uint *sums,
                             GLOBAL uint *result, uint length, uint unit, uint per_unit, LOCAL uint *local_memory,
                             uint group)
{
  const uint words = units_of(counts[length], unit) * per_unit;
  const uint count = items_in_tile(words, SCAN_TILE, group);
  if (count == 0u) return;
  scan_load(values, group * SCAN_TILE, count, local_memory);
  scan_store(result, group * SCAN_TILE, count, sums[group], local_memory);
}

#endif
