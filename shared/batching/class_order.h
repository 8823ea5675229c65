/* class_order.h - the colour order where some islands take many substeps: within each colour, and past the last one,
 * their contacts come last; see substep_classes.h.
 *
 *   colour      0            1         ..   overflow
 *             f f f m m    f f m m m        f f m     f  of few substeps   m  of many
 *                   ^ MANY_COLOR_START
 */
#ifndef TANDEM_SHARED_BATCHING_CLASS_ORDER_H
#define TANDEM_SHARED_BATCHING_CLASS_ORDER_H

#include "shared/batching/order.h"
#include "shared/substep_classes.h"

SHARED void class_color_keys_item(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, GLOBAL const uint *body_class,
                                  GLOBAL const uint *pair_color, GLOBAL uint *sort_key, GLOBAL uint *sort_value,
                                  GLOBAL uint *pair_constraint, uint i)
{
  uint of_many = body_class[pair_a[i]] == MANY_SUBSTEPS || body_class[pair_b[i]] == MANY_SUBSTEPS ? 1u : 0u;
  store_key_of_part(sort_key, sort_value, pair_constraint, pair_color[i], of_many, i);
}

SHARED void class_color_starts_item(GLOBAL const uint *sort_key, GLOBAL uint *counts, uint i)
{
  counts[MANY_COLOR_START + i] = store_range_of_parts(sort_key, counts, i);
}

#endif
