/* mass_split_sum.h - adds the impulses on a body of very many constraints in a tree that is the same on all backends.
 *
 * The runs are those of solve/parts.h. The kernels run only if there are overflow constraints.
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

SHARED list_run run_at(GLOBAL const uint *body_constraint_key, GLOBAL const uint *body_constraint_start,
                       GLOBAL const uint *counts, uint every, uint unit, uint i)
{
  list_run none = {0u, 0u, 0u};
  uint body = body_constraint_key[i];
  return body < counts[COUNT_BODIES] ? run_of_list(body_constraint_start, body, every, unit, i) : none;
}

SHARED void split_sum_item(GLOBAL const uint *body_constraint_key, GLOBAL const uint *body_constraint_start,
                           GLOBAL const uint *body_constraint, GLOBAL const float4 *split_impulse,
                           GLOBAL const uint *counts, GLOBAL float4 *split_partial, uint i)
{
  list_run run = run_at(body_constraint_key, body_constraint_start, counts, SPLIT_CHUNK, 1u, i);
  if (run.starts != 0u) sum_run(run, body_constraint, split_impulse, counts[CAPACITY_PAIRS], split_partial, i);
}

SHARED void split_join_item(GLOBAL const uint *body_constraint_key, GLOBAL const uint *body_constraint_start,
                            GLOBAL const uint *counts, GLOBAL float4 *split_partial, uint i)
{
  list_run run = run_at(body_constraint_key, body_constraint_start, counts, SPLIT_CHUNK * SPLIT_CHUNK, SPLIT_CHUNK, i);
  if (run.starts != 0u) join_run(run, split_partial);
}

#endif
