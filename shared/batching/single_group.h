/* single_group.h - the naive batching of the talks: one work-group does it all (GS-4150 slide 27, 2009 talk).
 *
 * The 2009 kernel kSetupBatches let the work-items of one compute unit take their turn in the order of the list, with a
 * barrier between two turns. Here the list is walked tile after tile; within a tile a contact takes the lowest colour
 * free at both bodies as soon as no earlier contact of the tile that shares a body is without one:
 *
 *   tile     |  e0   e1   e2   e3  ..|        round 1: e0 and e3, the first of their bodies
 *   bodies   | 1-2  2-3  3-4  5-6  ..|        round 2: e1
 *                                             round 3: e2
 * So the batches are those of the sequential batching, to the bit. A chain of contacts costs a round for each link, and
 * all but one compute unit of the device stand idle: it does not scale, as the talks say, and is here to be measured.
 */
#ifndef TANDEM_SHARED_BATCHING_SINGLE_GROUP_H
#define TANDEM_SHARED_BATCHING_SINGLE_GROUP_H

#include "shared/batching/coloring.h"
#include "shared/parallel/length.h"

/* The lowest index has the highest bid. */
SHARED uint bid_in_order(uint pair) { return ~pair; }

SHARED void clear_bids(GLOBAL const uint *body_traits, GLOBAL uint *body_bid, uint body)
{
  if (!is_moving(body_traits, body)) return;
  ATOMIC_MIN(body_bid + 2u * body, 0u);
  ATOMIC_MIN(body_bid + 2u * body + 1u, 0u);
}

SHARED void bid_for_turn(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_traits,
                         GLOBAL const uint *pair_color, GLOBAL uint *body_bid, uint round, uint pair)
{
  if (pair_color[pair] != COLOR_NONE) return;
  uint a = pair_a[pair], b = pair_b[pair], bid = bid_in_order(pair);
  if (is_moving(body_traits, a)) ATOMIC_MAX(body_bid + 2u * a + (round & 1u), bid);
  if (is_moving(body_traits, b)) ATOMIC_MAX(body_bid + 2u * b + (round & 1u), bid);
}

/* Colours the pair if it is its turn; 1 if it must wait. */
SHARED uint take_turn(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_traits, GLOBAL uint *pair_color,
                      GLOBAL uint *body_colors, GLOBAL uint *body_bid, uint round, uint pair)
{
  if (pair_color[pair] != COLOR_NONE) return 0u;
  uint a = pair_a[pair], b = pair_b[pair];
  uint moving_a = is_moving(body_traits, a), moving_b = is_moving(body_traits, b);
  if (!wins_round(body_bid, a, moving_a, b, moving_b, bid_in_order(pair), round)) return 1u;
  uint color = free_color(body_colors, a, moving_a, b, moving_b);
  pair_color[pair] = color;
  if (moving_a) take_color(body_colors, a, color);
  if (moving_b) take_color(body_colors, b, color);
  return 0u;
}

/* One tile, in as many rounds as its longest chain. local_memory[round]: how many have waited for it. */
SHARED void color_tile(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_traits, GLOBAL uint *pair_color,
                       GLOBAL uint *body_colors, GLOBAL uint *body_bid, uint first, uint count, LOCAL uint *local_memory)
{
  FOR_EACH_ITEM(round, TILE + 1u) local_memory[round] = round == 0u ? count : 0u;
  FOR_EACH_ITEM(k, count)
  {
    clear_bids(body_traits, body_bid, pair_a[first + k]);
    clear_bids(body_traits, body_bid, pair_b[first + k]);
  }
  for (uint round = 0u; round < TILE; ++round) {
    const uint active = local_memory[round] > 0u ? count : 0u;
    FOR_EACH_ITEM(k, active) bid_for_turn(pair_a, pair_b, body_traits, pair_color, body_bid, round, first + k);
    FOR_EACH_ITEM(k, active)
    {
      if (take_turn(pair_a, pair_b, body_traits, pair_color, body_colors, body_bid, round, first + k)) LOCAL_ADD(local_memory + round + 1u, 1u);
    }
    FOR_EACH_ITEM(none, 0u) {} /* a barrier before the count is read */
  }
}

SHARED void color_in_group_group(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_traits, GLOBAL uint *counts,
                                 GLOBAL uint *pair_color, GLOBAL uint *body_colors, GLOBAL uint *body_bid, LOCAL uint *local_memory, uint group)
{
  const uint pairs = counts[COUNT_PAIRS];
  if (group != 0u) return;
  for (uint tile = 0u; tile < units_of(pairs, TILE); ++tile)
    color_tile(pair_a, pair_b, body_traits, pair_color, body_colors, body_bid, tile * TILE, items_in_tile(pairs, TILE, tile), local_memory);
  FOR_EACH_ITEM(one, 1u) counts[COUNT_UNCOLORED] = 0u;
}

#endif
