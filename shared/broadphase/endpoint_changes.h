/* endpoint_changes.h - finds the pairs that began or ceased to overlap since the last launch, by the endpoints that
 * changed their order.
 *
 * A pair can change only if along some axis the order of a lower end l of one body and an upper end u of the other has
 * changed: the two are inverted. Each end visits the places between its old and its new one, in the old list and in the
 * new list:
 *
 *     place     4  5  6  7
 *     old   ..  l  x  u  y  ..       l moves from place 4 to 6 and meets x and u in either list. Only u is an upper end
 *     new   ..  u  x  l  y  ..       that was after l and is now before it, so the two bodies may have parted.
 *
 * At least one of two inverted ends meets the other. Let l be before u at first, at a < b, and after it later, at a' >
 * b'. If b, the place of u in the old list, is not among those that l visits, it is after a', too. If b' is not among
 * them, it is before a, too. Then u visits both a and a' between b and b', so it meets l in either list. The other
 * inversion is the same with old and new exchanged.
 *
 * The cost of the search is therefore the distance that ends moved in the orders. If nothing is kept, all pairs are
 * changes, and a plain sweep along the first axis finds them.
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

/* An end, its old place along some axis, and its new one. */
typedef struct {
  uint end, was, is;
} moved_end;

/* A list of keys from `at` on, up to its capacity; without keys it is a counter. */
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

/* Whether m must report this pair of ends. Of two ends that meet each other the lower one does, so that the pair is
 * reported once. */
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

/* Whether two bodies began or ceased to overlap and no axis before this one reports it. Along an axis on which they
 * overlap before and after, none of their ends is inverted, so the first axis with a change reports it. */
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

/* Visits all ends between the places of m, in the old list and, unless they were met there, in the new one. */
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

/* Reports every pair once, by the body that starts first along the first axis; the other one starts between its
 * ends. */
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
  if (share_start[i] == share_start[i + 1u]) return; /* most ends found nothing and need not search again */
  end_tables tables = {parameters,           body_flags,          body_filter,         box_ends.order,
                       box_ends.place,       kept_box_ends.order, kept_box_ends.place, bounds,
                       kept_box_ends.bounds, counts[COUNT_BODIES]};
  key_list list = {pair_key, share_start[i], counts[CAPACITY_PAIRS]};
  find_changes(&tables, counts[COUNT_KEPT], i, &list);
}

/* The number of changes to sort and merge, limited by their capacity. */
SHARED void total_changes_item(GLOBAL const uint *share_start, GLOBAL uint *counts, uint i)
{
  (void)i;
  uint found = share_start[counts[COUNT_HALVES]], capacity = counts[CAPACITY_PAIRS];
  counts[COUNT_CHANGES_FOUND] = found;
  counts[COUNT_CHANGES] = found < capacity ? found : capacity;
}

#endif
