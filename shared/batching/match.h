/* match.h - finds each pair in the cache of the last step: its impulses and its colour live on.
 *
 * Persistent pairs of the 2009 talk. A touching pair that had a colour keeps it: pairs that were free of
 * conflict among themselves still are, so only new contacts need colouring. Batchers whose batches follow from the
 * list of contacts alone (`keep` 0) take over the impulses and no colour.
 */
#ifndef TANDEM_SHARED_BATCHING_MATCH_H
#define TANDEM_SHARED_BATCHING_MATCH_H

#include "shared/records.h"

SHARED uint find_cached(GLOBAL const uint *cached_start, GLOBAL const uint *cached_b, uint a, uint b)
{
  uint low = cached_start[a], end = cached_start[a + 1u], high = end;
  while (low < high) {
    uint middle = low + (high - low) / 2u;
    if (cached_b[middle] < b) low = middle + 1u;
    else high = middle;
  }
  return low < end && cached_b[low] == b ? low : INDEX_NONE;
}

/* A pair with a trigger is found and reported, but nothing of it is solved. */
SHARED uint has_trigger(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits, uint a, uint b)
{
  return HAS_FEATURE(parameters, FEATURE_TRIGGER) ? is_trigger(body_traits[a] | body_traits[b]) : 0u;
}

SHARED void occupy_color(GLOBAL uint *body_colors, uint body, uint color) { ATOMIC_OR(body_colors + 2u * body + (color >> 5), 1u << (color & 31u)); }

SHARED void match_pairs_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a, GLOBAL const uint *pair_b,
                             GLOBAL const uint *manifold_count, GLOBAL const uint *body_traits, GLOBAL const uint *cached_start,
                             GLOBAL const uint *cached_b, GLOBAL const uint *cached_color, GLOBAL uint *counts, GLOBAL uint *pair_cached, GLOBAL uint *pair_color,
                             GLOBAL uint *body_colors, uint keep, uint i)
{
  uint a = pair_a[i], b = pair_b[i];
  uint cached = find_cached(cached_start, cached_b, a, b);
  uint color = cached == INDEX_NONE || keep == 0u ? COLOR_NONE : cached_color[cached];
  if (manifold_count[i] == 0u || has_trigger(parameters, body_traits, a, b)) color = COLOR_INACTIVE;
  else if (color >= COLOR_LIMIT) color = COLOR_NONE;
  pair_cached[i] = cached;
  pair_color[i] = color;
  if (color == COLOR_NONE) ATOMIC_ADD(counts + COUNT_UNCOLORED, 1u);
  if (color >= COLOR_LIMIT) return;
  if (motion_of(body_traits[a]) == (uint)MOTION_DYNAMIC) occupy_color(body_colors, a, color);
  if (motion_of(body_traits[b]) == (uint)MOTION_DYNAMIC) occupy_color(body_colors, b, color);
}

#endif
