/* sorted_bounds.h - bounds in the order of a sorted list: neighbours in it are neighbours in space, and so those who look for them read
 * memory in order. The bodies themselves may be numbered in any. */
#ifndef TANDEM_SHARED_BROADPHASE_SORTED_BOUNDS_H
#define TANDEM_SHARED_BROADPHASE_SORTED_BOUNDS_H

#include "shared/records.h"

SHARED void gather_bounds_item(GLOBAL const row *bounds, GLOBAL const uint *sort_value, GLOBAL row *sorted_bounds, uint i)
{
  store_row(sorted_bounds, 2u * i, load_row(bounds, 2u * sort_value[i]));
  store_row(sorted_bounds, 2u * i + 1u, load_row(bounds, 2u * sort_value[i] + 1u));
}

#endif
