/* batching.cl - entries: matching with the last step, the batchers, and the proof of their batches. */
#include "cl/entry.h"
#include "shared/batching/match.h"
#include "shared/batching/cells.h"
#include "shared/batching/check.h"
#include "shared/batching/coloring.h"
#include "shared/batching/incidence.h"
#include "shared/batching/body_coloring.h"
#include "shared/batching/iterative.h"
#include "shared/batching/order.h"
#include "shared/batching/single_group.h"

__kernel void match_pairs(__global const Parameters *parameters, __global const uint *pair_a,
                          __global const uint *pair_b, __global const row *manifold_normal,
                          __global const uint *manifold_count, __global const uint *body_traits,
                          __global const uint *cached_start, __global const uint *cached_b,
                          __global const row *cached_normal, __global const uint *cached_color, __global uint *counts,
                          __global uint *pair_cached, __global uint *pair_color, __global uint *body_colors, uint keep,
                          RANGE)
{
  FOR_EACH_IN_RANGE(i)
  match_pairs_item(parameters, pair_a, pair_b, manifold_normal, manifold_count, body_traits, cached_start, cached_b,
                   cached_normal, cached_color, counts, pair_cached, pair_color, body_colors, keep, i);
}

__kernel void color_bid(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                        __global const uint *body_colors, __global uint *counts, __global uint *pair_color,
                        __global uint *body_bid, uint round, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  color_bid_item(pair_a, pair_b, body_traits, body_colors, counts, pair_color, body_bid, round, i);
}

__kernel void color_assign(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                           __global uint *counts, __global uint *pair_color, __global uint *body_colors,
                           __global uint *body_bid, uint round, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  color_assign_item(pair_a, pair_b, body_traits, counts, pair_color, body_colors, body_bid, round, i);
}

__kernel void color_in_order(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                             __global uint *counts, __global uint *pair_color, __global uint *body_colors, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  color_in_order_item(pair_a, pair_b, body_traits, counts, pair_color, body_colors, i);
}

__kernel void color_in_group(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                             __global uint *counts, __global uint *pair_color, __global uint *body_colors,
                             __global uint *body_bid, uint rounds, RANGE)
{
  __local uint local_memory[1];
  color_in_group_group(pair_a, pair_b, body_traits, counts, pair_color, body_colors, body_bid, rounds, local_memory,
                       GROUP_NUMBER);
  END_GROUP;
}

__kernel void batch_bid(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                        __global const uint *pair_color, __global const uint *body_colors, __global uint *body_bid,
                        uint batch, uint round, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  batch_bid_item(pair_a, pair_b, body_traits, pair_color, body_colors, body_bid, batch, round, i);
}

__kernel void batch_reserve(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                            __global uint *counts, __global uint *pair_color, __global uint *body_colors,
                            __global uint *body_bid, uint batch, uint round, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  batch_reserve_item(pair_a, pair_b, body_traits, counts, pair_color, body_colors, body_bid, batch, round, i);
}

__kernel void batch_rest(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                         __global uint *counts, __global uint *pair_color, __global uint *body_colors, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  batch_rest_item(pair_a, pair_b, body_traits, counts, pair_color, body_colors, i);
}

__kernel void clear_cells(__global uint *body_cells, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  clear_cells_item(body_cells, i);
}

__kernel void claim_cells(__global const Parameters *parameters, __global const uint *pair_a,
                          __global const uint *pair_b, __global const uint *body_traits,
                          __global const row *body_position, __global const uint *pair_color,
                          __global const uint *counts, __global uint *body_cells, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  claim_cells_item(parameters, pair_a, pair_b, body_traits, body_position, pair_color, counts, body_cells, i);
}

__kernel void cell_keys(__global const Parameters *parameters, __global const uint *pair_a, __global const uint *pair_b,
                        __global const uint *body_traits, __global const row *body_position,
                        __global const uint *pair_color, __global const uint *counts, __global const uint *body_cells,
                        __global uint *sort_key, __global uint *sort_value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  cell_keys_item(parameters, pair_a, pair_b, body_traits, body_position, pair_color, counts, body_cells, sort_key,
                 sort_value, i);
}

__kernel void color_cells(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                          __global const uint *sort_key, __global const uint *sort_value, __global uint *counts,
                          __global uint *pair_color, __global uint *body_colors, __global uint *body_bid, uint parity,
                          RANGE)
{
  __local uint local_memory[CELL_ROUNDS + 1u];
  color_cells_group(pair_a, pair_b, body_traits, sort_key, sort_value, counts, pair_color, body_colors, body_bid,
                    parity, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void color_keys(__global const uint *pair_color, __global uint *sort_key, __global uint *sort_value, RANGE)
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

__kernel void body_color_begin(__global const uint *incidence_start, __global uint *counts, __global uint *body_color,
                               RANGE)
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

__kernel void body_color_keys(__global const uint *body_color, __global uint *sort_key, __global uint *sort_value,
                              uint rounds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  body_color_keys_item(body_color, sort_key, sort_value, rounds, i);
}

__kernel void body_color_starts(__global const uint *sort_key, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  body_color_starts_item(sort_key, counts, i);
}

__kernel void mark_tail(__global const uint *constraint_a, __global const uint *constraint_b,
                        __global const uint *body_traits, __global uint *body_colors, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  mark_tail_item(constraint_a, constraint_b, body_traits, body_colors, i);
}

__kernel void clear_body_marks(__global uint *body_marks, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  clear_body_marks_item(body_marks, i);
}

__kernel void clear_pair_marks(__global uint *pair_marks, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  clear_pair_marks_item(pair_marks, i);
}

__kernel void mark_batches(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                           __global const uint *sort_value, __global const uint *counts, __global uint *body_marks,
                           __global uint *pair_marks, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  mark_batches_item(pair_a, pair_b, body_traits, sort_value, counts, body_marks, pair_marks, i);
}

__kernel void check_batches(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                            __global const uint *sort_value, __global const uint *body_marks, __global uint *counts,
                            RANGE)
{
  FOR_EACH_IN_RANGE(i)
  check_batches_item(pair_a, pair_b, body_traits, sort_value, body_marks, counts, i);
}

__kernel void check_pairs(__global const Parameters *parameters, __global const uint *pair_a,
                          __global const uint *pair_b, __global const uint *manifold_count,
                          __global const uint *body_traits, __global const uint *pair_marks, __global uint *counts,
                          RANGE)
{
  FOR_EACH_IN_RANGE(i)
  check_pairs_item(parameters, pair_a, pair_b, manifold_count, body_traits, pair_marks, counts, i);
}
