/* order.h - puts constraints in colour order: a stable sort of the pairs by colour, then the start of each colour. */
#ifndef TANDEM_SHARED_BATCHING_ORDER_H
#define TANDEM_SHARED_BATCHING_ORDER_H

#include "shared/records.h"

SHARED void color_keys_item(GLOBAL const uint *pair_color, GLOBAL uint *sort_key, GLOBAL uint *sort_value,
                            GLOBAL uint *pair_constraint, uint i)
{
  sort_key[i] = pair_color[i];
  sort_value[i] = i;
  pair_constraint[i] = INDEX_NONE;
}

SHARED uint first_not_below(GLOBAL const uint *sort_key, uint length, uint key)
{
  uint low = 0, high = length;
  while (low < high) {
    uint middle = low + (high - low) / 2u;
    if (sort_key[middle] < key) low = middle + 1u;
    else high = middle;
  }
  return low;
}

SHARED void store_color_range(GLOBAL uint *counts, uint color, uint start, uint end)
{
  counts[COLOR_START + color] = start;
  if (end > start) ATOMIC_MAX(counts + COUNT_COLORS, color + 1u);
  if (color == COLOR_OVERFLOW) {
    counts[COLOR_START + COLOR_OVERFLOW + 1u] = end;
    counts[COUNT_CONSTRAINTS] = end;
    counts[COUNT_BODY_CONSTRAINTS] = 2u * end;
    counts[COUNT_OVERFLOW_BODY_CONSTRAINTS] = 2u * (end - start);
  }
}

/* --- colours of two parts -------------------------------------------------------------------------------------- */
SHARED void store_key_of_part(GLOBAL uint *sort_key, GLOBAL uint *sort_value, GLOBAL uint *pair_constraint, uint color,
                              uint of_second, uint i)
{
  sort_key[i] = color > COLOR_OVERFLOW ? color : 2u * color + of_second;
  sort_value[i] = i;
  pair_constraint[i] = INDEX_NONE;
}

/* Returns where the second part of the colour begins. */
SHARED uint store_range_of_parts(GLOBAL const uint *sort_key, GLOBAL uint *counts, uint color)
{
  uint pairs = counts[COUNT_PAIRS];
  store_color_range(counts, color, first_not_below(sort_key, pairs, 2u * color),
                    first_not_below(sort_key, pairs, 2u * color + 2u));
  return first_not_below(sort_key, pairs, 2u * color + 1u);
}

/* Item c writes the first constraint of colour c. The item of the overflow constraints, which count as a colour, also
 * writes where the constraints end. */
SHARED void color_starts_item(GLOBAL const uint *sort_key, GLOBAL uint *counts, uint color)
{
  uint pairs = counts[COUNT_PAIRS];
  store_color_range(counts, color, first_not_below(sort_key, pairs, color),
                    first_not_below(sort_key, pairs, color + 1u));
}

#endif
