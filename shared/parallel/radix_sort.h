/* radix_sort.h - stable least-significant-digit radix sort, four bits a pass.
 *
 * Each pass: count the digits of every tile, scan the counts digit by digit over all tiles, write each key
 * to its place. Within a tile, SORT_ITEMS virtual items own runs of consecutive keys and counters of their
 * own, so ranks need no atomics and the sort is stable whatever the group size:
 *
 *     counters      item 0  item 1  ...        scanned in this order: down the items, then the digits
 *     digit 0         2       1                gives each item the rank of its first key of that digit
 *     digit 1         0       3
 *
 * After Satish, Harris and Garland, "Designing Efficient Sorting Algorithms for Manycore GPUs", 2009.
 */
#ifndef TANDEM_SHARED_PARALLEL_RADIX_SORT_H
#define TANDEM_SHARED_PARALLEL_RADIX_SORT_H

#include "shared/counts.h"
#include "shared/platform.h"

#define SORT_BITS 4u
#define SORT_DIGITS 16u
#define SORT_ITEMS 128u
#define SORT_KEYS (TILE / SORT_ITEMS) /* of one virtual item */
#define SORT_WORDS (SORT_DIGITS * SORT_ITEMS + 2u * SORT_DIGITS)

SHARED uint digit32(uint key, uint shift) { return (key >> shift) & (SORT_DIGITS - 1u); }
SHARED uint digit64(ulong key, uint shift) { return (uint)(key >> shift) & (SORT_DIGITS - 1u); }

/* Length of the histogram of a sort, for the scan over it. */
SHARED void sort_length_item(GLOBAL uint *counts, uint length, uint i)
{
  (void)i;
  counts[COUNT_HISTOGRAM] = (counts[length] + TILE - 1u) / TILE * SORT_DIGITS;
}

/* One function of the key type each; the bodies differ in nothing else. */
#define SORT_COUNT_DIGITS(DIGIT)                                                           \
  FOR_EACH_ITEM(item, SORT_ITEMS)                                                          \
  {                                                                                        \
    for (uint digit = 0; digit < SORT_DIGITS; ++digit) local_memory[digit * SORT_ITEMS + item] = 0u; \
    uint first = group * TILE + item * SORT_KEYS;                                          \
    for (uint k = first; k < first + SORT_KEYS && k < n; ++k) ++local_memory[DIGIT(keys[k], shift) * SORT_ITEMS + item]; \
  }

/* Each digit's counters become ranks; its total goes behind them. */
SHARED void rank_digits(LOCAL uint *counters)
{
  FOR_EACH_ITEM(digit, SORT_DIGITS)
  {
    uint sum = 0;
    for (uint item = 0; item < SORT_ITEMS; ++item) {
      uint count = counters[digit * SORT_ITEMS + item];
      counters[digit * SORT_ITEMS + item] = sum;
      sum += count;
    }
    counters[SORT_DIGITS * SORT_ITEMS + digit] = sum;
  }
}

#define SORT_WRITE_HISTOGRAM                                                                \
  {                                                                                         \
    uint tiles = (n + TILE - 1u) / TILE;                                                    \
    rank_digits(local_memory);                                                              \
    FOR_EACH_ITEM(digit, SORT_DIGITS)                                                       \
    if (group < tiles) histogram[digit * tiles + group] = local_memory[SORT_DIGITS * SORT_ITEMS + digit]; \
  }

SHARED void sort_histogram_group(GLOBAL const uint *keys, GLOBAL const uint *counts, GLOBAL uint *histogram, uint length, uint shift,
                                 LOCAL uint *local_memory, uint group)
{
  uint n = counts[length];
  SORT_COUNT_DIGITS(digit32)
  SORT_WRITE_HISTOGRAM
}

SHARED void sort_histogram64_group(GLOBAL const ulong *keys, GLOBAL const uint *counts, GLOBAL uint *histogram, uint length, uint shift,
                                   LOCAL uint *local_memory, uint group)
{
  uint n = counts[length];
  SORT_COUNT_DIGITS(digit64)
  SORT_WRITE_HISTOGRAM
}

/* Calls PUT(k, place) for every key of the tile, k in order within an item. */
#define SORT_SCATTER(DIGIT, PUT)                                                            \
  {                                                                                         \
    uint tiles = (n + TILE - 1u) / TILE;                                                    \
    rank_digits(local_memory);                                                              \
    FOR_EACH_ITEM(item, SORT_ITEMS)                                                         \
    {                                                                                       \
      uint first = group * TILE + item * SORT_KEYS;                                         \
      for (uint k = first; k < first + SORT_KEYS && k < n; ++k) {                           \
        uint digit = DIGIT(keys[k], shift);                                                 \
        uint place = histogram[digit * tiles + group] + local_memory[digit * SORT_ITEMS + item]++; \
        PUT                                                                                 \
      }                                                                                     \
    }                                                                                       \
  }

SHARED void sort_scatter_group(GLOBAL const uint *keys, GLOBAL const uint *values, GLOBAL const uint *counts, GLOBAL const uint *histogram,
                               GLOBAL uint *sorted_keys, GLOBAL uint *sorted_values, uint length, uint shift, LOCAL uint *local_memory,
                               uint group)
{
  uint n = counts[length];
  SORT_COUNT_DIGITS(digit32)
  SORT_SCATTER(digit32, { sorted_keys[place] = keys[k]; sorted_values[place] = values[k]; })
}

SHARED void sort_scatter64_group(GLOBAL const ulong *keys, GLOBAL const uint *counts, GLOBAL const uint *histogram, GLOBAL ulong *sorted_keys,
                                 uint length, uint shift, LOCAL uint *local_memory, uint group)
{
  uint n = counts[length];
  SORT_COUNT_DIGITS(digit64)
  SORT_SCATTER(digit64, { sorted_keys[place] = keys[k]; })
}

SHARED void copy_item(GLOBAL const uint *from, GLOBAL uint *to, uint i) { to[i] = from[i]; }
SHARED void copy64_item(GLOBAL const ulong *from, GLOBAL ulong *to, uint i) { to[i] = from[i]; }

#endif
