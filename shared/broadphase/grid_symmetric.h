/* grid_symmetric.h - the grid of grid.h with 14 cells instead of 27: each pair of cells is tested from one side only.
 *
 *      z + 1 row    x x x   x x x   x x x        A body tests those behind it in its own cell and those of 13 of the
 *      z     row    . . .   . o x   x x x        cells around it: the right one, the row above, and three rows of the
 *                   y - 1     y     y + 1        next layer. The bodies of the other 13 cells test it.
 *
 * This halves the tests (2009 talk). A pair may be found by either of its bodies, so pairs are keys that are sorted
 * afterwards (pair_keys.h).
 */
#ifndef TANDEM_SHARED_BROADPHASE_GRID_SYMMETRIC_H
#define TANDEM_SHARED_BROADPHASE_GRID_SYMMETRIC_H

#include "shared/broadphase/grid.h"
#include "shared/broadphase/pair_keys.h"

/* Range k of 5; the first one starts behind the body itself. */
SHARED grid_row forward_row(GLOBAL const uint *cell_start, GLOBAL const uint *counts, grid_cell c, uint place, uint k)
{
  if (k == 0u) {
    grid_row own = row_of_cells(cell_start, counts, c, 0, c.y, c.z);
    own.at = place + 1u;
    return own;
  }
  return k == 1u ? row_of_cells(cell_start, counts, c, -1, c.y + 1, c.z)
                 : row_of_cells(cell_start, counts, c, -1, c.y + (int)k - 3, c.z + 1);
}

/* Finds every body in a range of the sorted list. */
FORCE_INLINE uint find_in_forward_row(const pair_search *search, GLOBAL const uint *sort_value, grid_row cells,
                                      const find_list *list, uint at)
{
  for (; cells.at < cells.end; ++cells.at) {
    uint b = sort_value[cells.at];
    if (meets(search, b)) at = add_find(list, at, search->body, b);
  }
  return at;
}

/* The searching body is that of item i: a large body, or the one at place i - large of the sorted list. */
FORCE_INLINE uint search_forward_cells(const pair_search *search, GLOBAL const float4 *grid,
                                       GLOBAL const uint *sort_value, GLOBAL const uint *cell_start,
                                       GLOBAL const uint *counts, uint i, const find_list *list, uint at)
{
  uint large = counts[COUNT_LARGE];
  at = find_among_first(search, large, list, at);
  if (i < large) return at;
  grid_cell c = cell_of(grid, counts, search->box);
  for (uint k = 0u; k < 5u; ++k)
    at = find_in_forward_row(search, sort_value, forward_row(cell_start, counts, c, i - large, k), list, at);
  return at;
}

SHARED void symmetric_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                 GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                                 GLOBAL const uint *sort_value, GLOBAL const uint *cell_start,
                                 GLOBAL const uint *counts, GLOBAL uint *key_start, GLOBAL uint *neighbors, uint i)
{
  uint body = searching_body(sort_value, counts[COUNT_LARGE], i);
  pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, body);
  find_list list = first_neighbors(neighbors, i);
  key_start[i] = search_forward_cells(&search, grid, sort_value, cell_start, counts, i, &list, 0u);
}

SHARED void symmetric_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                                 GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                                 GLOBAL const uint *sort_value, GLOBAL const uint *cell_start,
                                 GLOBAL const uint *neighbors, GLOBAL const uint *counts, GLOBAL const uint *key_start,
                                 GLOBAL ulong *pair_key, uint i)
{
  uint body = searching_body(sort_value, counts[COUNT_LARGE], i), first = key_start[i], end = key_start[i + 1u],
       capacity = counts[CAPACITY_PAIRS];
  if (end - first <= NEIGHBORS_KEPT) {
    write_kept_keys(neighbors, i, body, pair_key, first, end, capacity);
  } else {
    pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, body);
    find_list list = finds_as_keys(pair_key, capacity);
    search_forward_cells(&search, grid, sort_value, cell_start, counts, i, &list, first);
  }
}

#endif
