/* body_constraints.h - the list from each body to its constraints, in one fixed order.
 *
 * Colours let constraints write to their bodies. A solver that reads the constraints of a body, to average their
 * effects or to solve the body by itself, needs the list in the other direction. It is stored as a sparse matrix in
 * compressed rows (CSR). An entry is 2 * constraint + side; side is 0 if the body is the constraint's a, and 1 if it is
 * b. A stable sort of all entries by body leaves each list in the order of constraints:
 *
 *   constraint       0:(4,1)   1:(3,2)   2:(4,3)  ..        body_constraint_key    1  2  3  3  4  4
 *   entries           0   1     2   3     4   5             body_constraint        1  3  2  5  0  4
 *                                                           body_constraint_start  .  0  1  2  4  6
 *
 * Bodies that do not move have no list; their entries lie behind the last list. The lists may leave out the first
 * colours: lists of the overflow constraints alone start at COLOR_OVERFLOW.
 */
#ifndef TANDEM_SHARED_BATCHING_BODY_CONSTRAINTS_H
#define TANDEM_SHARED_BATCHING_BODY_CONSTRAINTS_H

#include "shared/batching/coloring.h"
#include "shared/parallel/search.h"

SHARED uint listed_body(GLOBAL const uint *body_flags, uint body, uint bodies)
{
  return is_moving(body_flags, body) ? body : bodies;
}

/* Item i writes the two entries of constraint i; the first constraint of first_color gets the first place. */
SHARED void body_constraint_keys_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                      GLOBAL const uint *body_flags, GLOBAL const uint *counts,
                                      GLOBAL uint *body_constraint_key, GLOBAL uint *body_constraint, uint first_color,
                                      uint i)
{
  uint place = 2u * (i - counts[COLOR_START + first_color]), bodies = counts[COUNT_BODIES];
  body_constraint_key[place] = listed_body(body_flags, constraint_a[i], bodies);
  body_constraint_key[place + 1u] = listed_body(body_flags, constraint_b[i], bodies);
  body_constraint[place] = 2u * i;
  body_constraint[place + 1u] = 2u * i + 1u;
}

/* Item b writes where the sorted entries of body b start; the last item writes where those of moving bodies end. */
SHARED void body_constraint_starts_item(GLOBAL const uint *body_constraint_key, GLOBAL const uint *counts,
                                        GLOBAL uint *body_constraint_start, uint length, uint i)
{
  body_constraint_start[i] = lower_bound_of(body_constraint_key, counts[length], i);
}

#endif
