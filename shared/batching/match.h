/* match.h - finds each pair in the cache of the last step, so that it keeps its impulses and its colour.
 *
 * These are the persistent pairs of the 2009 talk. A touching pair that had a colour keeps it: pairs without conflicts
 * among themselves still have none, so only new contacts need a colour. Batchers whose batches follow from the list of
 * contacts alone (`keep` 0) keep the impulses and no colour.
 *
 * In scenes with trees two bodies may have several manifolds, both in this step and in the last. Two manifolds match if
 * the normal of each agrees best with that of the other, so that none is matched twice:
 *
 *      then  1           2         now 1 prefers then 1, and then 1 prefers now 1: a match
 *            ^ ^                   now 2 prefers then 1, which prefers another: new
 *            v  \
 *      now   1   2
 */
#ifndef TANDEM_SHARED_BATCHING_MATCH_H
#define TANDEM_SHARED_BATCHING_MATCH_H

#include "shared/argument_groups.h"
#include "shared/batching/nodes.h"
#include "shared/records.h"

/* Cosine of the angle by which the normal of a manifold may turn in a step. */
#define SAME_MANIFOLD R(0.9)

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

/* The entries first .. end - 1, which belong to one pair of bodies. */
typedef struct {
  uint first, end;
} pair_run;

SHARED pair_run run_of_pair(GLOBAL const uint *pair_a, GLOBAL const uint *pair_b, uint pairs, uint i)
{
  pair_run run = {i, i + 1u};
  while (run.first > 0u && pair_a[run.first - 1u] == pair_a[i] && pair_b[run.first - 1u] == pair_b[i])
    run.first = run.first - 1u;
  while (run.end < pairs && pair_a[run.end] == pair_a[i] && pair_b[run.end] == pair_b[i]) run.end = run.end + 1u;
  return run;
}
SHARED pair_run run_of_cached(GLOBAL const uint *cached_start, GLOBAL const uint *cached_b, uint a, uint first)
{
  pair_run run = {first, first + 1u};
  while (run.end < cached_start[a + 1u] && cached_b[run.end] == cached_b[first]) run.end = run.end + 1u;
  return run;
}

/* The entry of a run whose normal is nearest to `normal`; INDEX_NONE if none is near. The normal is 0 without
 * contact. */
SHARED uint nearest_normal(GLOBAL const float4 *normals, pair_run run, vec3 normal)
{
  uint best = INDEX_NONE;
  real most = SAME_MANIFOLD;
  for (uint k = run.first; k < run.end; ++k) {
    real cosine = dot3(xyz(load_float4(normals, k)), normal);
    if (cosine <= most) continue;
    most = cosine;
    best = k;
  }
  return best;
}

/* The match of manifold i of two bodies among their cached manifolds. */
SHARED uint matching_manifold(GLOBAL const float4 *normals, pair_run now, GLOBAL const float4 *cached_normals,
                              pair_run then, uint i)
{
  if (now.end - now.first == 1u && then.end - then.first == 1u) return then.first;
  uint best = nearest_normal(cached_normals, then, xyz(load_float4(normals, i)));
  if (best == INDEX_NONE) return INDEX_NONE;
  return nearest_normal(normals, now, xyz(load_float4(cached_normals, best))) == i ? best : INDEX_NONE;
}

/* A pair with a trigger is found and reported, but nothing of it is solved. */
SHARED uint has_trigger(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags, uint a, uint b)
{
  return HAS_FEATURE(parameters, TRIGGER) ? is_trigger(body_flags[a] | body_flags[b]) : 0u;
}

SHARED void occupy_color(GLOBAL uint *body_colors, uint body, uint color)
{
  ATOMIC_OR(body_colors + 2u * body + (color >> 5), 1u << (color & 31u));
}

/* Pairs of which nothing is solved are not looked for, because nobody reads what they were. */
SHARED void match_pairs_item(GLOBAL const Parameters *parameters, read_pairs pairs,
                             GLOBAL const float4 *manifold_normal, GLOBAL const uint *manifold_count, read_nodes nodes,
                             read_cached_pairs cached_pairs, GLOBAL uint *counts, GLOBAL uint *pair_cached,
                             GLOBAL uint *pair_color, GLOBAL uint *body_colors, uint keep, uint i)
{
  uint a = pairs.a[i], b = pairs.b[i];
  uint solved = manifold_count[i] > 0u && !has_trigger(parameters, nodes.flags, a, b) ? 1u : 0u;
  uint cached = solved ? find_cached(cached_pairs.start, cached_pairs.b, a, b) : INDEX_NONE;
  if (HAS_FEATURE(parameters, TREES) && cached != INDEX_NONE)
    cached = matching_manifold(manifold_normal, run_of_pair(pairs.a, pairs.b, counts[COUNT_PAIRS], i),
                               cached_pairs.normal, run_of_cached(cached_pairs.start, cached_pairs.b, a, cached), i);
  uint color = cached == INDEX_NONE || keep == 0u ? COLOR_NONE : cached_pairs.color[cached];
  if (!solved) color = COLOR_INACTIVE;
  else if (color >= COLOR_LIMIT) color = COLOR_NONE;
  pair_cached[i] = cached;
  pair_color[i] = color;
  if (color == COLOR_NONE) ATOMIC_ADD(counts + COUNT_UNCOLORED, 1u);
  if (color >= COLOR_LIMIT) return;
  if (body_type_of(nodes.flags[a]) == (uint)BODY_TYPE_DYNAMIC)
    occupy_color(body_colors, node_of(parameters, nodes.link, a), color);
  if (body_type_of(nodes.flags[b]) == (uint)BODY_TYPE_DYNAMIC)
    occupy_color(body_colors, node_of(parameters, nodes.link, b), color);
}

#endif
