/* search.h - the places of many values in a sorted list, by binary search, one item a query. */
#ifndef TANDEM_SHARED_PARALLEL_SEARCH_H
#define TANDEM_SHARED_PARALLEL_SEARCH_H

#include "shared/platform.h"

/* The first place in sorted[0 .. n) whose value is not less than `value`; n if there is none. */
SHARED uint lower_bound_of(GLOBAL const uint *sorted, uint n, uint value)
{
  uint first = 0u, count = n;
  while (count > 0u) {
    const uint skipped = count / 2u;
    if (sorted[first + skipped] < value) {
      first += skipped + 1u;
      count -= skipped + 1u;
    } else {
      count = skipped;
    }
  }
  return first;
}

/* The first place whose value is greater than `value`. */
SHARED uint upper_bound_of(GLOBAL const uint *sorted, uint n, uint value)
{
  return value == 0xffffffffu ? n : lower_bound_of(sorted, n, value + 1u);
}

SHARED void lower_bound_item(GLOBAL const uint *counts, GLOBAL const uint *sorted, GLOBAL const uint *queries,
                             GLOBAL uint *places, uint length, uint i)
{
  places[i] = lower_bound_of(sorted, counts[length], queries[i]);
}

SHARED void upper_bound_item(GLOBAL const uint *counts, GLOBAL const uint *sorted, GLOBAL const uint *queries,
                             GLOBAL uint *places, uint length, uint i)
{
  places[i] = upper_bound_of(sorted, counts[length], queries[i]);
}

#endif
