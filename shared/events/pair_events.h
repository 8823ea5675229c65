/* pair_events.h - the persistence of the pair list: which pairs of bodies came near in a step, stay near, or ceased to
 * be near.
 *
 * The merge of list.h runs over the pairs of this step and of the last committed one, by their presence alone; list.h
 * decides whether they touch. In scenes with trees a pair of bodies is near if some of its parts are. A world of a
 * batch that was reset has pairs of no body in its cache (commands/reset_worlds.h), which are none.
 */
#ifndef TANDEM_SHARED_EVENTS_PAIR_EVENTS_H
#define TANDEM_SHARED_EVENTS_PAIR_EVENTS_H

#include "shared/events/list.h"

/* The next pair of bodies of either list, each pair once, with the kind of its event. */
SHARED pair_change next_pair(pair_walk *walk, GLOBAL const uint *pair_b, GLOBAL const uint *cached_b)
{
  uint b_now = walk->now < walk->now_end ? pair_b[walk->now] : INDEX_NONE;
  uint b_before = walk->before < walk->before_end ? cached_b[walk->before] : INDEX_NONE;
  pair_change change = {b_now < b_before ? b_now : b_before, walk->now, walk->now, EVENT_PERSIST};
  if (b_now < b_before) change.kind = EVENT_BEGIN;
  if (b_before < b_now) change.kind = EVENT_END;
  while (walk->now < walk->now_end && pair_b[walk->now] == change.b) ++walk->now;
  while (walk->before < walk->before_end && cached_b[walk->before] == change.b) ++walk->before;
  return change;
}

SHARED void count_pair_events_item(GLOBAL const uint *pair_start, GLOBAL const uint *pair_b,
                                   GLOBAL const uint *cached_start, GLOBAL const uint *cached_b,
                                   GLOBAL uint *pair_event_start, uint a)
{
  pair_walk walk = walk_of(pair_start, cached_start, a);
  uint found = 0u;
  while (walk_goes_on(&walk))
    if (next_pair(&walk, pair_b, cached_b).b != INDEX_NONE) ++found;
  pair_event_start[a] = found;
}

SHARED void write_pair_events_item(GLOBAL const uint *pair_start, GLOBAL const uint *pair_b,
                                   GLOBAL const uint *cached_start, GLOBAL const uint *cached_b,
                                   GLOBAL const uint *pair_event_start, GLOBAL uint *pair_event, uint a)
{
  pair_walk walk = walk_of(pair_start, cached_start, a);
  for (uint at = pair_event_start[a]; walk_goes_on(&walk);) {
    pair_change change = next_pair(&walk, pair_b, cached_b);
    if (change.b == INDEX_NONE) continue;
    pair_event[3u * at] = change.kind;
    pair_event[3u * at + 1u] = a;
    pair_event[3u * at + 2u] = change.b;
    ++at;
  }
}

#endif
