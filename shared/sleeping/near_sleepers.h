/* near_sleepers.h - finds the sleeping bodies that those awake come near to, so that contact wakes them.
 *
 * Sleepers stand in a table by the cells of their boxes (shared/sleeping/sleeper_table.h). Large ones, and those that
 * fell asleep since the table was sorted, are tested one by one.
 *
 *        +----+----+----+
 *        |    | s  |    |     The box of A, grown by half a cell, meets the cells of all boxes that it can overlap:
 *        +----+----+----+     a box reaches no further than half a cell from its centre.
 *        |  [A]    |  s |
 *        +----+----+----+
 *
 * Pairs found here pass through the narrowphase before the step's own pairs do; a pair with a contact wakes the island
 * of the sleeper, and the step runs again with it (host/world/sleep.cpp). A near miss wakes nobody.
 */
#ifndef TANDEM_SHARED_SLEEPING_NEAR_SLEEPERS_H
#define TANDEM_SHARED_SLEEPING_NEAR_SLEEPERS_H

#include "shared/broadphase/neighbors.h"
#include "shared/parallel/search.h"
#include "shared/sleeping/islands.h"
#include "shared/sleeping/sleeper_table.h"

/* More cells along an axis than this are not visited one by one. */
#define MOST_CELLS 8u

/* The table of sleepers, of which the first ones are sorted. */
typedef struct {
  read_sleepers table;
  uint sorted, count;
} sleeper_list;

SHARED sleeper_list list_of_sleepers(read_sleepers table, GLOBAL const uint *counts)
{
  sleeper_list list = {table, counts[COUNT_SORTED_SLEEPERS], counts[COUNT_LISTED_SLEEPERS]};
  return list;
}

/* Those who woke have left empty places, most of which lie side by side. */
#define PLACES_AT_ONCE 4u
SHARED mask are_empty(GLOBAL const uint *place) { return (place[0] & place[1] & place[2] & place[3]) == INDEX_NONE; }

FORCE_INLINE uint find_among_sleepers(const pair_search *search, const sleeper_list *sleepers, uint first, uint end,
                                      const find_list *list, uint at)
{
  for (uint k = first; k < end; ++k) {
    while (k + PLACES_AT_ONCE <= end && are_empty(sleepers->table.body + k)) k += PLACES_AT_ONCE;
    uint other = k < end ? sleepers->table.body[k] : INDEX_NONE;
    if (other != INDEX_NONE && bounds_overlap(search->box, load_bounds(sleepers->table.bounds, k)) &&
        may_meet(search, other))
      at = add_find(list, at, search->body, other);
  }
  return at;
}

/* The cells along x between two others. */
typedef struct {
  int low, high, y, z;
} cell_row;

/* Neighbours along x have keys that follow each other, unless the coordinate wraps around between them: only then is
 * the next cell searched for. first: the place of the first cell. */
FORCE_INLINE uint find_in_row(const pair_search *search, const sleeper_list *sleepers, cell_row row, uint first,
                              const find_list *list, uint at)
{
  uint end = first, after = key_of_cell(row.low, row.y, row.z); /* the key of the cell that starts at `end` */
  for (int x = row.low; x <= row.high; ++x) {
    uint key = key_of_cell(x, row.y, row.z);
    uint start = key == after ? end : lower_bound_of(sleepers->table.key, sleepers->sorted, key);
    end = start;
    while (end < sleepers->sorted && sleepers->table.key[end] == key) ++end;
    at = find_among_sleepers(search, sleepers, start, end, list, at);
    after = key + 1u;
  }
  return at;
}

SHARED cell_row row_at(const int low[3], const int high[3], uint row)
{
  uint wide = (uint)(high[1] - low[1]) + 1u;
  cell_row result = {low[0], high[0], low[1] + (int)(row % wide), low[2] + (int)(row / wide)};
  return result;
}

/* A body no larger than the sleepers meets three rows by three, which one search finds together with those that are
 * large. */
FORCE_INLINE uint find_in_sleeper_cells(const pair_search *search, const sleeper_list *sleepers, const int low[3],
                                        const int high[3], const find_list *list, uint at)
{
  uint rows = ((uint)(high[1] - low[1]) + 1u) * ((uint)(high[2] - low[2]) + 1u);
  for (uint first_row = 0u; first_row <= rows; first_row += SEARCHES_AT_ONCE) {
    uint keys[SEARCHES_AT_ONCE], places[SEARCHES_AT_ONCE];
    for (uint k = 0u; k < SEARCHES_AT_ONCE; ++k) {
      cell_row row = row_at(low, high, first_row + k);
      keys[k] = first_row + k < rows ? key_of_cell(row.low, row.y, row.z) : LARGE_SLEEPER;
    }
    lower_bounds_of(sleepers->table.key, sleepers->sorted, keys, places);
    for (uint k = 0u; k < SEARCHES_AT_ONCE && first_row + k < rows; ++k)
      at = find_in_row(search, sleepers, row_at(low, high, first_row + k), places[k], list, at);
    if (rows - first_row < SEARCHES_AT_ONCE)
      at = find_among_sleepers(search, sleepers, places[rows - first_row], sleepers->count, list, at);
  }
  return at;
}

