/* neighbors.h - the search of one body for its pairs, and the list of its finds.
 *
 * A broadphase runs the same search twice. A count kernel counts the finds of each item, a scan turns the counts into
 * places, and a write kernel stores the neighbors there. Both call the same function with another list:
 *
 *     count kernel    search(..., list)     list counts, and keeps the first NEIGHBORS_KEPT finds
 *     write kernel    search(..., list)     list writes partners, or keys of pairs, up to its capacity
 *
 * Most bodies have few neighbours. If the count kernel could keep all finds of an item, the write kernel takes those
 * and does not search again.
 */
#ifndef TANDEM_SHARED_BROADPHASE_NEIGHBORS_H
#define TANDEM_SHARED_BROADPHASE_NEIGHBORS_H

#include "shared/broadphase/overlap.h"

#define NEIGHBORS_KEPT 8u

/* --- who searches ---------------------------------------------------------------------------------------- */

/* The body of item i: one of the first bodies, or one of the others in their sorted order. Neighbours in a launch are
 * then neighbours in space. */
SHARED uint searching_body(GLOBAL const uint *sorted_body, uint first, uint i)
{
  return i < first ? i : sorted_body[i - first];
}

/* The searching body, its box, and the tables that decide which bodies it may meet. */
typedef struct {
  GLOBAL const Parameters *parameters;
  GLOBAL const uint *body_flags, *body_filter;
  GLOBAL const float4 *bounds;
  uint body;
  box_bounds box;
} pair_search;

FORCE_INLINE pair_search search_of_body(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                        GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, uint body)
{
  pair_search search = {parameters, body_flags, body_filter, bounds, body, load_bounds(bounds, body)};
  return search;
}

FORCE_INLINE mask may_meet(const pair_search *search, uint other)
{
  return pair_allowed(search->parameters, search->body_flags, search->body_filter, search->body, other);
}

FORCE_INLINE mask meets(const pair_search *search, uint other)
{
  return overlaps_rows(search->box, search->bounds, other) && may_meet(search, other);
}

/* --- where its finds go ------------------------------------------------------------------------------------ */

enum { FINDS_AS_BODIES, FINDS_AS_PAIRS, FINDS_AS_KEYS };

/* Finds are written up to `capacity` and only counted beyond it; the step then runs again with a larger one. The place
 * of the next find is not a member: a search takes it and returns it, so that it stays in a register. */
typedef struct {
  uint kind; /* FINDS_AS_; a constant in each kernel, so that add_find has no branch on it there */
  GLOBAL uint *owners, *bodies;
  GLOBAL ulong *keys;
  uint capacity;
} find_list;

SHARED find_list no_neighbors(void)
{
  find_list list = {FINDS_AS_BODIES, 0, 0, 0, 0u};
  return list;
}
SHARED find_list first_neighbors(GLOBAL uint *neighbors, uint i)
{
  find_list list = {FINDS_AS_BODIES, 0, neighbors + NEIGHBORS_KEPT * i, 0, NEIGHBORS_KEPT};
  return list;
}
SHARED find_list finds_as_bodies(GLOBAL uint *bodies, uint capacity)
{
  find_list list = {FINDS_AS_BODIES, 0, bodies, 0, capacity};
  return list;
}
SHARED find_list finds_as_pairs(write_pairs pairs, uint capacity)
{
  find_list list = {FINDS_AS_PAIRS, pairs.a, pairs.b, 0, capacity};
  return list;
}
SHARED find_list finds_as_keys(GLOBAL ulong *keys, uint capacity)
{
  find_list list = {FINDS_AS_KEYS, 0, 0, keys, capacity};
  return list;
}

/* Sorted keys are in the order of the pair list. */
SHARED ulong key_of_pair(uint one, uint other)
{
  return one > other ? (ulong)one << 32 | (ulong)other : (ulong)other << 32 | (ulong)one;
}

/* Every search reports its pairs here. at: the place of this find; the function returns that of the next. */
FORCE_INLINE uint add_find(const find_list *list, uint at, uint body, uint other)
{
  if (at < list->capacity) {
    if (list->kind == (uint)FINDS_AS_KEYS) list->keys[at] = key_of_pair(body, other);
    else list->bodies[at] = other;
    if (list->kind == (uint)FINDS_AS_PAIRS) list->owners[at] = body;
  }
  return at + 1u;
}

/* Tests the bodies below `end`, which come first of all, one by one: half-spaces and large bodies. */
FORCE_INLINE uint find_among_first(const pair_search *search, uint end, const find_list *list, uint at)
{
  for (uint b = 0u; b < end && b < search->body; ++b)
    if (meets(search, b)) at = add_find(list, at, search->body, b);
  return at;
}

/* --- finds that the count kernel kept ---------------------------------------------------------------------- */

/* The neighbors of item i, which are few, as keys from place `first` to `end`. */
SHARED void write_kept_keys(GLOBAL const uint *neighbors, uint i, uint body, GLOBAL ulong *pair_key, uint first,
                            uint end, uint capacity)
{
  for (uint k = 0u; k < end - first; ++k)
    if (first + k < capacity) pair_key[first + k] = key_of_pair(body, neighbors[NEIGHBORS_KEPT * i + k]);
}

/* Writes the kept neighbors as pairs of their owner, for a body that finds only pairs of its own. */
SHARED void write_kept_pairs(GLOBAL const uint *neighbors, uint i, uint body, write_pairs pairs, uint first, uint end,
                             uint capacity)
{
  uint used = 0u;
  for (uint k = 0u; k < end - first; ++k)
    used = append_pair(pairs.a, pairs.b, first, used, capacity, body, neighbors[NEIGHBORS_KEPT * i + k]);
}

/* Finishes the range of such a body: sorts its partners, up to the capacity. */
SHARED void sort_own_pairs(write_pairs pairs, uint first, uint end, uint capacity)
{
  uint last = end < capacity ? end : capacity;
  if (first < last) sort_range(pairs.b + first, last - first);
}

#endif
