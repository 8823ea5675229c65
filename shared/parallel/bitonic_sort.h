/* bitonic_sort.h - Batcher's bitonic sorting network ("Sorting Networks and Their Applications", 1968) for any length.
 *
 * Blocks of 2, 4, 8, .. items become sorted. Each merge begins by comparing an item with its mirror image in
 * the block, so that every comparison puts the smaller item first:
 *
 *   flip of a block of 8:  0-7 1-6 2-5 3-4     then strides 2 and 1:  0-2 1-3 4-6 5-7,  0-1 2-3 4-5 6-7
 *
 * Items past the end would be the largest and never move, so comparisons with them are left out and no padding is
 * needed. Pairs are ordered by key, then by value, so the result is unique.
 *
 * Within tiles of BITONIC_TILE the network runs in local memory (bitonic_tile). Wider comparisons run over the buffers,
 * with one launch each (bitonic_step).
 */
#ifndef TANDEM_SHARED_PARALLEL_BITONIC_SORT_H
#define TANDEM_SHARED_PARALLEL_BITONIC_SORT_H

#include "shared/parallel/length.h"
#include "shared/platform.h"

#define BITONIC_TILE 1024u
#define BITONIC_LOCAL_WORDS (2u * BITONIC_TILE)

/* The item that item i is compared with, or i itself if i is the second of its pair. block 0: the partner is at a
 * stride of `reach`; else it is the mirror image in the block. */
SHARED uint bitonic_partner(uint i, uint block, uint reach)
{
  const uint partner = block == 0u ? i ^ reach : i ^ (block - 1u);
  return partner > i ? partner : i;
}

SHARED int comes_after(uint key_a, uint value_a, uint key_b, uint value_b)
{
  return key_a > key_b || (key_a == key_b && value_a > value_b);
}

/* Makes one step of comparisons over a whole tile in local memory. */
SHARED void bitonic_compare(LOCAL uint *keys, LOCAL uint *values, uint count, uint block, uint reach)
{
  FOR_EACH_ITEM(i, count)
  {
    const uint partner = bitonic_partner(i, block, reach);
    if (partner != i && partner < count && comes_after(keys[i], values[i], keys[partner], values[partner])) {
      const uint key = keys[i], value = values[i];
      keys[i] = keys[partner];
      values[i] = values[partner];
      keys[partner] = key;
      values[partner] = value;
    }
  }
}

/* Sorts tile `group` (whole 1), or ends a merge whose wider strides are done (whole 0). */
SHARED void bitonic_tile_group(GLOBAL const uint *counts, GLOBAL uint *keys, GLOBAL uint *values, uint length,
                               uint whole, LOCAL uint *local_memory, uint group)
{
  const uint count = items_in_tile(counts[length], BITONIC_TILE, group), first = group * BITONIC_TILE;
  LOCAL uint *tile_keys = local_memory, *tile_values = local_memory + BITONIC_TILE;
  if (count == 0u) return;
  FOR_EACH_ITEM(i, count)
  {
    tile_keys[i] = keys[first + i];
    tile_values[i] = values[first + i];
  }
  /* One loop makes all comparisons, and no condition guards it, because PoCL 3.1 requires this of a loop over
   * phases. */
  const uint last_block = whole != 0u ? BITONIC_TILE : 2u * BITONIC_TILE;
  uint block = whole != 0u ? 2u : last_block, reach = whole != 0u ? 1u : block / 4u;
  do {
    bitonic_compare(tile_keys, tile_values, count, reach == block / 2u ? block : 0u, reach);
    reach /= 2u;
    block = reach == 0u ? 2u * block : block;
    reach = reach == 0u ? block / 2u : reach;
  } while (block <= last_block);
  FOR_EACH_ITEM(i, count)
  {
    keys[first + i] = tile_keys[i];
    values[first + i] = tile_values[i];
  }
}

SHARED void bitonic_step_item(GLOBAL const uint *counts, GLOBAL uint *keys, GLOBAL uint *values, uint length,
                              uint block, uint reach, uint i)
{
  const uint partner = bitonic_partner(i, block, reach);
  if (partner == i || partner >= counts[length]) return;
  const uint key = keys[i], value = values[i], other_key = keys[partner], other_value = values[partner];
  if (!comes_after(key, value, other_key, other_value)) return;
  keys[i] = other_key;
  values[i] = other_value;
  keys[partner] = key;
  values[partner] = value;
}

#endif
