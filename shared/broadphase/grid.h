/* grid.h - uniform grid: bodies are sorted by cell, and each searches its own cell and the 26 around it.
 *
 * It follows the particle demo of the 2009 talk and GS-4150 slides 19-20, without a limit on the bodies in a cell. A
 * cell is never smaller than the largest bounds, so overlapping bodies are in neighbouring cells. Cells are numbered
 * along x first, so three neighbours are one range of the sorted list:
 *      z  +---+---+---+
 *      ^  | 6   7   8 |     9 rows of 3 cells instead of 27 cells
 *      |  +---+---+---+
 *      y> | 3   4   5 |
 *         +---+---+---+
 */
#ifndef TANDEM_SHARED_BROADPHASE_GRID_H
#define TANDEM_SHARED_BROADPHASE_GRID_H

#include "shared/broadphase/extent.h"
#include "shared/broadphase/neighbors.h"
#include "shared/parallel/search.h"

typedef struct {
  int x, y, z;
} grid_cell;

/* Rounding may put a body outside of the region; it then belongs to a border cell. */
SHARED int cell_along(real offset, real inverse_cell, uint cells)
{
  int cell = floor_to_int(offset * inverse_cell);
  if (cell < 0) return 0;
  return cell < (int)cells ? cell : (int)cells - 1;
}

SHARED grid_cell cell_of(GLOBAL const float4 *grid, GLOBAL const uint *counts, box_bounds b)
{
  vec4 layout = load_float4(grid, 0u);
  vec3 offset = subtract(scale(add(b.lower, b.upper), R(0.5)), xyz(layout));
  grid_cell c = {cell_along(offset.x, layout.w, counts[COUNT_GRID_X]),
                 cell_along(offset.y, layout.w, counts[COUNT_GRID_Y]),
                 cell_along(offset.z, layout.w, counts[COUNT_GRID_Z])};
  return c;
}

SHARED uint cell_number(GLOBAL const uint *counts, int x, int y, int z)
{
  return ((uint)z * counts[COUNT_GRID_Y] + (uint)y) * counts[COUNT_GRID_X] + (uint)x;
}

/* The sort key of small body i of the scene is its cell. */
SHARED void grid_keys_item(GLOBAL const float4 *bounds, GLOBAL const float4 *grid, GLOBAL const uint *counts,
                           GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint body = counts[COUNT_LARGE] + i;
  grid_cell c = cell_of(grid, counts, load_bounds(bounds, body));
  sort_key[i] = cell_number(counts, c.x, c.y, c.z);
  sort_value[i] = body;
}

/* cell_start[cell] = the first sorted body of that cell or a later one. There are more cells than bodies, so a group
 * searches the whole list only for every CELLS_PER_SAMPLE-th of its TILE cells; for the others it searches between the
 * places of two of these. */
#define CELLS_PER_SAMPLE 16u
SHARED void grid_cells_group(GLOBAL const uint *sort_key, GLOBAL const uint *counts, GLOBAL uint *cell_start,
                             uint length, LOCAL uint *local_memory, uint group)
{
  uint cells = counts[COUNT_CELLS_PLUS_ONE], first = group * TILE;
  uint width = first >= cells ? 0u : cells - first < TILE ? cells - first : TILE;
  uint samples = width > 0u ? TILE / CELLS_PER_SAMPLE + 1u : 0u;
  FOR_EACH_ITEM(sample, samples)
  local_memory[sample] = lower_bound_of(sort_key, counts[length], first + sample * CELLS_PER_SAMPLE);
  FOR_EACH_ITEM(item, width)
  {
    uint from = local_memory[item / CELLS_PER_SAMPLE], to = local_memory[item / CELLS_PER_SAMPLE + 1u];
    cell_start[first + item] = from + lower_bound_of(sort_key + from, to - from, first + item);
  }
}

/* A range of the sorted list: cells left .. right of the row (y, z). */
typedef struct {
  uint at, end;
} grid_row;

SHARED grid_row row_of_cells(GLOBAL const uint *cell_start, GLOBAL const uint *counts, grid_cell c, int left, int y,
                             int z)
{
  grid_row range = {0u, 0u};
  int nx = (int)counts[COUNT_GRID_X], first = c.x + left > 0 ? c.x + left : 0, last = c.x + 1 < nx ? c.x + 1 : nx - 1;
  if (y < 0 || z < 0 || y >= (int)counts[COUNT_GRID_Y] || z >= (int)counts[COUNT_GRID_Z] || first > last) return range;
  range.at = cell_start[cell_number(counts, first, y, z)];
  range.end = cell_start[cell_number(counts, last, y, z) + 1u];
  return range;
}

/* Finds the bodies before the searching one in a range of the sorted list. */
FORCE_INLINE uint find_in_cells(const pair_search *search, GLOBAL const uint *sort_value, grid_row cells,
                                const find_list *list, uint at)
{
  for (; cells.at < cells.end; ++cells.at) {
    uint b = sort_value[cells.at];
    if (b < search->body && meets(search, b)) at = add_find(list, at, search->body, b);
  }
  return at;
}

/* Finds the bodies before the searching one in its own cell and in the 26 around it. */
FORCE_INLINE uint find_around(const pair_search *search, GLOBAL const float4 *grid, GLOBAL const uint *sort_value,
                              GLOBAL const uint *cell_start, GLOBAL const uint *counts, const find_list *list, uint at)
{
  grid_cell c = cell_of(grid, counts, search->box);
  for (int neighbour = 0; neighbour < 9; ++neighbour) {
    int y = c.y + neighbour % 3 - 1, z = c.z + neighbour / 3 - 1;
    at = find_in_cells(search, sort_value, row_of_cells(cell_start, counts, c, -1, y, z), list, at);
  }
  return at;
}

/* Finds every body before the searching one; large ones come first. */
FORCE_INLINE uint search_grid(const pair_search *search, GLOBAL const float4 *grid, GLOBAL const uint *sort_value,
                              GLOBAL const uint *cell_start, GLOBAL const uint *counts, const find_list *list, uint at)
{
  uint large = counts[COUNT_LARGE];
  at = find_among_first(search, large, list, at);
  return search->body < large ? at : find_around(search, grid, sort_value, cell_start, counts, list, at);
}

SHARED void grid_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                            GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                            GLOBAL const uint *sort_value, GLOBAL const uint *cell_start, GLOBAL const uint *counts,
                            GLOBAL uint *pair_start, GLOBAL uint *neighbors, uint i)
{
  uint a = searching_body(sort_value, counts[COUNT_LARGE], i);
  pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, a);
  find_list list = first_neighbors(neighbors, i);
  pair_start[a] = search_grid(&search, grid, sort_value, cell_start, counts, &list, 0u);
}

SHARED void grid_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                            GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                            GLOBAL const uint *sort_value, GLOBAL const uint *cell_start, GLOBAL const uint *neighbors,
                            GLOBAL const uint *counts, GLOBAL const uint *pair_start, write_pairs pairs, uint i)
{
  uint a = searching_body(sort_value, counts[COUNT_LARGE], i), first = pair_start[a], end = pair_start[a + 1u],
       capacity = counts[CAPACITY_PAIRS];
  if (end - first <= NEIGHBORS_KEPT) {
    write_kept_pairs(neighbors, i, a, pairs, first, end, capacity);
  } else {
    pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, a);
    find_list list = finds_as_pairs(pairs, capacity);
    search_grid(&search, grid, sort_value, cell_start, counts, &list, first);
  }
  sort_own_pairs(pairs, first, end, capacity);
}

#endif
