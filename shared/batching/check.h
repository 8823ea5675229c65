/* check.h - proves the batches of a step. It runs with --check, after the constraints are in colour order.
 *
 * The check reads what the solver uses. The solver works on all constraints between two entries of COLOR_START at once,
 * so the colour of a constraint is the range in which it stands, whatever the batcher stored. No body that can move may
 * stand in one range twice (the overflow constraints are solved in order and may hold anything), and each touching pair
 * must stand in exactly one.
 *
 *   mark_batches    for each body: a bit for each colour that touches it, and a second bit where a colour does so twice
 *   check_batches   for each constraint: whether its colour is doubled at one of its bodies
 *   check_pairs     for each pair: whether it stands in as many ranges as it should, one if it touches and has no
 *                   trigger, else none
 *
 * The result consists of sums, bits and minima, so it does not depend on order.
 */
#ifndef TANDEM_SHARED_BATCHING_CHECK_H
#define TANDEM_SHARED_BATCHING_CHECK_H

#include "shared/batching/coloring.h"
#include "shared/batching/match.h"

#define BODY_MARKS 4u /* words of a body: a bit for each colour, and another if it is doubled */

SHARED void clear_body_marks_item(GLOBAL uint *body_marks, uint i)
{
  for (uint k = 0; k < BODY_MARKS; ++k) body_marks[BODY_MARKS * i + k] = 0u;
}

SHARED void clear_pair_marks_item(GLOBAL uint *pair_marks, uint i) { pair_marks[i] = 0u; }

/* The range in which constraint i stands. */
SHARED uint color_at(GLOBAL const uint *counts, uint i)
{
  uint color = 0;
  while (color < COLOR_OVERFLOW && counts[COLOR_START + color + 1u] <= i) ++color;
  return color;
}

SHARED void mark_body(GLOBAL uint *body_marks, uint body, uint color)
{
  uint word = BODY_MARKS * body + (color >> 5), bit = 1u << (color & 31u);
  if (ATOMIC_OR(body_marks + word, bit) & bit) ATOMIC_OR(body_marks + word + 2u, bit);
}

/* Whether constraints of the range are solved one after another. */
SHARED uint is_in_order(GLOBAL const Parameters *parameters, GLOBAL const uint *body_link, uint color, uint a, uint b)
{
  if (color == COLOR_OVERFLOW) return 1u;
  if (!HAS_FEATURE(parameters, ARTICULATIONS) || color < LINK_COLORS) return 0u;
  return is_link(body_link, a) | is_link(body_link, b);
}

SHARED void mark_batches_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a, GLOBAL const uint *pair_b,
                              read_nodes nodes, GLOBAL const uint *sort_value, GLOBAL const uint *counts,
                              GLOBAL uint *body_marks, GLOBAL uint *pair_marks, uint i)
{
  uint pair = sort_value[i], color = color_at(counts, i);
  ATOMIC_ADD(pair_marks + pair, 1u);
  if (is_in_order(parameters, nodes.link, color, pair_a[pair], pair_b[pair])) return;
  uint a = node_of(parameters, nodes.link, pair_a[pair]), b = node_of(parameters, nodes.link, pair_b[pair]);
  if (is_moving(nodes.flags, a)) mark_body(body_marks, a, color);
  if (is_moving(nodes.flags, b) && b != a) mark_body(body_marks, b, color);
}

SHARED uint is_doubled(GLOBAL const uint *body_flags, GLOBAL const uint *body_marks, uint body, uint color)
{
  return is_moving(body_flags, body) ? body_marks[BODY_MARKS * body + 2u + (color >> 5)] >> (color & 31u) & 1u : 0u;
}

SHARED void check_batches_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a,
                               GLOBAL const uint *pair_b, read_nodes nodes, GLOBAL const uint *sort_value,
                               GLOBAL const uint *body_marks, GLOBAL uint *counts, uint i)
{
  uint pair = sort_value[i], color = color_at(counts, i);
  if (is_in_order(parameters, nodes.link, color, pair_a[pair], pair_b[pair])) return;
  if (!is_doubled(nodes.flags, body_marks, node_of(parameters, nodes.link, pair_a[pair]), color) &&
      !is_doubled(nodes.flags, body_marks, node_of(parameters, nodes.link, pair_b[pair]), color))
    return;
  ATOMIC_ADD(counts + COUNT_CONFLICTS, 1u);
  ATOMIC_MIN(counts + COUNT_FIRST_CONFLICT, i);
}

SHARED void check_pairs_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a, GLOBAL const uint *pair_b,
                             GLOBAL const uint *manifold_count, GLOBAL const uint *body_flags,
                             GLOBAL const uint *pair_marks, GLOBAL uint *counts, uint i)
{
  uint solved = manifold_count[i] > 0u && !has_trigger(parameters, body_flags, pair_a[i], pair_b[i]) ? 1u : 0u;
  if (pair_marks[i] == solved) return;
  ATOMIC_ADD(counts + COUNT_MISBATCHED, 1u);
  ATOMIC_MIN(counts + COUNT_FIRST_MISBATCHED, i);
}

#endif