/* Unsigned, because coordinates saturate at 2^30 and their difference may exceed an int. */
SHARED mask covers_many_cells(int low, int high) { return (uint)high - (uint)low > MOST_CELLS; }

/* A body that covers many cells, as a moving half-space does, is tested against all. */
FORCE_INLINE uint find_sleepers(const pair_search *search, const sleeper_list *sleepers, GLOBAL const uint *counts,
                                const find_list *list, uint at)
{
  real reach = reach_of_sleepers(counts);
  vec3 lower = search->box.lower, upper = search->box.upper;
  int low[3] = {sleeper_cell_along(lower.x - reach, reach), sleeper_cell_along(lower.y - reach, reach),
                sleeper_cell_along(lower.z - reach, reach)};
  int high[3] = {sleeper_cell_along(upper.x + reach, reach), sleeper_cell_along(upper.y + reach, reach),
                 sleeper_cell_along(upper.z + reach, reach)};
  if (covers_many_cells(low[0], high[0]) || covers_many_cells(low[1], high[1]) || covers_many_cells(low[2], high[2]))
    return find_among_sleepers(search, sleepers, 0u, sleepers->count, list, at);
  return find_in_sleeper_cells(search, sleepers, low, high, list, at);
}

/* Fixed bodies wake nobody, and kinematic ones do while they move. */
SHARED uint may_wake(GLOBAL const uint *body_flags, GLOBAL const float4 *body_velocity, uint body)
{
  return is_dynamic(body_flags, body) || is_moving_kinematic(body_flags, body_velocity, body) ? 1u : 0u;
}

SHARED void near_sleepers_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                     GLOBAL const uint *body_filter, GLOBAL const float4 *bounds,
                                     GLOBAL const float4 *body_velocity, read_sleepers table, GLOBAL const uint *counts,
                                     GLOBAL uint *pair_start, uint i)
{
  sleeper_list sleepers = list_of_sleepers(table, counts);
  find_list list = no_neighbors();
  pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, i);
  pair_start[i] = may_wake(body_flags, body_velocity, i) ? find_sleepers(&search, &sleepers, counts, &list, 0u) : 0u;
}

/* A sleeper has a higher index than any body that is awake, so it owns the pair. Most bodies are near none. */
SHARED void near_sleepers_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                     GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, read_sleepers table,
                                     GLOBAL const uint *counts, GLOBAL const uint *pair_start, write_pairs pairs,
                                     uint i)
{
  if (pair_start[i + 1u] == pair_start[i]) return;
  sleeper_list sleepers = list_of_sleepers(table, counts);
  find_list list = finds_as_bodies(pairs.a, counts[CAPACITY_PAIRS]);
  pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, i);
  uint end = find_sleepers(&search, &sleepers, counts, &list, pair_start[i]), capacity = counts[CAPACITY_PAIRS];
  for (uint pair = pair_start[i]; pair < end && pair < capacity; ++pair) pairs.b[pair] = i;
}

/* How far a point of the body that is awake comes nearer to the sleeper within the step, at most. normal: from the
 * sleeper to the body. */
SHARED real approach_to_sleeper(GLOBAL const Parameters *parameters, GLOBAL const float4 *body_velocity, real radius,
                                vec3 normal, uint body)
{
  spatial_velocity m = load_velocity(body_velocity, body);
  real closing = maximum(R(0.0), R(0.0) - dot3(m.linear, normal)) + radius * length_of(m.angular);
  real pull = magnitude(load_float4(body_velocity, 2u * body + 1u).w) * length_of(gravity_of(parameters));
  return parameters->step * (closing + parameters->step * pull);
}

/* Contacts are made ahead of touching; those that stay out of reach in this step wake nobody. Notes the sleepers that
 * were touched, before the step's own pairs take the place of these. */
SHARED void note_touched_sleepers_item(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a,
                                       GLOBAL const uint *pair_b, GLOBAL const float4 *body_shape,
                                       GLOBAL const float4 *body_velocity, read_manifolds manifolds,
                                       GLOBAL uint *touched_sleeper, GLOBAL uint *counts, uint i)
{
  uint points = manifolds.count[i] & (TO_FOLLOW - 1u), touched = 0u;
  real reach = approach_to_sleeper(parameters, body_velocity, load_float4(body_shape, pair_b[i]).w,
                                   xyz(load_float4(manifolds.normal, i)), pair_b[i]);
  for (uint k = 0u; k < points; ++k)
    if (load_float4(manifolds.points, k * counts[CAPACITY_PAIRS] + i).w <= reach) touched = 1u;
  touched_sleeper[i] = touched ? pair_a[i] : INDEX_NONE;
  if (touched) ATOMIC_ADD(counts + COUNT_TOUCHED_SLEEPERS, 1u);
}
SHARED void keep_sleeper_counts_item(GLOBAL uint *counts, uint i)
{
  (void)i;
  counts[COUNT_SLEEPER_PAIRS] = counts[COUNT_PAIRS];
  counts[COUNT_SLEEPER_PAIRS_NEEDED] = counts[COUNT_PAIRS_NEEDED];
}

#endif
