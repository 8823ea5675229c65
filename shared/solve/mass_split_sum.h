/* mass_split_sum.h - adds the impulses on a body of very many constraints in a tree that is the same on all backends.
 *
 * A moving floor may carry ten thousand boxes, which would keep one item busy for very long. Items therefore add runs
 * of SPLIT_CHUNK entries of its list, other items add runs of such sums, and split_apply adds the few that are left:
 *
 *   entries of a body   | 32 | 32 | 32 | .. | 32 |  ..          split_sum:   a sum at the first of each run
 *   sums                  s0   s1   s2  ..   s31  | s32 ..      split_join:  s0 = s0 + .. + s31
 *
 * Runs are counted from the start of the body's own list. The kernels run only if there are overflow constraints.
 */
#ifndef TANDEM_SHARED_SOLVE_MASS_SPLIT_SUM_H
#define TANDEM_SHARED_SOLVE_MASS_SPLIT_SUM_H

#include "shared/solve/mass_split.h"

/* Counts the constraints that each dynamic body has with bodies that cannot be pushed. */
SHARED void split_count_static_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                    GLOBAL const uint *body_flags, GLOBAL uint *split_static_constraints, uint i)
{
  uint a = constraint_a[i], b = constraint_b[i];
  uint moving_a = body_type_of(body_flags[a]) == (uint)BODY_TYPE_DYNAMIC,
       moving_b = body_type_of(body_flags[b]) == (uint)BODY_TYPE_DYNAMIC;
  if (moving_a != moving_b) ATOMIC_ADD(split_static_constraints + (moving_a ? a : b), 1u);
}

/* The run of a long list that starts at an entry. */
typedef struct {
  uint starts, place, length;
} list_run;

/* every: the number of entries between the starts of two runs. Lengths are in units of `unit` entries. */
SHARED list_run run_at(GLOBAL const uint *body_constraint_key, GLOBAL const uint *body_constraint_start,
                       GLOBAL const uint *counts, uint every, uint unit, uint i)
{
  list_run run = {0u, 0u, 0u};
  uint body = body_constraint_key[i];
  if (body >= counts[COUNT_BODIES]) return run;
  uint start = body_constraint_start[body], entries = body_constraint_start[body + 1u] - start, rank = i - start;
  if (entries <= SPLIT_DIRECT || rank % every != 0u) return run;
  uint left = (entries - rank + unit - 1u) / unit;
  run.starts = 1u;
  run.place = SPLIT_FIRST_SUM(start) + rank / SPLIT_CHUNK;
  run.length = left < SPLIT_CHUNK ? left : SPLIT_CHUNK;
  return run;
}

SHARED void store_partial(GLOBAL float4 *split_partial, uint place, impulse_sum sum)
{
  store_float4(split_partial, 2u * place, extend(sum.linear, R(0.0)));
  store_float4(split_partial, 2u * place + 1u, extend(sum.angular, R(0.0)));
}

SHARED void split_sum_item(GLOBAL const uint *body_constraint_key, GLOBAL const uint *body_constraint_start,
                           GLOBAL const uint *body_constraint, GLOBAL const float4 *split_impulse,
                           GLOBAL const uint *counts, GLOBAL float4 *split_partial, uint i)
{
  list_run run = run_at(body_constraint_key, body_constraint_start, counts, SPLIT_CHUNK, 1u, i);
  if (run.starts == 0u) return;
  uint stride = counts[CAPACITY_PAIRS];
  impulse_sum sum = load_entry(body_constraint, split_impulse, stride, 1, i);
  for (uint k = 1; k < run.length; ++k)
    sum = add_term(sum, load_entry(body_constraint, split_impulse, stride, 1, i + k), 1, k);
  store_partial(split_partial, run.place, sum);
}

SHARED void split_join_item(GLOBAL const uint *body_constraint_key, GLOBAL const uint *body_constraint_start,
                            GLOBAL const uint *counts, GLOBAL float4 *split_partial, uint i)
{
  list_run run = run_at(body_constraint_key, body_constraint_start, counts, SPLIT_CHUNK * SPLIT_CHUNK, SPLIT_CHUNK, i);
  if (run.starts == 0u) return;
  impulse_sum sum = load_partial(split_partial, 1, run.place);
  for (uint k = 1; k < run.length; ++k) sum = add_term(sum, load_partial(split_partial, 1, run.place + k), 1, k);
  store_partial(split_partial, run.place, sum);
}

#endif
