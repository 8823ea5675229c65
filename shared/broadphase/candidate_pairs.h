/* candidate_pairs.h - keeps the list of pairs whose fat boxes overlap from step to step, and selects those whose bounds
 * overlap: the pair list.
 *
 *     kept list (neither body left its box)  +  new pairs of bodies that left theirs  ->  other side of the kept list
 *     kept list (bounds overlap)                                                      ->  pair_a, pair_b
 *
 * A step in which no body left its fat box only does the second line. The kept list has two sides: one is read while
 * the other is written, and then they are swapped. Each owner's range is sorted, as in the pair list. If both bodies of
 * a pair left their fat boxes, the body with the higher index reports the pair, so that it is reported once. A body
 * that the scene calls large may overlap thousands of others. Each of these tests the large body, so that no single
 * work-item has to find all of them.
 */
#ifndef TANDEM_SHARED_BROADPHASE_CANDIDATE_PAIRS_H
#define TANDEM_SHARED_BROADPHASE_CANDIDATE_PAIRS_H

#include "shared/broadphase/fat_aabbs.h"
#include "shared/broadphase/hierarchy_walks.h"
#include "shared/broadphase/pair_keys.h"
#include "shared/broadphase/search_slots.h"
#include "shared/parallel/length.h"

SHARED uint candidate_capacity(GLOBAL const uint *counts) { return counts[CAPACITY_CANDIDATES]; }

/* --- what those who left find -------------------------------------------------------------------------- */

/* Whether body y must test the pair with the large body b, which is new only if b left its fat box. */
SHARED mask searches_large(GLOBAL const uint *body_left, uint large, uint y, uint b)
{
  if (body_left[b] == 0u || y == b) return 0;
  return body_left[y] == 0u || (y < large && b < y);
}

/* The leaves of the tree whose boxes body i overlaps. If both bodies left their fat boxes, the body with the higher
 * index reports the pair, so that it is reported once. */
FORCE_INLINE uint find_among_leaves(const pair_search *search, GLOBAL const uint *body_left,
                                    read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts,
                                    const find_list *list, uint at)
{
  searched_tree tree = {hierarchy_nodes.box, hierarchy_nodes.link, UNBOUNDED};
  uint next = root_slot(counts), i = search->body;
  for (uint leaf = next_by_skipping(search, &tree, &next); leaf != INDEX_NONE;
       leaf = next_by_skipping(search, &tree, &next)) {
    uint b = hierarchy_nodes.leaf_body[leaf / 2u];
    mask reports_pair = b < i || body_left[b] == 0u;
    if (b != i && reports_pair && may_meet(search, b)) at = add_find(list, at, i, b);
  }
  return at;
}

/* The pairs that the searching body finds. Its box and those of the others are fat. */
FORCE_INLINE uint search_near(const pair_search *search, GLOBAL const uint *body_left,
                              read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts, const find_list *list,
                              uint at)
{
  uint i = search->body, large = counts[COUNT_LARGE];
  for (uint b = 0u; b < counts[COUNT_LARGE_LEFT]; ++b)
    if (searches_large(body_left, large, i, b) && meets(search, b)) at = add_find(list, at, i, b);
  if (body_left[i] == 0u || i < large) return at;
  for (uint b = 0u; b < counts[COUNT_UNBOUNDED]; ++b)
    if (meets(search, b)) at = add_find(list, at, i, b);
  return find_among_leaves(search, body_left, hierarchy_nodes, counts, list, at);
}

SHARED void candidate_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                 GLOBAL const uint *body_filter, GLOBAL const float4 *fat_bounds,
                                 GLOBAL const uint *body_left, read_hierarchy_nodes hierarchy_nodes,
                                 GLOBAL const uint *counts, GLOBAL uint *key_start, GLOBAL ulong *candidate_key_other,
                                 uint i)
{
  pair_search search = search_of_body(parameters, body_flags, body_filter, fat_bounds, i);
  search_slot slot = slot_of_search(body_left, counts, candidate_capacity(counts), i);
  find_list list = finds_as_keys(candidate_key_other + slot.first, slot.size);
  key_start[i] = search_near(&search, body_left, hierarchy_nodes, counts, &list, 0u);
}

