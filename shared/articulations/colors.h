/* colors.h - the colour order of a scene with articulations: within each colour, contacts of links come last.
 *
 *   colour      0            1         ..  62                 overflow
 *             o o o l l    o o l l l       o o l l l            o o     o  of other bodies   l  of a link
 *                   ^ LINK_COLOR_START         ^
 *
 * So the kernels of contacts run over others alone. Contacts of links past the last colour join those of colour 62, all
 * of which are solved one after another.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_COLORS_H
#define TANDEM_SHARED_ARTICULATIONS_COLORS_H

#include "shared/articulations/bodies.h"
#include "shared/batching/order.h"

SHARED void link_color_keys_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_link,
                                 GLOBAL const uint *pair_color, GLOBAL uint *sort_key, GLOBAL uint *sort_value,
                                 GLOBAL uint *pair_constraint, uint i)
{
  uint color = pair_color[i], has_link = is_link(body_link, pair_a[i]) | is_link(body_link, pair_b[i]);
  if (has_link && color == COLOR_OVERFLOW) color = LINK_COLORS;
  store_key_of_part(sort_key, sort_value, pair_constraint, color, has_link, i);
}

SHARED void link_color_starts_item(GLOBAL const uint *sort_key, GLOBAL uint *counts, uint i)
{
  uint first_of_links = store_range_of_parts(sort_key, counts, i);
  if (i < COLOR_LIMIT) counts[LINK_COLOR_START + i] = first_of_links;
}

#endif
