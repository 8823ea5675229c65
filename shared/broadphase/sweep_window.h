/* sweep_window.h - the sweep that the talk ends with (GS-4150 slides 23-26): boxes in local memory, several work-items
 * for each body.
 *
 *   sorted list   . . . . [ 128 bodies of a group ] . . . . . . . . . . . . . .
 *                         |<- window ->|<- window ->|<- window ->|   until the last of their intervals ends
 *
 * A group loads the boxes of a window once for all its bodies. Four work-items share the tests of each body, which
 * shortens long intervals. A body whose interval has ended skips the remaining windows (local early-out). The talk
 * appends to a private buffer and then to the list; here the neighbors of each share are counted, scanned and written.
 */
#ifndef TANDEM_SHARED_BROADPHASE_SWEEP_WINDOW_H
#define TANDEM_SHARED_BROADPHASE_SWEEP_WINDOW_H

#include "shared/broadphase/pair_keys.h"
#include "shared/broadphase/sweep_and_prune.h"
#include "shared/broadphase/sweep_limits.h"

#define SWEEP_LOCAL_WORDS (SWEEP_BLOCK * SWEEP_SHARES + 6u * SWEEP_WINDOW)

/* Stores the end of the interval of the body at place i: the first place whose interval starts behind it. */
SHARED void sweep_ends_item(GLOBAL const float4 *grid, GLOBAL const float4 *sweep_bounds, GLOBAL const uint *sort_key,
                            GLOBAL const uint *counts, GLOBAL uint *sweep_end, uint principal, uint i)
{
  uint end = sweep_key(sweep_interval(load_bounds(sweep_bounds, i), grid, counts, principal).end);
  sweep_end[i] = upper_bound_of(sort_key, counts[COUNT_SMALL], end);
}

/* Stores the end of the last interval of a block. */
SHARED void sweep_blocks_item(GLOBAL const uint *sweep_end, GLOBAL const uint *counts, GLOBAL uint *sweep_block, uint i)
{
  uint large = counts[COUNT_LARGE], last = 0u;
  for (uint k = i * SWEEP_BLOCK; k < (i + 1u) * SWEEP_BLOCK && k < counts[COUNT_BODIES]; ++k)
    if (k >= large && sweep_end[k - large] > last) last = sweep_end[k - large];
  sweep_block[i] = last;
}

/* The state of a group's sweep. writes: where the keys are written; 0 to count only. */
typedef struct {
  GLOBAL const Parameters *parameters;
  GLOBAL const uint *flags, *filters;
  GLOBAL const float4 *bounds, *sweep_bounds;
  GLOBAL const uint *sort_value, *sweep_end, *counts;
  GLOBAL ulong *pair_key;
  LOCAL uint *tally;  /* of each share: pairs found so far, or where its next pair goes */
  LOCAL real *window; /* six planes */
} window_sweep;

SHARED void found_pair(const window_sweep *sweep, uint share, uint first, uint second)
{
  if (!pair_allowed(sweep->parameters, sweep->flags, sweep->filters, first, second)) return;
  uint at = sweep->tally[share];
  if (sweep->pair_key) {
    if (at >= sweep->counts[CAPACITY_PAIRS]) return; /* already counted; the step runs again with a larger capacity */
    sweep->pair_key[at] = key_of_pair(first, second);
  }
  sweep->tally[share] = at + 1u;
}

SHARED void load_window(const window_sweep *sweep, uint place, uint item)
{
  box_bounds box = load_bounds(sweep->sweep_bounds, place);
  sweep->window[item] = box.lower.x;
  sweep->window[SWEEP_WINDOW + item] = box.lower.y;
  sweep->window[2u * SWEEP_WINDOW + item] = box.lower.z;
  sweep->window[3u * SWEEP_WINDOW + item] = box.upper.x;
  sweep->window[4u * SWEEP_WINDOW + item] = box.upper.y;
  sweep->window[5u * SWEEP_WINDOW + item] = box.upper.z;
}
SHARED box_bounds box_in_window(const window_sweep *sweep, uint item)
{
  LOCAL const real *w = sweep->window;
  box_bounds box = {make_vec3(w[item], w[SWEEP_WINDOW + item], w[2u * SWEEP_WINDOW + item]),
                    make_vec3(w[3u * SWEEP_WINDOW + item], w[4u * SWEEP_WINDOW + item], w[5u * SWEEP_WINDOW + item])};
  return box;
}

