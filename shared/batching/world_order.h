/* world_order.h - the colour order of a batch of worlds of which some have overflow constraints.
 *
 * Such a world takes more passes over its colours than one that has none (host/pipeline/solvers/mass_split.h). Within
 * each colour its constraints come last, so that the passes that are its own run over the end of the colour:
 *
 *   colour      0            1           ..  62          overflow     o  of a world without overflow constraints
 *             o o o x x l  o o x x x l       o x l l l      x x       x  of one that has some
 *                   ^   ^ LINK_COLOR_START                            l  of a link (articulations/colors.h)
 *                   | WORLD_COLOR_START
 *
 * Contacts of links stand behind them, of all worlds: the further passes know by the tree whether it takes part
 * (articulations/bodies.h). A contact of a link is no overflow constraint.
 */
#ifndef TANDEM_SHARED_BATCHING_WORLD_ORDER_H
#define TANDEM_SHARED_BATCHING_WORLD_ORDER_H

#include "shared/argument_groups.h"
#include "shared/batching/nodes.h"
#include "shared/batching/order.h"

SHARED uint is_pair_of_link(GLOBAL const Parameters *parameters, GLOBAL const uint *body_link, read_world_pairs pairs,
                            uint i)
{
  if (!HAS_FEATURE(parameters, ARTICULATIONS)) return 0u;
  return is_link(body_link, pairs.a[i]) || is_link(body_link, pairs.b[i]) ? 1u : 0u;
}

SHARED void note_world_overflow_item(GLOBAL const Parameters *parameters, read_world_pairs pairs,
                                     GLOBAL const uint *body_link, GLOBAL const uint *pair_color,
                                     GLOBAL uint *world_overflows, uint i)
{
  if (pair_color[i] == COLOR_OVERFLOW && !is_pair_of_link(parameters, body_link, pairs, i))
    ATOMIC_OR(world_overflows + pairs.world[2u * pairs.a[i]], 1u);
}

/* The place of a pair within its colour: of those the contacts of links come last. */
SHARED uint part_of_color(read_world_pairs pairs, GLOBAL const uint *world_overflows, uint has_link, uint i)
{
  return has_link ? 2u : world_overflows[pairs.world[2u * pairs.a[i]]];
}

SHARED void world_color_keys_item(GLOBAL const Parameters *parameters, read_world_pairs pairs,
                                  GLOBAL const uint *body_link, GLOBAL const uint *pair_color,
                                  GLOBAL const uint *world_overflows, GLOBAL uint *sort_key, GLOBAL uint *sort_value,
                                  GLOBAL uint *pair_constraint, uint i)
{
  uint color = pair_color[i], has_link = is_pair_of_link(parameters, body_link, pairs, i);
  if (has_link && color == COLOR_OVERFLOW) color = LINK_COLORS;
  sort_key[i] = color > COLOR_LIMIT ? color : 3u * color + part_of_color(pairs, world_overflows, has_link, i);
  sort_value[i] = i;
  pair_constraint[i] = INDEX_NONE;
}

SHARED void world_color_starts_item(GLOBAL const uint *sort_key, GLOBAL uint *counts, uint color)
{
  uint pairs = counts[COUNT_PAIRS], start = first_not_below(sort_key, pairs, 3u * color),
       end = first_not_below(sort_key, pairs, 3u * color + 3u);
  store_color_range(counts, color, start, end);
  if (color >= COLOR_LIMIT) return;
  counts[WORLD_COLOR_START + color] = first_not_below(sort_key, pairs, 3u * color + 1u);
  counts[LINK_COLOR_START + color] = first_not_below(sort_key, pairs, 3u * color + 2u);
}

#endif
