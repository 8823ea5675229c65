/* radix_sort.h - stable radix sort of 32- and 64-bit keys, alone or with 32-bit values, 8 bits a pass.
 *
 * Each pass (Satish, Harris and Garland, Designing Efficient Sorting Algorithms for Manycore GPUs, 2009) is
 *
 *   sort_histogram   histogram[digit * tiles + tile] = keys of the tile with that digit
 *   scan             the same table then says where each tile's keys of a digit go
 *   sort_scatter     one group a tile: sort the tile by the digit in local memory, write runs of equal digits
 *
 * Keys are ranked within a tile by chunks of consecutive keys. Each chunk counts its digits in a column of its own, so
 * no atomic is needed and equal keys keep their order:
 *
 *            chunk 0   chunk 1   chunk 2 ..
 *   digit 0    3         0         1      -> sums along the row: keys of this digit in the chunks before
 *   digit 1    0         2         2      -> sums down the totals of rows: smaller digits in the tile
 *
 * The rank of a key in its tile is the sum: smaller digits + equal digits in earlier chunks + earlier ones in its
 * chunk.
 *
 * A single thread needs no ranks, because it meets the keys in their order: it writes each of them to the next place of
 * its digit (sort_starts_alone).
 */
#ifndef TANDEM_SHARED_PARALLEL_RADIX_SORT_H
#define TANDEM_SHARED_PARALLEL_RADIX_SORT_H

#include "shared/parallel/length.h"
#include "shared/parallel/scan.h"
#include "shared/platform.h"

#define SORT_TILE 2048u
#define SORT_BITS 8u
#define SORT_DIGITS 256u
#define SORT_CHUNKS CHUNKS(32u)
#define SORT_CHUNK (SORT_TILE / SORT_CHUNKS)

/* The layout of local memory, in words. Keys and values later pass through the words that held the counts of chunks. */
#define SORT_RANKS_AT 0u /* a word a key, spread over banks: digit and rank, then place */
#define SORT_SPREAD(i) ((i) + (i) / 64u)
#define SORT_COUNTS_AT (SORT_TILE + SORT_TILE / 64u) /* a half_word a digit and chunk; then the tile, sorted */
#define SORT_DIGITS_AT (SORT_COUNTS_AT + 4096u)      /* a byte a key: its digit, in the new order */
#define SORT_STARTS_AT (SORT_DIGITS_AT + SORT_TILE / 4u) /* a word a digit: smaller digits in the tile */
#define SORT_BASES_AT (SORT_STARTS_AT + SORT_DIGITS) /* a word a digit: place in the result, less place in the tile */
#define SORT_SCRATCH_AT (SORT_BASES_AT + SORT_DIGITS)
#define SORT_LOCAL_WORDS (SORT_SCRATCH_AT + 64u)

SHARED uint sort_digit(uint key, uint shift, uint bits) { return (key >> shift) & ((1u << bits) - 1u); }
SHARED uint sort_digit64(ulong key, uint shift, uint bits) { return (uint)(key >> shift) & ((1u << bits) - 1u); }

/* Rows are rotated so that neither a row nor a column falls into one bank. */
SHARED uint sort_count_at(uint digit, uint chunk)
{
  return digit * SORT_CHUNKS + ((chunk + (digit & ~1u)) & (SORT_CHUNKS - 1u));
}

SHARED void sort_histogram_clear(LOCAL uint *counters) { FOR_EACH_ITEM(d, SORT_DIGITS) counters[d] = 0u; }

SHARED void sort_histogram_store(LOCAL const uint *counters, GLOBAL uint *histogram, uint n, uint bits, uint group)
{
  const uint tiles = units_of(n, SORT_TILE);
  FOR_EACH_ITEM(d, 1u << bits) histogram[d * tiles + group] = counters[d];
}

SHARED void sort_histogram_group(GLOBAL const uint *counts, GLOBAL const uint *keys, GLOBAL uint *histogram,
                                 uint length, uint shift, uint bits, LOCAL uint *local_memory, uint group)
{
  const uint n = counts[length], count = items_in_tile(n, SORT_TILE, group), first = group * SORT_TILE;
  if (count == 0u) return;
  sort_histogram_clear(local_memory);
  FOR_EACH_ITEM(i, count) LOCAL_ADD(local_memory + sort_digit(keys[first + i], shift, bits), 1u);
  sort_histogram_store(local_memory, histogram, n, bits, group);
}

SHARED void sort_histogram64_group(GLOBAL const uint *counts, GLOBAL const ulong *keys, GLOBAL uint *histogram,
                                   uint length, uint shift, uint bits, LOCAL uint *local_memory, uint group)
{
  const uint n = counts[length], count = items_in_tile(n, SORT_TILE, group), first = group * SORT_TILE;
  if (count == 0u) return;
  sort_histogram_clear(local_memory);
  FOR_EACH_ITEM(i, count) LOCAL_ADD(local_memory + sort_digit64(keys[first + i], shift, bits), 1u);
  sort_histogram_store(local_memory, histogram, n, bits, group);
}

