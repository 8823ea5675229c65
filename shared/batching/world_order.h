/* world_order.h - the colour order of a batch of worlds of which some have overflow constraints.
 *
 * Such a world takes more passes over its colours than one that has none (host/pipeline/solvers/mass_split.h). Within
 * each colour its constraints come last, so that the passes that are its own run over the end of the colour:
 *
 *   colour      0            1         ..  overflow        o  of a world without overflow constraints
 *             o o o x x    o o x x x         x x           x  of one that has some
 *                   ^ WORLD_COLOR_START
 */
#ifndef TANDEM_SHARED_BATCHING_WORLD_ORDER_H
#define TANDEM_SHARED_BATCHING_WORLD_ORDER_H

#include "shared/argument_groups.h"
#include "shared/batching/order.h"

SHARED void note_world_overflow_item(read_world_pairs pairs, GLOBAL const uint *pair_color,
                                     GLOBAL uint *world_overflows, uint i)
{
  if (pair_color[i] == COLOR_OVERFLOW) ATOMIC_OR(world_overflows + pairs.world[2u * pairs.a[i]], 1u);
}

SHARED void world_color_keys_item(read_world_pairs pairs, GLOBAL const uint *pair_color,
                                  GLOBAL const uint *world_overflows, GLOBAL uint *sort_key, GLOBAL uint *sort_value,
                                  GLOBAL uint *pair_constraint, uint i)
{
  uint color = pair_color[i];
  sort_key[i] = color > COLOR_LIMIT ? color : 2u * color + world_overflows[pairs.world[2u * pairs.a[i]]];
  sort_value[i] = i;
  pair_constraint[i] = INDEX_NONE;
}

SHARED void world_color_starts_item(GLOBAL const uint *sort_key, GLOBAL uint *counts, uint color)
{
  uint pairs = counts[COUNT_PAIRS], start = first_not_below(sort_key, pairs, 2u * color),
       end = first_not_below(sort_key, pairs, 2u * color + 2u);
  store_color_range(counts, color, start, end);
  if (color < COLOR_LIMIT) counts[WORLD_COLOR_START + color] = first_not_below(sort_key, pairs, 2u * color + 1u);
}

#endif
