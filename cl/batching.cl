/* batching.cl - entries: matching with the last step, and colouring. */
#include "cl/entry.h"
#include "shared/batching/match.h"
#include "shared/batching/coloring.h"
#include "shared/batching/incidence.h"
#include "shared/batching/body_coloring.h"
#include "shared/batching/order.h"

__kernel void match_pairs(__global const uint *pair_a, __global const uint *pair_b,
                          __global const uint *manifold_count, __global const uint *body_traits,
                          __global const uint *cached_start, __global const uint *cached_b,
                          __global const uint *cached_color, __global uint *counts, __global uint *pair_cached,
                          __global uint *pair_color, __global uint *body_colors, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  match_pairs_item(pair_a, pair_b, manifold_count, body_traits, cached_start, cached_b, cached_color, counts,
                   pair_cached, pair_color, body_colors, i);
}

__kernel void color_bid(__global const uint *pair_a, __global const uint *pair_b,
                        __global const uint *body_traits, __global const uint *pair_color,
                        __global uint *body_bid, uint round, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  color_bid_item(pair_a, pair_b, body_traits, pair_color, body_bid, round, i);
}

__kernel void color_assign(__global const uint *pair_a, __global const uint *pair_b,
                           __global const uint *body_traits, __global uint *counts, __global uint *pair_color,
                           __global uint *body_colors, __global uint *body_bid, uint round, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  color_assign_item(pair_a, pair_b, body_traits, counts, pair_color, body_colors, body_bid, round, i);
}

__kernel void color_in_order(__global const uint *pair_a, __global const uint *pair_b,
                             __global const uint *body_traits, __global uint *counts,
                             __global uint *pair_color, __global uint *body_colors, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  color_in_order_item(pair_a, pair_b, body_traits, counts, pair_color, body_colors, i);
}

__kernel void color_keys(__global const uint *pair_color, __global uint *sort_key, __global uint *sort_value,
                         RANGE)
{
  FOR_EACH_IN_RANGE(i)
  color_keys_item(pair_color, sort_key, sort_value, i);
}

__kernel void color_starts(__global const uint *sort_key, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  color_starts_item(sort_key, counts, i);
}

__kernel void incidence_keys(__global const uint *constraint_a, __global const uint *constraint_b,
                             __global const uint *body_traits, __global const uint *counts,
                             __global uint *incidence_body, __global uint *incidence, uint first_color, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  incidence_keys_item(constraint_a, constraint_b, body_traits, counts, incidence_body, incidence, first_color, i);
}

__kernel void incidence_starts(__global const uint *incidence_body, __global const uint *counts,
                               __global uint *incidence_start, uint length, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  incidence_starts_item(incidence_body, counts, incidence_start, length, i);
}

__kernel void body_color_begin(__global const uint *incidence_start, __global uint *counts,
                               __global uint *body_color, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  body_color_begin_item(incidence_start, counts, body_color, i);
}

__kernel void body_color_round(__global const uint *constraint_a, __global const uint *constraint_b,
                               __global const uint *incidence_start, __global const uint *incidence,
                               __global uint *counts, __global uint *body_color, uint round, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  body_color_round_item(constraint_a, constraint_b, incidence_start, incidence, counts, body_color, round, i);
}

__kernel void body_color_keys(__global const uint *body_color, __global uint *sort_key,
                              __global uint *sort_value, uint rounds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  body_color_keys_item(body_color, sort_key, sort_value, rounds, i);
}

__kernel void body_color_starts(__global const uint *sort_key, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  body_color_starts_item(sort_key, counts, i);
}