/* Counts the digits of each chunk; ranks: from a key's digit to (digit << 16 | earlier equal digits in its chunk). */
SHARED void sort_count_chunks(uint count, LOCAL uint *local_memory)
{
  LOCAL uint *ranks = local_memory + SORT_RANKS_AT, *words = local_memory + SORT_COUNTS_AT;
  LOCAL half_word *counters = (LOCAL half_word *)words;
  FOR_EACH_ITEM(i, (SORT_DIGITS * SORT_CHUNKS + 1u) / 2u) words[i] = 0u;
  FOR_EACH_ITEM(s, SORT_CHUNKS)
  {
    const uint end = (s + 1u) * SORT_CHUNK < count ? (s + 1u) * SORT_CHUNK : count;
    for (uint i = s * SORT_CHUNK; i < end; ++i) {
      const uint digit = ranks[SORT_SPREAD(i)], at = sort_count_at(digit, s), rank = counters[at];
      counters[at] = (half_word)(rank + 1u);
      ranks[SORT_SPREAD(i)] = digit << 16 | rank;
    }
  }
}

/* Turns the counts into sums over earlier chunks and over smaller digits. */
SHARED void sort_scan_chunks(LOCAL uint *local_memory)
{
  LOCAL half_word *counters = (LOCAL half_word *)(local_memory + SORT_COUNTS_AT);
  LOCAL uint *starts = local_memory + SORT_STARTS_AT;
  FOR_EACH_ITEM(d, SORT_DIGITS)
  {
    uint sum = 0u;
    for (uint s = 0u; s < SORT_CHUNKS; ++s) {
      const uint at = sort_count_at(d, s), value = counters[at];
      counters[at] = (half_word)sum;
      sum += value;
    }
    starts[d] = sum;
  }
  scan_small(starts, SORT_DIGITS, local_memory + SORT_SCRATCH_AT);
}

/* Turns the digits of a tile's keys into each key's place in the sorted tile and each digit's place in the result. */
SHARED void sort_rank_tile(GLOBAL const uint *offsets, uint n, uint count, uint bits, LOCAL uint *local_memory,
                           uint group)
{
  const uint tiles = units_of(n, SORT_TILE);
  LOCAL uint *ranks = local_memory + SORT_RANKS_AT, *bases = local_memory + SORT_BASES_AT;
  LOCAL const uint *starts = local_memory + SORT_STARTS_AT;
  LOCAL const half_word *counters = (LOCAL const half_word *)(local_memory + SORT_COUNTS_AT);
  LOCAL unsigned char *digits = (LOCAL unsigned char *)(local_memory + SORT_DIGITS_AT);
  sort_count_chunks(count, local_memory);
  sort_scan_chunks(local_memory);
  FOR_EACH_ITEM(d, 1u << bits) bases[d] = offsets[d * tiles + group] - starts[d];
  FOR_EACH_ITEM(i, count)
  {
    const uint digit = ranks[SORT_SPREAD(i)] >> 16, rank = ranks[SORT_SPREAD(i)] & 0xffffu;
    const uint place = starts[digit] + counters[sort_count_at(digit, i / SORT_CHUNK)] + rank;
    ranks[SORT_SPREAD(i)] = place;
    digits[place] = (unsigned char)digit;
  }
}

SHARED uint sort_target(LOCAL const uint *local_memory, uint place)
{
  LOCAL const unsigned char *digits = (LOCAL const unsigned char *)(local_memory + SORT_DIGITS_AT);
  return local_memory[SORT_BASES_AT + digits[place]] + place;
}

/* Moves one word of each item of the tile through local memory, so that neighbours in the result are written
 * together. */
SHARED void sort_move(GLOBAL const uint *from, GLOBAL uint *to, uint first, uint count, LOCAL uint *local_memory)
{
  LOCAL uint *sorted = local_memory + SORT_COUNTS_AT;
  FOR_EACH_ITEM(i, count) sorted[local_memory[SORT_RANKS_AT + SORT_SPREAD(i)]] = from[first + i];
  FOR_EACH_ITEM(place, count) to[sort_target(local_memory, place)] = sorted[place];
}

SHARED void sort_move64(GLOBAL const ulong *from, GLOBAL ulong *to, uint first, uint count, LOCAL uint *local_memory)
{
  LOCAL uint *sorted = local_memory + SORT_COUNTS_AT;
  FOR_EACH_ITEM(i, count)
  {
    const uint place = local_memory[SORT_RANKS_AT + SORT_SPREAD(i)];
    sorted[place] = (uint)from[first + i];
    sorted[SORT_TILE + place] = (uint)(from[first + i] >> 32);
  }
  FOR_EACH_ITEM(place, count)
  to[sort_target(local_memory, place)] = (ulong)sorted[SORT_TILE + place] << 32 | sorted[place];
}

SHARED void sort_place(GLOBAL const uint *keys, GLOBAL const uint *offsets, uint n, uint count, uint shift, uint bits,
                       LOCAL uint *local_memory, uint group)
{
  FOR_EACH_ITEM(i, count)
  local_memory[SORT_RANKS_AT + SORT_SPREAD(i)] = sort_digit(keys[group * SORT_TILE + i], shift, bits);
  sort_rank_tile(offsets, n, count, bits, local_memory, group);
}

