/* list_pairs.h - the kernels that sort pairs by kind; pair_lists.h explains why they are sorted.
 *
 * A tile is cut into chunks of consecutive pairs, so that pairs of equal kind keep their order without an atomic. Sums
 * along the rows, then down, give the place of a chunk's pairs within the tile:
 *
 *            chunk 0   chunk 1   chunk 2 ..
 *   kind 0     3         0         1         ->
 *   kind 1     5         8         7
 */
#ifndef TANDEM_SHARED_NARROWPHASE_LIST_PAIRS_H
#define TANDEM_SHARED_NARROWPHASE_LIST_PAIRS_H

#include "shared/narrowphase/pair_lists.h"
#include "shared/parallel/length.h"

#define LIST_STRIPS CHUNKS(128u)
#define LIST_STRIP (TILE / LIST_STRIPS)
/* The kinds, and one more list for the pairs of no kind. */
#define LISTS ((uint)PAIR_KIND_NONE + 1u)
#define LIST_LOCAL_WORDS (((uint)PAIR_KIND_NONE + 1u) * 128u)

/* kinds: of each pair (far_pairs.h). kind_counts[kind * tiles + tile]: the number of pairs of that kind in the tile. */
SHARED void count_pair_kinds_group(GLOBAL const uint *counts, GLOBAL const uint *kinds, GLOBAL uint *kind_counts,
                                   LOCAL uint *local_memory, uint group)
{
  const uint n = counts[COUNT_PAIRS], count = items_in_tile(n, TILE, group), tiles = units_of(n, TILE);
  if (count == 0u) return;
  FOR_EACH_ITEM(kind, LISTS) local_memory[kind] = 0u;
  FOR_EACH_ITEM(k, count) LOCAL_ADD(local_memory + kinds[group * TILE + k], 1u);
  FOR_EACH_ITEM(kind, LISTS) kind_counts[kind * tiles + group] = local_memory[kind];
}

/* kind_places: the same table after the scan. The pairs of no kind follow the last list. */
SHARED void start_pair_lists_item(GLOBAL const uint *kind_places, GLOBAL uint *counts, uint i)
{
  const uint n = counts[COUNT_PAIRS], tiles = units_of(n, TILE);
  (void)i;
  for (uint kind = 0u; kind < LISTS; ++kind) counts[KIND_START + kind] = n > 0u ? kind_places[kind * tiles] : 0u;
}

/* chunks: the number of pairs of each kind in a chunk. The CPU has a single chunk, which starts where the tile does and
 * needs no counts. */
SHARED void count_strips(GLOBAL const uint *kinds, uint first, uint count, LOCAL uint *chunks)
{
  FOR_EACH_ITEM(k, LISTS * LIST_STRIPS) chunks[k] = 0u;
  if (LIST_STRIPS == 1u) return;
  FOR_EACH_ITEM(s, LIST_STRIPS)
  {
    for (uint k = s * LIST_STRIP; k < (s + 1u) * LIST_STRIP && k < count; ++k)
      ++chunks[kinds[first + k] * LIST_STRIPS + s];
  }
}

SHARED void list_pairs_group(GLOBAL const uint *counts, GLOBAL const uint *kinds, GLOBAL const uint *kind_places,
                             GLOBAL uint *pair_of_kind, LOCAL uint *local_memory, uint group)
{
  const uint n = counts[COUNT_PAIRS], first = group * TILE, count = items_in_tile(n, TILE, group);
  const uint tiles = units_of(n, TILE);
  if (count == 0u) return;
  count_strips(kinds, first, count, local_memory);
  FOR_EACH_ITEM(kind, LISTS)
  {
    uint place = kind_places[kind * tiles + group];
    for (uint s = 0u; s < LIST_STRIPS; ++s) {
      const uint pairs_of_strip = local_memory[kind * LIST_STRIPS + s];
      local_memory[kind * LIST_STRIPS + s] = place;
      place += pairs_of_strip;
    }
  }
  FOR_EACH_ITEM(s, LIST_STRIPS)
  {
    for (uint k = s * LIST_STRIP; k < (s + 1u) * LIST_STRIP && k < count; ++k)
      pair_of_kind[local_memory[kinds[first + k] * LIST_STRIPS + s]++] = first + k;
  }
}

#endif
