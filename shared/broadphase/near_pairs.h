/* near_pairs.h - the pairs whose fat boxes overlap, kept from step to step, and those of them whose bounds do: the
 * list.
 *
 *     kept list (neither of the two left its box)  +  what those who left find in both trees  ->  its other side
 *     kept list (bounds overlap)                                                              ->  pair_a, pair_b
 *
 * Steps in which no body left do the second line alone. The kept list has two sides that change places; each owner's
 * stretch is sorted, as that of the pair list is. Of two who both left, the one with the higher number finds the pair.
 * A body that the scene calls large may meet thousands: it does not look for them, they look at it.
 */
#ifndef TANDEM_SHARED_BROADPHASE_NEAR_PAIRS_H
#define TANDEM_SHARED_BROADPHASE_NEAR_PAIRS_H

#include "shared/broadphase/fat_boxes.h"
#include "shared/broadphase/hierarchy_walks.h"
#include "shared/broadphase/near_limits.h"
#include "shared/broadphase/pair_keys.h"
#include "shared/parallel/length.h"

SHARED uint near_capacity(GLOBAL const uint *counts) { return NEAR_PER_PAIR * counts[CAPACITY_PAIRS]; }

/* --- what those who left find -------------------------------------------------------------------------- */

/* Body y looks at large body b. */
SHARED mask finds_large(GLOBAL const uint *body_left, uint large, uint y, uint b)
{
  if (body_left[b] == 0u || y == b) return 0;
  return body_left[y] == 0u || (y < large && b < y);
}

/* Calls VISIT(body, b) for all that body i finds, in whatever order of the two. */
#define NEAR_MEETS(b) \
  (bounds_overlap(search.box, load_bounds(fat_bounds, b)) && pair_allowed(parameters, body_traits, body_filter, i, b))
#define NEAR_SEARCH(i, VISIT)                                                                                         \
  {                                                                                                                   \
    uint large = counts[COUNT_LARGE], looks = body_left[i] != 0u && i >= large ? 1u : 0u;                             \
    hierarchy_search search = {hierarchy_nodes.box, hierarchy_nodes.link, load_bounds(fat_bounds, i), BOUNDLESS};     \
    for (uint b = 0u; b < counts[COUNT_LARGE_LEFT]; ++b)                                                              \
      if (finds_large(body_left, large, i, b) && NEAR_MEETS(b)) VISIT(i, b)                                           \
    for (uint b = 0u; b < looks * counts[COUNT_BOUNDLESS]; ++b)                                                       \
      if (NEAR_MEETS(b)) VISIT(i, b)                                                                                  \
    uint next = looks != 0u ? root_slot(counts) : INDEX_NONE;                                                         \
    for (uint leaf = next_by_skipping(&search, &next); leaf != INDEX_NONE; leaf = next_by_skipping(&search, &next)) { \
      uint b = hierarchy_nodes.leaf_body[leaf / 2u];                                                                  \
      mask is_finder = b < i || body_left[b] == 0u;                                                                   \
      if (b != i && is_finder && pair_allowed(parameters, body_traits, body_filter, i, b)) VISIT(i, b)                \
    }                                                                                                                 \
  }

SHARED void near_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                            GLOBAL const uint *body_filter, GLOBAL const row *fat_bounds, GLOBAL const uint *body_left,
                            read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts, GLOBAL uint *sweep_start,
                            uint i)
{
  uint finds = 0u;
#define VISIT(a, b) ++finds;
  NEAR_SEARCH(i, VISIT)
#undef VISIT
  sweep_start[i] = finds;
}

SHARED void near_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                            GLOBAL const uint *body_filter, GLOBAL const row *fat_bounds, GLOBAL const uint *body_left,
                            read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts,
                            GLOBAL const uint *sweep_start, GLOBAL ulong *near_key, uint i)
{
  uint to = sweep_start[i], capacity = near_capacity(counts);
  if (to == sweep_start[i + 1u]) return; /* most: they need not look again */
#define VISIT(a, b)                                        \
  {                                                        \
    if (to < capacity) near_key[to++] = key_of_pair(a, b); \
  }
  NEAR_SEARCH(i, VISIT)
#undef VISIT
}

/* How many keys there are to sort: those that found room. */
SHARED void count_near_keys_item(GLOBAL const uint *sweep_start, GLOBAL uint *counts, uint i)
{
  (void)i;
  uint found = counts[COUNT_CHANGED] != 0u ? sweep_start[counts[COUNT_CHANGED]] : 0u, capacity = near_capacity(counts);
  counts[COUNT_NEAR_KEYS] = found < capacity ? found : capacity;
  counts[COUNT_NEAR_NEEDED] = found;
}

/* --- the kept list -------------------------------------------------------------------------------------- */

/* Side 0 or 1 of the kept list: first, where the stretches of bodies start; b, the lower numbers of the pairs. */
typedef struct {
  GLOBAL const uint *start, *b;
} near_list;

SHARED uint near_side(GLOBAL const uint *counts) { return counts[COUNT_NEAR_SIDE]; }
SHARED near_list near_list_of(GLOBAL const uint *near_start, GLOBAL const uint *near_b, GLOBAL const uint *counts,
                              uint side)
{
  near_list list = {near_start + side * (counts[COUNT_BODIES] + 1u), near_b + side * near_capacity(counts)};
  return list;
}

