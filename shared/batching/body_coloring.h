/* body_coloring.h - deterministic parallel colouring of the bodies: no two bodies of one colour share a constraint.
 *
 * A solver that moves whole bodies one after another can move all bodies of one colour at once. Every body has a
 * priority, a bijective hash of its index. A body takes the lowest colour that no neighbour of higher priority has, as
 * soon as all of those have a colour (Jones and Plassmann, "A Parallel Graph Coloring Heuristic", 1993). The colour of
 * a body therefore depends on priorities alone, and not on the order of execution. A round reads the colours of the
 * round before, which are kept apart from those it writes. A body whose neighbours hold all colours gets the overflow
 * colour; bodies of that colour are solved in order.
 *
 *      body       5 --- 2 --- 9         each waits for those of higher priority beside it
 *      priority   .7    .9    .2
 *      round      2     1     2
 */
#ifndef TANDEM_SHARED_BATCHING_BODY_COLORING_H
#define TANDEM_SHARED_BATCHING_BODY_COLORING_H

#include "shared/batching/coloring.h"
#include "shared/parallel/search.h"

/* Dynamic bodies with at least one constraint are to be coloured; the others take no part. */
SHARED void body_color_begin_item(GLOBAL const uint *body_constraint_start, GLOBAL uint *counts,
                                  GLOBAL uint *body_color, uint i)
{
  uint touched = body_constraint_start[i] != body_constraint_start[i + 1u] ? 1u : 0u;
  body_color[2u * i] = touched ? COLOR_NONE : COLOR_INACTIVE;
  if (touched) ATOMIC_ADD(counts + COUNT_UNCOLORED, 1u);
}

/* The colours of the neighbours with a higher priority. waits: one of them has none yet. */
typedef struct {
  uint low, high, waits;
} neighbor_colors;

SHARED neighbor_colors colors_around(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                     GLOBAL const uint *body_constraint_start, GLOBAL const uint *body_constraint,
                                     GLOBAL const uint *body_color, uint plane, uint body)
{
  neighbor_colors around = {0u, 0u, 0u};
  uint priority = bid_of(body);
  for (uint k = body_constraint_start[body]; k < body_constraint_start[body + 1u]; ++k) {
    uint entry = body_constraint[k], constraint = entry >> 1u;
    uint other = (entry & 1u) != 0u ? constraint_a[constraint] : constraint_b[constraint];
    uint color = body_color[2u * other + plane];
    if (color == COLOR_INACTIVE || bid_of(other) < priority) continue;
    if (color == COLOR_NONE) around.waits = 1u;
    else if (color < 32u) around.low |= 1u << color;
    else if (color < COLOR_LIMIT) around.high |= 1u << (color & 31u);
  }
  return around;
}

SHARED void body_color_round_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                  GLOBAL const uint *body_constraint_start, GLOBAL const uint *body_constraint,
                                  GLOBAL uint *counts, GLOBAL uint *body_color, uint round, uint i)
{
  uint now = round & 1u, color = body_color[2u * i + now];
  if (color == COLOR_NONE) {
    neighbor_colors around =
        colors_around(constraint_a, constraint_b, body_constraint_start, body_constraint, body_color, now, i);
    if (!around.waits) {
      color = lowest_free_color(around.low, around.high);
      ATOMIC_ADD(counts + COUNT_UNCOLORED, 0xffffffffu);
      ATOMIC_MAX(counts + COUNT_ROUNDS, round + 1u);
    }
  }
  body_color[2u * i + (now ^ 1u)] = color;
}

/* The keys for a stable sort of the bodies by colour. rounds: the number of rounds that were made. */
SHARED void body_color_keys_item(GLOBAL const uint *body_color, GLOBAL uint *sort_key, GLOBAL uint *sort_value,
                                 uint rounds, uint i)
{
  sort_key[i] = body_color[2u * i + (rounds & 1u)];
  sort_value[i] = i;
}

/* Item c writes the place of the first sorted body of colour c; that of the overflow colour also writes where the
 * coloured bodies end. */
SHARED void body_color_starts_item(GLOBAL const uint *sort_key, GLOBAL uint *counts, uint i)
{
  counts[BODY_COLOR_START + i] = lower_bound_of(sort_key, counts[COUNT_BODIES], i);
  if (i == COLOR_OVERFLOW)
    counts[BODY_COLOR_START + COLOR_OVERFLOW + 1u] = lower_bound_of(sort_key, counts[COUNT_BODIES], i + 1u);
}

#endif
