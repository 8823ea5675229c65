/* sweep.h - 1-axis sort, sweep and prune (2012 talk; GS-4150 slides 21-26).
 *
 * Small bodies are sorted by their lower bound along the axis where the scene is widest; each looks
 * forward until a body starts behind its own end:
 *
 *     axis -->   |--- i ---|
 *                   |-- j --|          starts inside i: tested on the other two axes
 *                            |-- k --  starts behind i: the search ends
 *
 * Appending by atomics, as the talk does, has no order: here each body's finds are counted, scanned
 * and written, and the keys (a, b) sorted, so the list is the brute-force one.
 */
#ifndef TANDEM_SHARED_BROADPHASE_SWEEP_H
#define TANDEM_SHARED_BROADPHASE_SWEEP_H

#include "shared/broadphase/overlap.h"
#include "shared/conversion.h"

SHARED real along(vec3 v, uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }

/* As precise as the keys are: rounding keeps the order, so nothing that starts inside is missed in double either. */
SHARED real as_sorted(real x) { return (real)(float)x; }

SHARED void sweep_keys_item(GLOBAL const row *bounds, GLOBAL const uint *counts, GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint body = counts[COUNT_LARGE] + i;
  sort_key[i] = ordered_bits(real_bits(along(load_bounds(bounds, body).lower, counts[COUNT_SWEEP_AXIS])));
  sort_value[i] = body;
}

/* Bounds in sweep order, so that the sweep reads memory in order. */
SHARED void sweep_gather_item(GLOBAL const row *bounds, GLOBAL const uint *sort_value, GLOBAL row *sweep_bounds, uint i)
{
  store_row(sweep_bounds, 2u * i, load_row(bounds, 2u * sort_value[i]));
  store_row(sweep_bounds, 2u * i + 1u, load_row(bounds, 2u * sort_value[i] + 1u));
}

/* Calls VISIT(a, b), a > b, for the finds of item i: a large body, or place i - large of the sorted list. */
#define SWEEP_SEARCH(i, VISIT)                                                                                       \
  {                                                                                                                  \
    uint large = counts[COUNT_LARGE], small = counts[COUNT_SMALL], axis = counts[COUNT_SWEEP_AXIS];                   \
    uint body = i < large ? i : sort_value[i - large];                                                               \
    box_bounds own = load_bounds(bounds, body);                                                                      \
    for (uint b = 0; b < large && b < body; ++b)                                                                     \
      if (bounds_overlap(own, load_bounds(bounds, b)) && pair_allowed(parameters, body_traits, body_filter, body, b)) VISIT(body, b) \
    real end = as_sorted(along(own.upper, axis));                                                                    \
    for (uint at = i < large ? small : i - large + 1u; at < small; ++at) {                                           \
      box_bounds other = load_bounds(sweep_bounds, at);                                                              \
      if (as_sorted(along(other.lower, axis)) > end) break;                                                          \
      if (!bounds_overlap(own, other)) continue;                                                                     \
      uint found = sort_value[at];                                                                                   \
      uint a = body > found ? body : found, b = body > found ? found : body;                                         \
      if (pair_allowed(parameters, body_traits, body_filter, a, b)) VISIT(a, b)                                      \
    }                                                                                                                \
  }

SHARED void sweep_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits, GLOBAL const uint *body_filter,
                             GLOBAL const row *bounds, GLOBAL const row *sweep_bounds, GLOBAL const uint *sort_value,
                             GLOBAL const uint *counts, GLOBAL uint *sweep_start, uint i)
{
  uint finds = 0;
#define VISIT(a, b) ++finds;
  SWEEP_SEARCH(i, VISIT)
#undef VISIT
  sweep_start[i] = finds;
}

SHARED void sweep_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits, GLOBAL const uint *body_filter,
                             GLOBAL const row *bounds, GLOBAL const row *sweep_bounds, GLOBAL const uint *sort_value,
                             GLOBAL const uint *counts, GLOBAL const uint *sweep_start, GLOBAL ulong *pair_key, uint i)
{
  uint to = sweep_start[i], capacity = counts[CAPACITY_PAIRS];
#define VISIT(a, b) { if (to < capacity) pair_key[to] = (ulong)a << 32 | (ulong)b; ++to; }
  SWEEP_SEARCH(i, VISIT)
#undef VISIT
}

/* The sorted keys as the pair list; where a body's stretch starts is found by the bodies themselves. */
SHARED void sweep_unpack_item(GLOBAL const ulong *pair_key, GLOBAL uint *pair_a, GLOBAL uint *pair_b, uint i)
{
  pair_a[i] = (uint)(pair_key[i] >> 32);
  pair_b[i] = (uint)pair_key[i];
}
SHARED void sweep_starts_item(GLOBAL const uint *pair_a, GLOBAL const uint *counts, GLOBAL uint *pair_start, uint body)
{
  uint low = 0, high = counts[COUNT_PAIRS];
  while (low < high) {
    uint middle = low + (high - low) / 2u;
    if (pair_a[middle] < body) low = middle + 1u;
    else high = middle;
  }
  pair_start[body] = low;
}

#endif
