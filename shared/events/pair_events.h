/* pair_events.h - which pairs of bodies came near in a step, are near still, or ceased to be: the persistence of the
 * pair list.
 *
 * The walk of list.h over this step's pairs and those of the last committed one, by their presence alone: whether they
 * touch is that list's question. In scenes with trees a pair is near where some of its parts are.
 */
#ifndef TANDEM_SHARED_EVENTS_PAIR_EVENTS_H
#define TANDEM_SHARED_EVENTS_PAIR_EVENTS_H

#include "shared/events/list.h"

/* The next pair of bodies of either list, once, with what became of it. */
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
  for (; walk_goes_on(&walk); ++found) next_pair(&walk, pair_b, cached_b);
  pair_event_start[a] = found;
}

SHARED void write_pair_events_item(GLOBAL const uint *pair_start, GLOBAL const uint *pair_b,
                                   GLOBAL const uint *cached_start, GLOBAL const uint *cached_b,
                                   GLOBAL const uint *pair_event_start, GLOBAL uint *pair_event, uint a)
{
  pair_walk walk = walk_of(pair_start, cached_start, a);
  for (uint at = pair_event_start[a]; walk_goes_on(&walk); ++at) {
    pair_change change = next_pair(&walk, pair_b, cached_b);
    pair_event[3u * at] = change.kind;
    pair_event[3u * at + 1u] = a;
    pair_event[3u * at + 2u] = change.b;
  }
}

#endif
