/* iterative.h - the iterative batching of the talks (GS-4150 slide 43): batch after batch, over all contacts.
 *
 *   for each batch
 *     for each contact without a batch whose bodies the batch does not use yet: try to reserve both bodies
 *     the contact that holds both joins the batch
 *
 * The talk reserves by atomics on local memory, so the first thread wins and the batches differ from run to run. Here
 * the contacts of a round bid and the highest bid at both bodies wins (bid_of: a bijective hash, so there are no ties);
 * a maximum does not depend on order. One round leaves gaps, because a contact whose rival lost elsewhere could still
 * join. Each batch is therefore filled in BATCH_ROUNDS rounds before the next one starts:
 *
 *   round 1     1 --- 2 --- 3 --- 4 --- 5        bids 3, 9, 5, 4: the 9 wins; 5 and 3 lose to it, 4 loses to 5
 *                  3     9     5     4
 *   round 2     of the contacts left only 4 has two free bodies, so it joins, too
 */
#ifndef TANDEM_SHARED_BATCHING_ITERATIVE_H
#define TANDEM_SHARED_BATCHING_ITERATIVE_H

#include "shared/batching/coloring.h"
#include "shared/batching/limits.h"

/* A bid is never 0, which means that no contact bids. A contact that does not bid must not hold a body for which no
 * other contact bids. */
SHARED uint batch_bid_of(uint pair) { return bid_of(pair + 1u); }

SHARED uint is_reserved(GLOBAL const uint *body_colors, uint body, uint batch)
{
  return body_colors[2u * body + (batch >> 5)] >> (batch & 31u) & 1u;
}

SHARED void batch_bid_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_flags,
                           GLOBAL const uint *pair_color, GLOBAL const uint *body_colors, GLOBAL uint *body_bid,
                           uint batch, uint round, uint i)
{
  if (pair_color[i] != COLOR_NONE) return;
  uint a = pair_a[i], b = pair_b[i], bid = batch_bid_of(i);
  uint moving_a = is_moving(body_flags, a), moving_b = is_moving(body_flags, b);
  if ((moving_a && is_reserved(body_colors, a, batch)) || (moving_b && is_reserved(body_colors, b, batch))) return;
  if (moving_a) ATOMIC_MAX(body_bid + 2u * a + (round & 1u), bid);
  if (moving_b) ATOMIC_MAX(body_bid + 2u * b + (round & 1u), bid);
}

SHARED void batch_reserve_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_flags,
                               GLOBAL uint *counts, GLOBAL uint *pair_color, GLOBAL uint *body_colors,
                               GLOBAL uint *body_bid, uint batch, uint round, uint i)
{
  if (pair_color[i] != COLOR_NONE) return;
  uint a = pair_a[i], b = pair_b[i];
  uint moving_a = is_moving(body_flags, a), moving_b = is_moving(body_flags, b);
  if (!wins_round(body_bid, a, moving_a, b, moving_b, batch_bid_of(i), round)) return;
  pair_color[i] = batch;
  if (moving_a) take_color(body_colors, a, batch);
  if (moving_b) take_color(body_colors, b, batch);
  ATOMIC_ADD(counts + COUNT_UNCOLORED, 0xffffffffu);
  ATOMIC_MAX(counts + COUNT_ROUNDS, round + 1u);
}

/* After the last batch, the contacts that are left join the overflow constraints. */
SHARED void batch_rest_item(GLOBAL uint *counts, GLOBAL uint *pair_color, uint i)
{
  if (pair_color[i] != COLOR_NONE) return;
  pair_color[i] = COLOR_OVERFLOW;
  ATOMIC_ADD(counts + COUNT_UNCOLORED, 0xffffffffu);
}

#endif
