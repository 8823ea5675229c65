/* grid_symmetric.h - the grid of grid.h with 14 cells instead of 27: each pair of cells is looked at from one side.
 *
 *      z + 1 row    x x x   x x x   x x x        A body looks at those behind it in its own cell and at 13 of the cells
 *      z     row    . . .   . o x   x x x        around it: the right one, the row above, and three rows of the next
 *                                                layer. The others look at it.
 *                   y - 1     y     y + 1
 *
 * Half the tests (2009 talk); but what is found may belong to either body, so the pairs are keys to be sorted
 * (pair_keys.h).
 */
#ifndef TANDEM_SHARED_BROADPHASE_GRID_SYMMETRIC_H
#define TANDEM_SHARED_BROADPHASE_GRID_SYMMETRIC_H

#include "shared/broadphase/grid.h"
#include "shared/broadphase/pair_keys.h"

/* Stretch k of 5: the first starts behind the body itself. */
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

/* Calls VISIT(body, b) for what item i finds, in whatever order of the two: a large body, or place i - large of the
 * sorted list. */
#define SYMMETRIC_SEARCH(i, VISIT)                                                                                    \
  {                                                                                                                   \
    uint large = counts[COUNT_LARGE], body = grid_body(sort_value, counts, i);                                        \
    box_bounds own = load_bounds(bounds, body);                                                                       \
    for (uint b = 0; b < large && b < body; ++b)                                                                      \
      if (bounds_overlap(own, load_bounds(bounds, b)) && pair_allowed(parameters, body_traits, body_filter, body, b)) \
        VISIT(body, b)                                                                                                \
    grid_cell c = cell_of(grid, counts, own);                                                                         \
    for (uint k = 0u; k < (i < large ? 0u : 5u); ++k) {                                                               \
      grid_row cells = forward_row(cell_start, counts, c, i - large, k);                                              \
      for (; cells.at < cells.end; ++cells.at) {                                                                      \
        uint b = sort_value[cells.at];                                                                                \
        if (bounds_overlap(own, load_bounds(bounds, b)) &&                                                            \
            pair_allowed(parameters, body_traits, body_filter, body, b))                                              \
          VISIT(body, b)                                                                                              \
      }                                                                                                               \
    }                                                                                                                 \
  }

SHARED void symmetric_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                                 GLOBAL const uint *body_filter, GLOBAL const row *bounds, GLOBAL const row *grid,
                                 GLOBAL const uint *sort_value, GLOBAL const uint *cell_start,
                                 GLOBAL const uint *counts, GLOBAL uint *sweep_start, GLOBAL uint *finds, uint i)
{
  uint found = 0u;
#define VISIT(body, b) keep_find(finds, i, found++, b);
  SYMMETRIC_SEARCH(i, VISIT)
#undef VISIT
  sweep_start[i] = found;
}

SHARED void symmetric_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                                 GLOBAL const uint *body_filter, GLOBAL const row *bounds, GLOBAL const row *grid,
                                 GLOBAL const uint *sort_value, GLOBAL const uint *cell_start, GLOBAL const uint *finds,
                                 GLOBAL const uint *counts, GLOBAL const uint *sweep_start, GLOBAL ulong *pair_key,
                                 uint i)
{
  uint to = sweep_start[i], end = sweep_start[i + 1u], capacity = counts[CAPACITY_PAIRS];
#define VISIT(body, b)                                        \
  {                                                           \
    if (to < capacity) pair_key[to++] = key_of_pair(body, b); \
  }
  if (end - to <= FINDS_KEPT) write_kept_finds(finds, i, grid_body(sort_value, counts, i), pair_key, to, end, capacity);
  else SYMMETRIC_SEARCH(i, VISIT)
#undef VISIT
}

#endif