SHARED void candidate_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                 GLOBAL const uint *body_filter, GLOBAL const float4 *fat_bounds,
                                 GLOBAL const uint *body_left, read_hierarchy_nodes hierarchy_nodes,
                                 GLOBAL const uint *counts, GLOBAL const uint *key_start,
                                 GLOBAL const ulong *candidate_key_other, GLOBAL ulong *candidate_key, uint i)
{
  uint first = key_start[i], finds = key_start[i + 1u] - first, capacity = candidate_capacity(counts);
  if (finds == 0u) return;
  search_slot slot = slot_of_search(body_left, counts, capacity, i);
  if (finds <= slot.size) {
    for (uint k = 0u; k < finds && first + k < capacity; ++k)
      candidate_key[first + k] = candidate_key_other[slot.first + k];
    return;
  }
  pair_search search = search_of_body(parameters, body_flags, body_filter, fat_bounds, i);
  find_list list = finds_as_keys(candidate_key, capacity);
  search_near(&search, body_left, hierarchy_nodes, counts, &list, first);
}

/* The number of keys to sort is limited by their capacity. */
SHARED void count_candidate_keys_item(GLOBAL const uint *key_start, GLOBAL uint *counts, uint i)
{
  (void)i;
  uint found = counts[COUNT_CHANGED] != 0u ? key_start[counts[COUNT_CHANGED]] : 0u,
       capacity = candidate_capacity(counts);
  counts[COUNT_CANDIDATE_KEYS] = found < capacity ? found : capacity;
  counts[COUNT_CANDIDATES_NEEDED] = found;
}

/* --- the kept list -------------------------------------------------------------------------------------- */

/* Side 0 or 1 of the kept list. start[a] is where the range of body `a` starts in b, which holds the lower numbers of
 * its pairs. */
typedef struct {
  GLOBAL const uint *start, *b;
} candidate_list;

SHARED uint candidate_side(GLOBAL const uint *counts) { return counts[COUNT_CANDIDATE_SIDE]; }
SHARED candidate_list candidate_list_of(GLOBAL const uint *candidate_start, GLOBAL const uint *candidate_b,
                                        GLOBAL const uint *counts, uint side)
{
  candidate_list list = {candidate_start + side * (counts[COUNT_BODIES] + 1u),
                         candidate_b + side * candidate_capacity(counts)};
  return list;
}

/* The partners of body `a` that did not leave. Each is reported, and stays if it is counted, because a processor cannot
 * foresee which of them left. */
FORCE_INLINE uint keep_near(GLOBAL const uint *body_left, candidate_list kept, uint first, uint end, uint a,
                            const find_list *list, uint at)
{
  for (uint k = first; k < end; ++k) {
    uint stays = kept.b[k];
    add_find(list, at, a, stays);
    at += body_left[stays] == 0u ? 1u : 0u;
  }
  return at;
}

/* The same with new keys of the body, the first of which is `key`. */
FORCE_INLINE uint merge_keys(GLOBAL const uint *body_left, GLOBAL const ulong *candidate_key, uint key, uint keys,
                             candidate_list kept, uint first, uint end, uint a, const find_list *list, uint at)
{
  for (uint k = first; k < end; ++k) {
    uint stays = kept.b[k];
    if (body_left[stays] != 0u) continue;
    for (; key < keys && candidate_key[key] < key_of_pair(a, stays); ++key)
      at = add_find(list, at, a, (uint)candidate_key[key]);
    at = add_find(list, at, a, stays);
  }
  for (; key < keys && (uint)(candidate_key[key] >> 32) == a; ++key)
    at = add_find(list, at, a, (uint)candidate_key[key]);
  return at;
}

/* The partners of body `a`, ascending: those kept, if neither of the two left, and those newly found. */
FORCE_INLINE uint merge_near(GLOBAL const uint *body_left, GLOBAL const ulong *candidate_key, candidate_list kept,
                             GLOBAL const uint *counts, uint a, const find_list *list, uint at)
{
  uint keys = counts[COUNT_CANDIDATE_KEYS], key = first_key_of(candidate_key, keys, a);
  mask keeps = counts[COUNT_KEPT] != 0u && body_left[a] == 0u;
  uint first = keeps ? kept.start[a] : 0u, end = keeps ? kept.start[a + 1u] : 0u;
  if (key == keys || (uint)(candidate_key[key] >> 32) != a) return keep_near(body_left, kept, first, end, a, list, at);
  return merge_keys(body_left, candidate_key, key, keys, kept, first, end, a, list, at);
}

