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

/* The same for several values at once. Each step of a search waits for memory, and these wait together. */
#define SEARCHES_AT_ONCE 10u
SHARED void lower_bounds_of(GLOBAL const uint *sorted, uint n, const uint *values, uint *places)
{
  uint first[SEARCHES_AT_ONCE];
  for (uint k = 0u; k < SEARCHES_AT_ONCE; ++k) first[k] = 0u;
  for (uint count = n; count > 0u;) { /* the lists left to search start at `first` and are equally long */
    const uint skipped = (count + 1u) / 2u;
    for (uint k = 0u; k < SEARCHES_AT_ONCE; ++k)
      if (sorted[first[k] + skipped - 1u] < values[k]) first[k] += skipped;
    count -= skipped;
  }
  for (uint k = 0u; k < SEARCHES_AT_ONCE; ++k) places[k] = first[k];
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
