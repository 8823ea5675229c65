/* endpoint_changes.h - the pairs that came to overlap or ceased to since the last launch: found by the ends that
 * changed places.
 *
 * A pair can change only if along some axis a lower end l of one body and an upper end u of the other stand in another
 * order than they did: their couple is inverted. Each end walks its way, from its old place to its new one, through the
 * old list and the new list:
 *
 *     place     4  5  6  7
 *     old   ..  l  x  u  y  ..        l goes from place 4 to 6: it meets x and u, in either list; u alone is an
 *     new   ..  u  x  l  y  ..        upper end that l stood before and stands behind, so the two may have parted
 *
 * One of the two meets the other. Let l stand before u at first, at a < b, and behind it afterwards, at a' > b'. If b,
 * u's place in the old list, is not on l's way, it lies behind a' too, and if b' is not on that way, it lies before a
 * too. Then u's way from b to b' leads past both a and a': u meets l in either list. With old and new exchanged this is
 * the other inversion.
 *
 * So what the search costs is how far ends moved in the orders. Where nothing is kept, all pairs are changes: a plain
 * sweep along the first axis finds them.
 */
#ifndef TANDEM_SHARED_BROADPHASE_ENDPOINT_CHANGES_H
#define TANDEM_SHARED_BROADPHASE_ENDPOINT_CHANGES_H

#include "shared/broadphase/endpoints.h"

typedef struct {
  GLOBAL const Parameters *parameters;
  GLOBAL const uint *flags, *filter, *order, *place, *kept_order, *kept_place;
  GLOBAL const float4 *bounds, *kept_bounds;
  uint bodies;
} end_tables;

/* An end, where it stood along some axis, and where it stands. */
typedef struct {
  uint end, was, is;
} moved_end;

/* Keys from `at` on, as many as there is room for; without keys it is a counter. */
typedef struct {
  GLOBAL ulong *keys;
  uint at, capacity;
} key_list;

SHARED void add_key(key_list *list, uint one, uint other)
{
  if (list->keys) {
    if (list->at >= list->capacity) return;
    list->keys[list->at] = key_of_pair(one, other);
  }
  list->at = list->at + 1u;
}

SHARED moved_end load_end(const end_tables *tables, uint axis, uint end)
{
  uint at = 2u * tables->bodies * axis + end;
  moved_end m = {end, tables->kept_place[at], tables->place[at]};
  return m;
}

SHARED int is_on_path(moved_end m, uint place)
{
  return m.was < m.is ? m.was <= place && place <= m.is : m.is <= place && place <= m.was;
}

/* Whether m has to tell of this couple. Of two ends that meet each other the lower one does, so that it is told
 * once. */
SHARED int tells_couple(uint bodies, moved_end m, moved_end other)
{
  int is_lower = m.end < bodies;
  if (is_lower == (other.end < bodies) || body_of_end(m.end, bodies) == body_of_end(other.end, bodies)) return 0;
  if ((m.was < other.was) == (m.is < other.is)) return 0;
  return is_lower || !(is_on_path(other, m.was) || is_on_path(other, m.is));
}

SHARED int overlap_along(box_bounds p, box_bounds q, uint axis)
{
  interval i = interval_along_axis(p, axis), j = interval_along_axis(q, axis);
  return i.start <= j.end && j.start <= i.end;
}

/* Whether two bodies came together or parted, and no axis before this one tells of it. Along an axis on which they
 * overlap before and after no couple of them is inverted, so the first axis with a change tells. */
SHARED int pair_changed(const end_tables *tables, uint axis, uint one, uint other)
{
  box_bounds p = load_bounds(tables->bounds, one), q = load_bounds(tables->bounds, other);
  box_bounds kept_p = load_bounds(tables->kept_bounds, one), kept_q = load_bounds(tables->kept_bounds, other);
  if (bounds_overlap(p, q) == bounds_overlap(kept_p, kept_q)) return 0;
  for (uint before = 0; before < axis; ++before)
    if (overlap_along(p, q, before) != overlap_along(kept_p, kept_q, before)) return 0;
  return pair_allowed(tables->parameters, tables->flags, tables->filter, one, other);
}

