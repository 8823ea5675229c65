/* finds.h - one body's search for its pairs, and the list that its finds go to.
 *
 * A broadphase runs the same search twice: a kernel that counts says how many finds each item has, a scan turns the
 * counts into places, and a kernel that writes puts the finds there. Both call the same function with another list:
 *
 *     count kernel    search(..., list)     list counts, and keeps the first FINDS_KEPT finds
 *     write kernel    search(..., list)     list writes partners, or keys of pairs, as far as there is room
 *
 * Most bodies have few neighbours. Where the first few finds are all of them, the write kernel takes those that the
 * count kernel kept, and does not search again.
 */
#ifndef TANDEM_SHARED_BROADPHASE_FINDS_H
#define TANDEM_SHARED_BROADPHASE_FINDS_H

#include "shared/broadphase/overlap.h"

#define FINDS_KEPT 8u

/* --- who searches ---------------------------------------------------------------------------------------- */

/* The body of item i: one of the first bodies, or one of the others in their sorted order. Neighbours in the launch are
 * then neighbours in space. */
SHARED uint searching_body(GLOBAL const uint *sorted_body, uint first, uint i)
{
  return i < first ? i : sorted_body[i - first];
}

/* The body whose pairs are looked for, its box, and the tables that say whom it may meet. */
typedef struct {
  GLOBAL const Parameters *parameters;
  GLOBAL const uint *body_traits, *body_filter;
  GLOBAL const row *bounds;
  uint body;
  box_bounds box;
} pair_search;

SHARED pair_search search_of_body(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                                  GLOBAL const uint *body_filter, GLOBAL const row *bounds, uint body)
{
  pair_search search = {parameters, body_traits, body_filter, bounds, body, load_bounds(bounds, body)};
  return search;
}

SHARED mask may_meet(const pair_search *search, uint other)
{
  return pair_allowed(search->parameters, search->body_traits, search->body_filter, search->body, other);
}

SHARED mask meets(const pair_search *search, uint other)
{
  return bounds_overlap(search->box, load_bounds(search->bounds, other)) && may_meet(search, other);
}

/* --- where its finds go ------------------------------------------------------------------------------------ */

enum { FINDS_AS_BODIES, FINDS_AS_KEYS };

/* The finds are written from place `at` on, as far as `capacity` allows. `at` counts those without room as well: the
 * step then runs again with room for them. */
typedef struct {
  uint kind; /* FINDS_AS_; a constant in each kernel, so that one branch of add_find is left there */
  GLOBAL uint *bodies;
  GLOBAL ulong *keys;
  uint at, capacity;
} find_list;

SHARED find_list no_finds(void)
{
  find_list list = {FINDS_AS_BODIES, 0, 0, 0u, 0u};
  return list;
}
SHARED find_list first_finds(GLOBAL uint *finds, uint i)
{
  find_list list = {FINDS_AS_BODIES, finds + FINDS_KEPT * i, 0, 0u, FINDS_KEPT};
  return list;
}
SHARED find_list finds_as_bodies(GLOBAL uint *bodies, uint at, uint capacity)
{
  find_list list = {FINDS_AS_BODIES, bodies, 0, at, capacity};
  return list;
}
SHARED find_list finds_as_keys(GLOBAL ulong *keys, uint at, uint capacity)
{
  find_list list = {FINDS_AS_KEYS, 0, keys, at, capacity};
  return list;
}

/* Sorted keys are in the order of the pair list. */
SHARED ulong key_of_pair(uint one, uint other)
{
  return one > other ? (ulong)one << 32 | (ulong)other : (ulong)other << 32 | (ulong)one;
}

/* Every search reports a pair here. */
SHARED void add_find(find_list *list, uint body, uint other)
{
  if (list->at < list->capacity) {
    if (list->kind == (uint)FINDS_AS_KEYS) list->keys[list->at] = key_of_pair(body, other);
    else list->bodies[list->at] = other;
  }
  list->at = list->at + 1u;
}

/* The finds of item i that the count kernel kept. */
SHARED void add_kept_finds(find_list *list, uint body, GLOBAL const uint *finds, uint i, uint count)
{
  for (uint k = 0u; k < count; ++k) add_find(list, body, finds[FINDS_KEPT * i + k]);
}

/* The bodies below `end` come first of all, and are tested one by one: half-spaces and large bodies. */
SHARED void find_among_first(const pair_search *search, uint end, find_list *list)
{
  for (uint b = 0u; b < end && b < search->body; ++b)
    if (meets(search, b)) add_find(list, search->body, b);
}

/* Finishes the range of a body that found only pairs of its own: its partners stand in pairs.b. */
SHARED void finish_own_pairs(write_pairs pairs, uint body, uint first, uint end, uint capacity)
{
  uint last = end < capacity ? end : capacity;
  for (uint at = first; at < last; ++at) pairs.a[at] = body;
  if (first < last) sort_stretch(pairs.b + first, last - first);
}

#endif
