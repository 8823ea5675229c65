/* body_coloring.h - deterministic parallel colouring of the bodies: no two bodies of one colour share a constraint
 * or a joint.
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

/* Dynamic bodies with at least one constraint or joint are to be coloured; the others take no part. */
SHARED void body_color_begin_item(GLOBAL const Parameters *parameters, read_body_lists lists, GLOBAL uint *counts,
                                  GLOBAL uint *body_color, uint i)
{
  uint touched = lists.start[i] != lists.start[i + 1u] ? 1u : 0u;
  if (HAS_FEATURE(parameters, JOINTS) && lists.joint_start[i] != lists.joint_start[i + 1u]) touched = 1u;
  body_color[2u * i] = touched ? COLOR_NONE : COLOR_INACTIVE;
  if (touched) ATOMIC_ADD(counts + COUNT_UNCOLORED, 1u);
}

/* The colours of the neighbours with a higher priority. waits: one of them has none yet. */
typedef struct {
  uint low, high, waits;
} neighbor_colors;

SHARED void add_neighbor(neighbor_colors *around, GLOBAL const uint *body_color, uint plane, uint body, uint other)
{
  uint color = body_color[2u * other + plane];
  if (color == COLOR_INACTIVE || bid_of(other) < bid_of(body)) return;
  if (color == COLOR_NONE) around->waits = 1u;
  else if (color < 32u) around->low |= 1u << color;
  else if (color < COLOR_LIMIT) around->high |= 1u << (color & 31u);
}

SHARED void add_neighbors_by_constraints(neighbor_colors *around, GLOBAL const uint *constraint_a,
                                         GLOBAL const uint *constraint_b, read_body_lists lists,
                                         GLOBAL const uint *body_color, uint plane, uint body)
{
  for (uint k = lists.start[body]; k < lists.start[body + 1u]; ++k) {
    uint entry = lists.entries[k], constraint = entry >> 1u;
    add_neighbor(around, body_color, plane, body,
                 (entry & 1u) != 0u ? constraint_a[constraint] : constraint_b[constraint]);
  }
}

SHARED void add_neighbors_by_joints(neighbor_colors *around, GLOBAL const uint *joint_a, GLOBAL const uint *joint_b,
                                    read_body_lists lists, GLOBAL const uint *body_color, uint plane, uint body)
{
  for (uint k = lists.joint_start[body]; k < lists.joint_start[body + 1u]; ++k) {
    uint entry = lists.joint_entries[k], other = (entry & 1u) != 0u ? joint_a[entry >> 1u] : joint_b[entry >> 1u];
    if (other != INDEX_NONE) add_neighbor(around, body_color, plane, body, other);
  }
}

SHARED void body_color_round_item(GLOBAL const Parameters *parameters, GLOBAL const uint *constraint_a,
                                  GLOBAL const uint *constraint_b, read_body_lists lists, GLOBAL const uint *joint_a,
                                  GLOBAL const uint *joint_b, GLOBAL uint *counts, GLOBAL uint *body_color, uint round,
                                  uint i)
{
  uint now = round & 1u, color = body_color[2u * i + now];
  if (color == COLOR_NONE) {
    neighbor_colors around = {0u, 0u, 0u};
    add_neighbors_by_constraints(&around, constraint_a, constraint_b, lists, body_color, now, i);
    if (HAS_FEATURE(parameters, JOINTS)) add_neighbors_by_joints(&around, joint_a, joint_b, lists, body_color, now, i);
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