SHARED void sort_place64(GLOBAL const ulong *keys, GLOBAL const uint *offsets, uint n, uint count, uint shift,
                         uint bits, LOCAL uint *local_memory, uint group)
{
  FOR_EACH_ITEM(i, count)
  local_memory[SORT_RANKS_AT + SORT_SPREAD(i)] = sort_digit64(keys[group * SORT_TILE + i], shift, bits);
  sort_rank_tile(offsets, n, count, bits, local_memory, group);
}

/* Whether one thread sorts a tile alone. */
#define SORTS_ALONE (SORT_CHUNKS == 1u)

/* starts: where the next key of each digit goes. */
SHARED void sort_starts_alone(GLOBAL const uint *offsets, uint n, uint bits, LOCAL uint *starts, uint group)
{
  const uint tiles = units_of(n, SORT_TILE);
  for (uint d = 0u; d < 1u << bits; ++d) starts[d] = offsets[d * tiles + group];
}

SHARED void sort_scatter_group(GLOBAL const uint *counts, GLOBAL const uint *keys, GLOBAL const uint *offsets,
                               GLOBAL uint *sorted_keys, uint length, uint shift, uint bits, LOCAL uint *local_memory,
                               uint group)
{
  const uint n = counts[length], count = items_in_tile(n, SORT_TILE, group);
  if (count == 0u) return;
  if (SORTS_ALONE) {
    sort_starts_alone(offsets, n, bits, local_memory, group);
    for (uint i = group * SORT_TILE; i < group * SORT_TILE + count; ++i)
      sorted_keys[local_memory[sort_digit(keys[i], shift, bits)]++] = keys[i];
    return;
  }
  sort_place(keys, offsets, n, count, shift, bits, local_memory, group);
  sort_move(keys, sorted_keys, group * SORT_TILE, count, local_memory);
}

SHARED void sort_scatter_pairs_group(GLOBAL const uint *counts, GLOBAL const uint *keys, GLOBAL const uint *values,
                                     GLOBAL const uint *offsets, GLOBAL uint *sorted_keys, GLOBAL uint *sorted_values,
                                     uint length, uint shift, uint bits, LOCAL uint *local_memory, uint group)
{
  const uint n = counts[length], count = items_in_tile(n, SORT_TILE, group);
  if (count == 0u) return;
  if (SORTS_ALONE) {
    sort_starts_alone(offsets, n, bits, local_memory, group);
    for (uint i = group * SORT_TILE; i < group * SORT_TILE + count; ++i) {
      const uint place = local_memory[sort_digit(keys[i], shift, bits)]++;
      sorted_keys[place] = keys[i];
      sorted_values[place] = values[i];
    }
    return;
  }
  sort_place(keys, offsets, n, count, shift, bits, local_memory, group);
  sort_move(keys, sorted_keys, group * SORT_TILE, count, local_memory);
  sort_move(values, sorted_values, group * SORT_TILE, count, local_memory);
}

SHARED void sort_scatter64_group(GLOBAL const uint *counts, GLOBAL const ulong *keys, GLOBAL const uint *offsets,
                                 GLOBAL ulong *sorted_keys, uint length, uint shift, uint bits,
                                 LOCAL uint *local_memory, uint group)
{
  const uint n = counts[length], count = items_in_tile(n, SORT_TILE, group);
  if (count == 0u) return;
  if (SORTS_ALONE) {
    sort_starts_alone(offsets, n, bits, local_memory, group);
    for (uint i = group * SORT_TILE; i < group * SORT_TILE + count; ++i)
      sorted_keys[local_memory[sort_digit64(keys[i], shift, bits)]++] = keys[i];
    return;
  }
  sort_place64(keys, offsets, n, count, shift, bits, local_memory, group);
  sort_move64(keys, sorted_keys, group * SORT_TILE, count, local_memory);
}

SHARED void sort_scatter64_pairs_group(GLOBAL const uint *counts, GLOBAL const ulong *keys, GLOBAL const uint *values,
                                       GLOBAL const uint *offsets, GLOBAL ulong *sorted_keys,
                                       GLOBAL uint *sorted_values, uint length, uint shift, uint bits,
                                       LOCAL uint *local_memory, uint group)
{
  const uint n = counts[length], count = items_in_tile(n, SORT_TILE, group);
  if (count == 0u) return;
  if (SORTS_ALONE) {
    sort_starts_alone(offsets, n, bits, local_memory, group);
    for (uint i = group * SORT_TILE; i < group * SORT_TILE + count; ++i) {
      const uint place = local_memory[sort_digit64(keys[i], shift, bits)]++;
      sorted_keys[place] = keys[i];
      sorted_values[place] = values[i];
    }
    return;
  }
  sort_place64(keys, offsets, n, count, shift, bits, local_memory, group);
  sort_move64(keys, sorted_keys, group * SORT_TILE, count, local_memory);
  sort_move(values, sorted_values, group * SORT_TILE, count, local_memory);
}

#endif