SHARED void meet_end(const end_tables *tables, uint axis, moved_end m, moved_end other, key_list *list)
{
  uint one = body_of_end(m.end, tables->bodies), two = body_of_end(other.end, tables->bodies);
  if (tells_couple(tables->bodies, m, other) && pair_changed(tables, axis, one, two)) add_key(list, one, two);
}

/* All ends on the way of m, in the old list and, unless they were met there, in the new one. */
SHARED void walk_way(const end_tables *tables, uint axis, moved_end m, key_list *list)
{
  uint plane = 2u * tables->bodies * axis, first = m.was < m.is ? m.was : m.is, last = m.was < m.is ? m.is : m.was;
  for (uint at = first; at <= last; ++at)
    meet_end(tables, axis, m, load_end(tables, axis, tables->kept_order[plane + at]), list);
  for (uint at = first; at <= last; ++at) {
    moved_end other = load_end(tables, axis, tables->order[plane + at]);
    if (!is_on_path(m, other.was)) meet_end(tables, axis, m, other, list);
  }
}

/* Every pair, by the body that starts first along the first axis: the other starts between its ends. */
SHARED void sweep_from_start(const end_tables *tables, uint body, key_list *list)
{
  box_bounds own = load_bounds(tables->bounds, body);
  uint end = tables->place[tables->bodies + body];
  for (uint at = tables->place[body] + 1u; at < end; ++at) {
    uint found = tables->order[at];
    if (found >= tables->bodies || !bounds_overlap(own, load_bounds(tables->bounds, found))) continue;
    if (pair_allowed(tables->parameters, tables->flags, tables->filter, body, found)) add_key(list, body, found);
  }
}

SHARED void find_changes(const end_tables *tables, uint is_kept, uint end, key_list *list)
{
  if (is_kept == 0u) {
    if (end < tables->bodies) sweep_from_start(tables, end, list);
    return;
  }
  for (uint axis = 0; axis < 3u; ++axis) {
    moved_end m = load_end(tables, axis, end);
    if (m.was != m.is) walk_way(tables, axis, m, list);
  }
}

SHARED void count_changes_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                               GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, read_box_ends box_ends,
                               read_kept_box_ends kept_box_ends, GLOBAL const uint *counts, GLOBAL uint *share_start,
                               uint i)
{
  end_tables tables = {parameters,           body_flags,          body_filter,         box_ends.order,
                       box_ends.place,       kept_box_ends.order, kept_box_ends.place, bounds,
                       kept_box_ends.bounds, counts[COUNT_BODIES]};
  key_list counter = {0, 0u, 0u};
  find_changes(&tables, counts[COUNT_KEPT], i, &counter);
  share_start[i] = counter.at;
}

SHARED void write_changes_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                               GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, read_box_ends box_ends,
                               read_kept_box_ends kept_box_ends, GLOBAL const uint *counts,
                               GLOBAL const uint *share_start, GLOBAL ulong *pair_key, uint i)
{
  if (share_start[i] == share_start[i + 1u]) return; /* most ends: they need not walk again */
  end_tables tables = {parameters,           body_flags,          body_filter,         box_ends.order,
                       box_ends.place,       kept_box_ends.order, kept_box_ends.place, bounds,
                       kept_box_ends.bounds, counts[COUNT_BODIES]};
  key_list list = {pair_key, share_start[i], counts[CAPACITY_PAIRS]};
  find_changes(&tables, counts[COUNT_KEPT], i, &list);
}

/* How many there are to sort and to merge: those that there was room for. */
SHARED void total_changes_item(GLOBAL const uint *share_start, GLOBAL uint *counts, uint i)
{
  (void)i;
  uint found = share_start[counts[COUNT_HALVES]], capacity = counts[CAPACITY_PAIRS];
  counts[COUNT_CHANGES_FOUND] = found;
  counts[COUNT_CHANGES] = found < capacity ? found : capacity;
}

#endif