SHARED void merge_candidate_count_item(GLOBAL const uint *body_left, GLOBAL const ulong *candidate_key,
                                       GLOBAL const uint *candidate_start, GLOBAL const uint *candidate_b,
                                       GLOBAL const uint *counts, GLOBAL uint *key_start, uint a)
{
  find_list list = no_neighbors();
  candidate_list kept = candidate_list_of(candidate_start, candidate_b, counts, candidate_side(counts));
  key_start[a] = merge_near(body_left, candidate_key, kept, counts, a, &list, 0u);
}

SHARED void merge_candidate_write_item(GLOBAL const uint *body_left, GLOBAL const ulong *candidate_key,
                                       GLOBAL const uint *key_start, GLOBAL const uint *counts,
                                       GLOBAL uint *candidate_start, GLOBAL uint *candidate_b, uint a)
{
  uint capacity = candidate_capacity(counts), side = candidate_side(counts), to = key_start[a], end = key_start[a + 1u];
  GLOBAL uint *start = candidate_start + (1u - side) * (counts[COUNT_BODIES] + 1u);
  start[a] = to < capacity ? to : capacity;
  if (a + 1u == counts[COUNT_BODIES]) start[a + 1u] = end < capacity ? end : capacity;
  find_list list = finds_as_bodies(candidate_b + (1u - side) * capacity, end < capacity ? end : capacity);
  merge_near(body_left, candidate_key, candidate_list_of(candidate_start, candidate_b, counts, side), counts, a, &list,
             to);
}

/* A merge makes the other side the kept one. */
SHARED void swap_candidate_lists_item(GLOBAL const uint *key_start, GLOBAL uint *counts, uint i)
{
  (void)i;
  if (counts[COUNT_CHANGED] == 0u) return;
  uint merged = key_start[counts[COUNT_BODIES]], found = counts[COUNT_CANDIDATES_NEEDED];
  counts[COUNT_CANDIDATES_NEEDED] = merged > found ? merged : found;
  counts[COUNT_CANDIDATE_SIDE] = 1u - candidate_side(counts);
}

/* --- the pair list -------------------------------------------------------------------------------------- */

/* Moves the partners of body `a` whose bounds overlap its own to the start of its range. Each partner is written and
 * stays if it is counted, because a processor cannot foresee which of them overlap. */
SHARED void filter_candidates_item(GLOBAL const float4 *bounds, GLOBAL const uint *candidate_start,
                                   GLOBAL const uint *candidate_b, GLOBAL const uint *counts,
                                   GLOBAL uint *candidate_found, GLOBAL uint *pair_start, uint a)
{
  candidate_list kept = candidate_list_of(candidate_start, candidate_b, counts, candidate_side(counts));
  uint first = kept.start[a], end = kept.start[a + 1u], to = first;
  box_bounds own = load_bounds(bounds, a);
  for (uint at = first; at < end; ++at) {
    uint b = kept.b[at];
    candidate_found[to] = b;
    to += overlaps_body_at_once(own, bounds, b) ? 1u : 0u;
  }
  pair_start[a] = to - first;
}

SHARED void take_candidates_item(GLOBAL const uint *candidate_start, GLOBAL const uint *candidate_found,
                                 GLOBAL const uint *pair_start, GLOBAL const uint *counts, GLOBAL uint *pair_a,
                                 GLOBAL uint *pair_b, uint a)
{
  uint from = candidate_start[candidate_side(counts) * (counts[COUNT_BODIES] + 1u) + a], first = pair_start[a],
       used = 0u, found = pair_start[a + 1u] - first;
  for (uint k = 0u; k < found; ++k)
    used = append_pair(pair_a, pair_b, first, used, counts[CAPACITY_PAIRS], a, candidate_found[from + k]);
}

/* If a list exceeded its capacity, which then grows, nothing is kept. The step runs again and finds all pairs anew. */
SHARED void keep_candidates_item(GLOBAL uint *counts, uint i)
{
  (void)i;
  counts[COUNT_KEPT] = counts[COUNT_CANDIDATES_NEEDED] > candidate_capacity(counts) ? 0u : 1u;
}

#endif
