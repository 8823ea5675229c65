/* single_group.h - the naive batching of the talks: one work-group does all of it (GS-4150 slide 27, 2009 talk).
 *
 * In the kernel kSetupBatches of 2009 the work-items of one compute unit take turns in the order of the list, with a
 * barrier between two turns. Here a contact takes the lowest colour free at both bodies as soon as every earlier
 * contact that shares a body has one, so that contacts far from each other proceed in one round:
 *
 *   list     e0   e1   e2   e3         round 1: e0 and e3, the first of their bodies
 *   bodies  1-2  2-3  3-4  5-6         round 2: e1
 *                                      round 3: e2
 * The batches are those of the sequential batching, to the bit. A chain of contacts takes a round for each link, and
 * all but one compute unit of the device are idle. The method does not scale, as the talks say; it is here to be
 * measured.
 */
#ifndef TANDEM_SHARED_BATCHING_SINGLE_GROUP_H
#define TANDEM_SHARED_BATCHING_SINGLE_GROUP_H

#include "shared/batching/coloring.h"

/* The lowest index has the highest bid. */
SHARED uint bid_in_order(uint pair) { return ~pair; }

SHARED void bid_for_turn(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_flags,
                         GLOBAL const uint *pair_color, GLOBAL uint *body_bid, uint round, uint pair)
{
  if (pair_color[pair] != COLOR_NONE) return;
  uint a = pair_a[pair], b = pair_b[pair], bid = bid_in_order(pair);
  if (is_moving(body_flags, a)) ATOMIC_MAX(body_bid + 2u * a + (round & 1u), bid);
  if (is_moving(body_flags, b)) ATOMIC_MAX(body_bid + 2u * b + (round & 1u), bid);
}

SHARED void take_turn(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_flags,
                      GLOBAL uint *counts, GLOBAL uint *pair_color, GLOBAL uint *body_colors, GLOBAL uint *body_bid,
                      uint round, uint pair)
{
  if (pair_color[pair] != COLOR_NONE) return;
  uint a = pair_a[pair], b = pair_b[pair];
  uint moving_a = is_moving(body_flags, a), moving_b = is_moving(body_flags, b);
  if (!wins_round(body_bid, a, moving_a, b, moving_b, bid_in_order(pair), round)) return;
  uint color = free_color(body_colors, a, moving_a, b, moving_b);
  pair_color[pair] = color;
  if (moving_a) take_color(body_colors, a, color);
  if (moving_b) take_color(body_colors, b, color);
  ATOMIC_ADD(counts + COUNT_UNCOLORED, 0xffffffffu);
  ATOMIC_MAX(counts + COUNT_ROUNDS, round + 1u);
}

/* rounds: the number that the host launches. Fewer than the longest chain leave contacts without a colour, which shows
 * in the status; each further one costs two barriers. A loop that ended once all contacts have a colour would end for
 * some items only in PoCL 3.1. */
SHARED void color_in_group_group(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_flags,
                                 GLOBAL uint *counts, GLOBAL uint *pair_color, GLOBAL uint *body_colors,
                                 GLOBAL uint *body_bid, uint rounds, LOCAL uint *local_memory, uint group)
{
  const uint pairs = counts[COUNT_PAIRS];
  (void)local_memory;
  if (group != 0u) return;
  for (uint round = 0u; round < rounds; ++round) {
    FOR_EACH_ITEM(k, pairs) bid_for_turn(pair_a, pair_b, body_flags, pair_color, body_bid, round, k);
    const uint waiting = counts[COUNT_UNCOLORED] > 0u ? pairs : 0u;
    FOR_EACH_ITEM(k, waiting)
    take_turn(pair_a, pair_b, body_flags, counts, pair_color, body_colors, body_bid, round, k);
  }
}

#endif
