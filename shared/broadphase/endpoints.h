/* endpoints.h - the ends of boxes along each axis, in sorted order, which the incremental sweep and prune compares with
 * those of the launch before.
 *
 * End e is the lower end of body e, or the upper end of body e - bodies:
 *
 *     axis -->    |--- 0 ---|
 *                      |-- 1 --|
 *     order:      0    1    2  3        (2 bodies: ends 2 and 3 are upper ones)
 *     place:      0    1    2  3        of ends 0, 1, 2, 3
 *
 * The sort is stable, so ends of equal value stay in the order of their indices: lower ends come before upper ones, and
 * boxes that touch overlap. For two bodies a and b, "a.lower <= b.upper" is therefore exactly "a's lower end is before
 * b's upper end", in floats. Orders and places are planes, one for each axis, of all ends.
 */
#ifndef TANDEM_SHARED_BROADPHASE_ENDPOINTS_H
#define TANDEM_SHARED_BROADPHASE_ENDPOINTS_H

#include "shared/argument_groups.h"
#include "shared/broadphase/sweep_and_prune.h"

SHARED uint body_of_end(uint end, uint bodies) { return end < bodies ? end : end - bodies; }

/* A box with NaN overlaps nothing, as in bounds_overlap: its lower end sorts after all ends, and its upper end
 * before. */
SHARED uint end_key(interval along, int is_lower)
{
  int is_number = along.start == along.start && along.end == along.end;
  if (is_number) return sweep_key(is_lower ? along.start : along.end);
  return is_lower ? 0xffffffffu : 0u;
}

SHARED void axis_keys_item(GLOBAL const float4 *bounds, GLOBAL const uint *counts, GLOBAL uint *sort_key,
                           GLOBAL uint *sort_value, uint axis, uint i)
{
  uint bodies = counts[COUNT_BODIES];
  sort_key[i] = end_key(interval_along_axis(load_bounds(bounds, body_of_end(i, bodies)), axis), i < bodies);
  sort_value[i] = i;
}

/* Stores the end at each place and the place of each end, because the buffers of the sort are reused for the next
 * axis. */
SHARED void axis_places_item(GLOBAL const uint *sort_value, GLOBAL const uint *counts, GLOBAL uint *axis_order,
                             GLOBAL uint *axis_place, uint axis, uint i)
{
  uint plane = axis * counts[COUNT_HALVES], end = sort_value[i];
  axis_order[plane + i] = end;
  axis_place[plane + end] = i;
}

/* Keeps the orders and the bounds for the next launch; there are as many rows of bounds as ends. */
SHARED void keep_ends_item(GLOBAL const float4 *bounds, read_box_ends box_ends, GLOBAL const uint *counts,
                           write_kept_box_ends kept_box_ends, uint i)
{
  store_float4(kept_box_ends.bounds, i, load_float4(bounds, i));
  for (uint axis = 0; axis < 3u; ++axis) {
    uint at = axis * counts[COUNT_HALVES] + i;
    kept_box_ends.order[at] = box_ends.order[at];
    kept_box_ends.place[at] = box_ends.place[at];
  }
}

#endif