/* Calls VISIT(b), ascending, for the partners of body `a`: kept ones where neither left, and new ones. */
#define MERGE_NEAR(a, VISIT)                                                             \
  {                                                                                      \
    near_list kept = near_list_of(near_start, near_b, counts, near_side(counts));        \
    uint keys = counts[COUNT_NEAR_KEYS], key = first_key_of(near_key, keys, a);          \
    uint at = counts[COUNT_KEPT] != 0u && body_left[a] == 0u ? kept.start[a] : 0u;       \
    uint end = counts[COUNT_KEPT] != 0u && body_left[a] == 0u ? kept.start[a + 1u] : 0u; \
    for (; at < end; ++at) {                                                             \
      uint stays = kept.b[at];                                                           \
      if (body_left[stays] != 0u) continue;                                              \
      for (; key < keys && near_key[key] < key_of_pair(a, stays); ++key) {               \
        uint b = (uint)near_key[key];                                                    \
        VISIT(b)                                                                         \
      }                                                                                  \
      VISIT(stays)                                                                       \
    }                                                                                    \
    for (; key < keys && (uint)(near_key[key] >> 32) == a; ++key) {                      \
      uint b = (uint)near_key[key];                                                      \
      VISIT(b)                                                                           \
    }                                                                                    \
  }

SHARED void merge_near_count_item(GLOBAL const uint *body_left, GLOBAL const ulong *near_key,
                                  GLOBAL const uint *near_start, GLOBAL const uint *near_b, GLOBAL const uint *counts,
                                  GLOBAL uint *sweep_start, uint a)
{
  uint partners = 0u;
#define VISIT(b) \
  {              \
    (void)(b);   \
    ++partners;  \
  }
  MERGE_NEAR(a, VISIT)
#undef VISIT
  sweep_start[a] = partners;
}

SHARED void merge_near_write_item(GLOBAL const uint *body_left, GLOBAL const ulong *near_key,
                                  GLOBAL const uint *sweep_start, GLOBAL const uint *counts, GLOBAL uint *near_start,
                                  GLOBAL uint *near_b, uint a)
{
  uint capacity = near_capacity(counts), other = 1u - near_side(counts), to = sweep_start[a];
  GLOBAL uint *start = near_start + other * (counts[COUNT_BODIES] + 1u), *partner = near_b + other * capacity;
  start[a] = to < capacity ? to : capacity;
  if (a + 1u == counts[COUNT_BODIES]) start[a + 1u] = sweep_start[a + 1u] < capacity ? sweep_start[a + 1u] : capacity;
#define VISIT(b)                          \
  {                                       \
    if (to < capacity) partner[to++] = b; \
  }
  MERGE_NEAR(a, VISIT)
#undef VISIT
}

/* After a merge the other side is the kept one. */
SHARED void turn_near_list_item(GLOBAL const uint *sweep_start, GLOBAL uint *counts, uint i)
{
  (void)i;
  if (counts[COUNT_CHANGED] == 0u) return;
  uint merged = sweep_start[counts[COUNT_BODIES]], found = counts[COUNT_NEAR_NEEDED];
  counts[COUNT_NEAR_NEEDED] = merged > found ? merged : found;
  counts[COUNT_NEAR_SIDE] = 1u - near_side(counts);
}

/* --- the pair list -------------------------------------------------------------------------------------- */

/* The partners of body `a` whose bounds overlap its own, packed at the start of its stretch. */
SHARED void filter_near_item(GLOBAL const row *bounds, GLOBAL const uint *near_start, GLOBAL const uint *near_b,
                             GLOBAL const uint *counts, GLOBAL uint *near_found, GLOBAL uint *pair_start, uint a)
{
  near_list kept = near_list_of(near_start, near_b, counts, near_side(counts));
  uint first = kept.start[a], end = kept.start[a + 1u], to = first;
  box_bounds own = load_bounds(bounds, a);
  for (uint at = first; at < end; ++at)
    if (bounds_overlap(own, load_bounds(bounds, kept.b[at]))) near_found[to++] = kept.b[at];
  pair_start[a] = to - first;
}

SHARED void take_near_item(GLOBAL const uint *near_start, GLOBAL const uint *near_found, GLOBAL const uint *pair_start,
                           GLOBAL const uint *counts, GLOBAL uint *pair_a, GLOBAL uint *pair_b, uint a)
{
  uint from = near_start[near_side(counts) * (counts[COUNT_BODIES] + 1u) + a], first = pair_start[a], used = 0u,
       found = pair_start[a + 1u] - first;
  for (uint k = 0u; k < found; ++k)
    used = append_pair(pair_a, pair_b, first, used, counts[CAPACITY_PAIRS], a, near_found[from + k]);
}

/* What found no room grows with the pairs, and all is looked for again. */
SHARED void keep_near_item(GLOBAL uint *counts, uint i)
{
  (void)i;
  uint needed = units_of(counts[COUNT_NEAR_NEEDED], NEAR_PER_PAIR);
  if (needed > counts[CAPACITY_PAIRS] && needed > counts[COUNT_PAIRS_NEEDED]) counts[COUNT_PAIRS_NEEDED] = needed;
  counts[COUNT_KEPT] = needed > counts[CAPACITY_PAIRS] ? 0u : 1u;
}

#endif
