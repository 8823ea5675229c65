/* incidence.h - which constraints touch a body: lists in one fixed order.
 *
 * Colours let constraints write bodies; a body that shall read its constraints (to average what they did to it, or to
 * be solved for itself) needs the way back. An entry is 2 * constraint + side, side 0 where the body is the
 * constraint's a and 1 where it is b; a stable sort of all entries by body leaves each list in the order of
 * constraints:
 *
 *   constraint       0:(4,1)   1:(3,2)   2:(4,3)  ..        incidence_body   1  2  3  3  4  4
 *   entries           0   1     2   3     4   5             incidence        1  3  2  5  0  4
 *                                                           incidence_start  .  0  1  2  4  6
 *
 * Bodies that do not move have no list; their entries lie behind the last one. The lists may leave out the first
 * colours: those of the tail alone are made from COLOR_TAIL on.
 */
#ifndef TANDEM_SHARED_BATCHING_INCIDENCE_H
#define TANDEM_SHARED_BATCHING_INCIDENCE_H

#include "shared/batching/coloring.h"
#include "shared/parallel/search.h"

SHARED uint listed_body(GLOBAL const uint *body_traits, uint body, uint bodies)
{
  return is_moving(body_traits, body) ? body : bodies;
}

/* Item i: the two entries of constraint i; the first of first_color gets the first place. */
SHARED void incidence_keys_item(GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                                GLOBAL const uint *body_traits, GLOBAL const uint *counts, GLOBAL uint *incidence_body,
                                GLOBAL uint *incidence, uint first_color, uint i)
{
  uint place = 2u * (i - counts[COLOR_START + first_color]), bodies = counts[COUNT_BODIES];
  incidence_body[place] = listed_body(body_traits, constraint_a[i], bodies);
  incidence_body[place + 1u] = listed_body(body_traits, constraint_b[i], bodies);
  incidence[place] = 2u * i;
  incidence[place + 1u] = 2u * i + 1u;
}

/* Item b: where the sorted entries of body b start; the last item writes where those of moving bodies end. */
SHARED void incidence_starts_item(GLOBAL const uint *incidence_body, GLOBAL const uint *counts,
                                  GLOBAL uint *incidence_start, uint length, uint i)
{
  incidence_start[i] = lower_bound_of(incidence_body, counts[length], i);
}

#endif
