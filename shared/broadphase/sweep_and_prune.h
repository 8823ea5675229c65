/* sweep_and_prune.h - sort, sweep and prune along one axis (2012 talk; GS-4150 slides 21-26): the interval of each
 * body, and the plain sweep.
 *
 * Small bodies are sorted by the start of their interval along an axis: the one along which centres spread most, or the
 * principal direction of their spread. Each body searches forward until a body starts behind its own end:
 *
 *     axis -->   |--- i ---|
 *                   |-- j --|          starts inside i: tested on all axes
 *                            |-- k --  starts behind i: the search ends
 *
 * The talk appends by atomics, which has no order. Here the neighbors of each body are counted, scanned and written,
 * and the keys (a, b) are sorted, so the list is the brute-force one. This is the form that the talk begins with, one
 * work-item for each body; sweep_window.h is the one that it ends with.
 */
#ifndef TANDEM_SHARED_BROADPHASE_SWEEP_AND_PRUNE_H
#define TANDEM_SHARED_BROADPHASE_SWEEP_AND_PRUNE_H

#include "shared/broadphase/overlap.h"
#include "shared/broadphase/pair_keys.h"
#include "shared/conversion.h"

typedef struct {
  real start, end;
} interval;

/* The interval along an axis of the world is exact. Along another direction the sums round, so the interval is widened
 * by more than their rounding, and no overlap is missed. */
SHARED interval interval_along_axis(box_bounds b, uint axis)
{
  interval i = {axis == 0u   ? b.lower.x
                : axis == 1u ? b.lower.y
                             : b.lower.z,
                axis == 0u   ? b.upper.x
                : axis == 1u ? b.upper.y
                             : b.upper.z};
  return i;
}
SHARED interval interval_along_direction(box_bounds b, vec3 direction)
{
  vec3 center = scale(add(b.lower, b.upper), R(0.5)), extent = scale(subtract(b.upper, b.lower), R(0.5)),
       d = absolute(direction);
  real middle = dot3(center, direction), reach = dot3(extent, d);
  reach = reach + R(1e-6) * (dot3(absolute(center), d) + reach);
  interval i = {middle - reach, middle + reach};
  return i;
}
SHARED interval sweep_interval(box_bounds b, GLOBAL const float4 *grid, GLOBAL const uint *counts, uint principal)
{
  if (principal != 0u) return interval_along_direction(b, xyz(load_float4(grid, 2u)));
  return interval_along_axis(b, counts[COUNT_SWEEP_AXIS]);
}

/* Keys have the order of the numbers, and both zeros have one key. Rounding to float keeps the order too, so the
 * reference in double misses nothing either. */
SHARED uint sweep_key(real x)
{
  uint bits = real_bits(x);
  return ordered_bits(bits == 0x80000000u ? 0u : bits);
}

SHARED void sweep_keys_item(GLOBAL const float4 *bounds, GLOBAL const float4 *grid, GLOBAL const uint *counts,
                            GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint principal, uint i)
{
  uint body = counts[COUNT_LARGE] + i;
  sort_key[i] = sweep_key(sweep_interval(load_bounds(bounds, body), grid, counts, principal).start);
  sort_value[i] = body;
}

/* Copies bounds into the order of the sweep, so that the sweep reads memory in order. */
SHARED void sweep_gather_item(GLOBAL const float4 *bounds, GLOBAL const uint *sort_value, GLOBAL float4 *sweep_bounds,
                              uint i)
{
  store_float4(sweep_bounds, 2u * i, load_float4(bounds, 2u * sort_value[i]));
  store_float4(sweep_bounds, 2u * i + 1u, load_float4(bounds, 2u * sort_value[i] + 1u));
}

/* Finds the large bodies before the searching one, which is that of item i, and the small ones that start within its
 * interval. */
FORCE_INLINE uint search_forward(const pair_search *search, GLOBAL const float4 *grid,
                                 GLOBAL const float4 *sweep_bounds, GLOBAL const uint *sort_key,
                                 GLOBAL const uint *sort_value, GLOBAL const uint *counts, uint i,
                                 const find_list *list, uint at)
{
  uint large = counts[COUNT_LARGE], small = counts[COUNT_SMALL];
  at = find_among_first(search, large, list, at);
  if (i < large) return at;
  uint end = sweep_key(sweep_interval(search->box, grid, counts, 0u).end);
  for (uint k = i - large + 1u; k < small && sort_key[k] <= end; ++k) {
    if (!overlaps_rows(search->box, sweep_bounds, k)) continue;
    uint other = sort_value[k];
    if (may_meet(search, other)) at = add_find(list, at, search->body, other);
  }
  return at;
}

SHARED void sweep_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                             GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                             GLOBAL const float4 *sweep_bounds, GLOBAL const uint *sort_key,
                             GLOBAL const uint *sort_value, GLOBAL const uint *counts, GLOBAL uint *key_start, uint i)
{
  uint body = searching_body(sort_value, counts[COUNT_LARGE], i);
  pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, body);
  find_list list = no_neighbors();
  key_start[i] = search_forward(&search, grid, sweep_bounds, sort_key, sort_value, counts, i, &list, 0u);
}

SHARED void sweep_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                             GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                             GLOBAL const float4 *sweep_bounds, GLOBAL const uint *sort_key,
                             GLOBAL const uint *sort_value, GLOBAL const uint *counts, GLOBAL const uint *key_start,
                             GLOBAL ulong *pair_key, uint i)
{
  uint body = searching_body(sort_value, counts[COUNT_LARGE], i);
  pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, body);
  find_list list = finds_as_keys(pair_key, counts[CAPACITY_PAIRS]);
  search_forward(&search, grid, sweep_bounds, sort_key, sort_value, counts, i, &list, key_start[i]);
}

#endif