/* Tests a share of the large bodies before body i. */
SHARED void sweep_large(const window_sweep *sweep, uint share, uint i)
{
  uint large = sweep->counts[COUNT_LARGE], body = i < large ? i : sweep->sort_value[i - large];
  box_bounds own = load_bounds(sweep->bounds, body);
  for (uint b = share % SWEEP_SHARES; b < large && b < body; b += SWEEP_SHARES)
    if (overlaps_rows(own, sweep->bounds, b)) found_pair(sweep, share, body, b);
}

/* Tests a share of the window that starts at `start` against the body at `place`. */
SHARED void sweep_in_window(const window_sweep *sweep, uint share, uint place, uint start)
{
  uint end = sweep->sweep_end[place] < start + SWEEP_WINDOW ? sweep->sweep_end[place] : start + SWEEP_WINDOW;
  uint at = start + share % SWEEP_SHARES;
  if (end <= at || place + 1u >= end) return;
  box_bounds own = load_bounds(sweep->sweep_bounds, place);
  for (; at < end; at += SWEEP_SHARES)
    if (at > place && bounds_overlap(own, box_in_window(sweep, at - start)))
      found_pair(sweep, share, sweep->sort_value[place], sweep->sort_value[at]);
}

/* begin: the place of each share's first pair; 0 to count from 0. */
SHARED void sweep_group(const window_sweep *sweep, GLOBAL const uint *begin, uint block_end, uint group)
{
  uint bodies = sweep->counts[COUNT_BODIES], large = sweep->counts[COUNT_LARGE], small = sweep->counts[COUNT_SMALL],
       first = group * SWEEP_BLOCK;
  uint width = first >= bodies ? 0u : bodies - first < SWEEP_BLOCK ? bodies - first : SWEEP_BLOCK;
  FOR_EACH_ITEM(share, width * SWEEP_SHARES)
  {
    sweep->tally[share] = begin ? begin[first * SWEEP_SHARES + share] : 0u;
    sweep_large(sweep, share, first + share / SWEEP_SHARES);
  }
  for (uint start = first > large ? first - large : 0u; start < block_end; start += SWEEP_WINDOW) {
    uint loaded = small - start < SWEEP_WINDOW ? small - start : SWEEP_WINDOW;
    FOR_EACH_ITEM(item, loaded) load_window(sweep, start + item, item);
    FOR_EACH_ITEM(share, width * SWEEP_SHARES)
    {
      uint i = first + share / SWEEP_SHARES;
      if (i >= large) sweep_in_window(sweep, share, i - large, start);
    }
  }
}

SHARED void window_count_group(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                               GLOBAL const uint *body_filter, GLOBAL const float4 *bounds,
                               read_sweep_intervals sweep_intervals, GLOBAL const uint *counts,
                               GLOBAL uint *share_start, LOCAL uint *local_memory, uint group)
{
  window_sweep sweep = {parameters,
                        body_flags,
                        body_filter,
                        bounds,
                        sweep_intervals.bounds,
                        sweep_intervals.body,
                        sweep_intervals.end,
                        counts,
                        0,
                        local_memory,
                        (LOCAL real *)(local_memory + SWEEP_BLOCK * SWEEP_SHARES)};
  uint first = group * SWEEP_BLOCK, bodies = counts[COUNT_BODIES];
  uint shares = first >= bodies ? 0u : (bodies - first < SWEEP_BLOCK ? bodies - first : SWEEP_BLOCK) * SWEEP_SHARES;
  sweep_group(&sweep, 0, shares > 0u ? sweep_intervals.block[group] : 0u, group);
  FOR_EACH_ITEM(share, shares) share_start[first * SWEEP_SHARES + share] = sweep.tally[share];
}

SHARED void window_write_group(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                               GLOBAL const uint *body_filter, GLOBAL const float4 *bounds,
                               read_sweep_intervals sweep_intervals, GLOBAL const uint *counts,
                               GLOBAL const uint *share_start, GLOBAL ulong *pair_key, LOCAL uint *local_memory,
                               uint group)
{
  window_sweep sweep = {parameters,
                        body_flags,
                        body_filter,
                        bounds,
                        sweep_intervals.bounds,
                        sweep_intervals.body,
                        sweep_intervals.end,
                        counts,
                        pair_key,
                        local_memory,
                        (LOCAL real *)(local_memory + SWEEP_BLOCK * SWEEP_SHARES)};
  sweep_group(&sweep, share_start, group * SWEEP_BLOCK < counts[COUNT_BODIES] ? sweep_intervals.block[group] : 0u,
              group);
}

#endif
