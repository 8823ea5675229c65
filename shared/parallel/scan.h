/* scan.h - exclusive prefix sum of any length: reduce tiles, scan the sums of tiles, add them back.
 *
 *   values   a b c d | e f g h | i j k l      level 0: each tile scanned on its own
 *   sums     (a+..+d)  (e+..+h)  (i+..+l)     level 1: the same over the sums, and so on upward
 *
 * Three levels cover 2^30 values. The length is read on the device. Blelloch, "Prefix Sums and Their
 * Applications", 1990. Sums wrap modulo 2^32.
 */
#ifndef TANDEM_SHARED_PARALLEL_SCAN_H
#define TANDEM_SHARED_PARALLEL_SCAN_H

#include "shared/platform.h"

#define SCAN_ITEMS 256u /* virtual items of a tile, each with TILE / SCAN_ITEMS values */
#define SCAN_CHUNKS 16u /* of the items' sums */
#define SCAN_WORDS (SCAN_ITEMS + 2u * SCAN_CHUNKS + 1u)

/* Values at a level: tiles of tiles of the length. */
SHARED uint length_at_level(uint length, uint level)
{
  for (uint k = 0; k < level; ++k) length = (length + TILE - 1u) / TILE;
  return length;
}

/* Exclusive scan of SCAN_ITEMS words of local memory; returns where the total stands. */
SHARED uint scan_items(LOCAL uint *words)
{
  LOCAL uint *chunks = words + SCAN_ITEMS, *offsets = chunks + SCAN_CHUNKS;
  FOR_EACH_ITEM(chunk, SCAN_CHUNKS)
  {
    uint sum = 0;
    for (uint k = 0; k < SCAN_ITEMS / SCAN_CHUNKS; ++k) {
      uint value = words[chunk * (SCAN_ITEMS / SCAN_CHUNKS) + k];
      words[chunk * (SCAN_ITEMS / SCAN_CHUNKS) + k] = sum;
      sum += value;
    }
    chunks[chunk] = sum;
  }
  FOR_EACH_ITEM(chunk, SCAN_CHUNKS + 1u)
  {
    uint sum = 0;
    for (uint k = 0; k < chunk; ++k) sum += chunks[k];
    offsets[chunk] = sum;
  }
  FOR_EACH_ITEM(item, SCAN_ITEMS) words[item] += offsets[item / (SCAN_ITEMS / SCAN_CHUNKS)];
  return SCAN_ITEMS + 2u * SCAN_CHUNKS;
}

/* values[from ..], at this level, scanned tile by tile into out[from ..]; totals of tiles into sums[to ..]. */
SHARED void scan_tiles_group(GLOBAL const uint *values, GLOBAL const uint *counts, GLOBAL uint *out, GLOBAL uint *sums, uint length, uint level,
                             uint from, uint to, LOCAL uint *local_memory, uint group)
{
  uint n = length_at_level(counts[length], level);
  FOR_EACH_ITEM(item, SCAN_ITEMS)
  {
    uint sum = 0, first = group * TILE + item * (TILE / SCAN_ITEMS);
    for (uint k = first; k < first + TILE / SCAN_ITEMS && k < n; ++k) sum += values[from + k];
    local_memory[item] = sum;
  }
  uint total = scan_items(local_memory);
  FOR_EACH_ITEM(item, SCAN_ITEMS)
  {
    uint sum = local_memory[item], first = group * TILE + item * (TILE / SCAN_ITEMS);
    for (uint k = first; k < first + TILE / SCAN_ITEMS && k < n; ++k) {
      uint value = values[from + k];
      out[from + k] = sum;
      sum += value;
    }
  }
  FOR_EACH_ITEM(only, 1u)
  if (group * TILE < n) sums[to + group + only] = local_memory[total];
}

SHARED void scan_add_group(GLOBAL const uint *counts, GLOBAL uint *out, GLOBAL const uint *sums, uint length, uint level, uint from, uint to,
                           LOCAL uint *local_memory, uint group)
{
  (void)local_memory;
  uint n = length_at_level(counts[length], level);
  FOR_EACH_ITEM(item, TILE)
  {
    uint k = group * TILE + item;
    if (k < n) out[from + k] += sums[to + group];
  }
}

/* The total, behind the last value. */
SHARED void scan_total_item(GLOBAL const uint *counts, GLOBAL uint *out, GLOBAL const uint *sums, uint length, uint to, uint i)
{
  (void)i;
  out[counts[length]] = counts[length] == 0u ? 0u : sums[to];
}

#endif
