/* hybrid.h - small bodies in a grid, large ones in a hierarchy (GS-4150 slide 30).
 *
 *      small - small    a grid whose cells are two ordinary bodies wide, whatever the largest is
 *      large - any      the hierarchy of boxes over the large bodies alone: every body walks it
 *
 * A grid wants bodies of one size; a few hundred large ones would make its cells hold thousands. What is large is
 * decided anew every step, by the bounds: a fast body counts as large while it is fast. The halves are kernels of their
 * own, so each can be placed on another backend. What is found may belong to either body: the pairs are keys to be
 * sorted (pair_keys.h).
 */
#ifndef TANDEM_SHARED_BROADPHASE_HYBRID_H
#define TANDEM_SHARED_BROADPHASE_HYBRID_H

#include "shared/broadphase/grid.h"
#include "shared/broadphase/hierarchy_walks.h"
#include "shared/broadphase/pair_keys.h"

/* Small: no larger than a cell. Half-spaces are neither: all bodies are tested against them. */
SHARED mask is_small(GLOBAL const row *grid, box_bounds box)
{
  vec3 size = subtract(box.upper, box.lower);
  return maximum(size.x, maximum(size.y, size.z)) * load_row(grid, 0u).w <= R(1.0);
}

/* The large ones along the curve, all others behind them. */
SHARED void large_keys_item(GLOBAL const row *bounds, GLOBAL const row *grid, GLOBAL const uint *counts,
                            GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint body = counts[COUNT_BOUNDLESS] + i;
  box_bounds box = load_bounds(bounds, body);
  sort_key[i] = is_small(grid, box) ? 1u << CURVE_BITS : curve_key(grid, box);
  sort_value[i] = body;
}

/* The hierarchy is that of the large ones alone, filed anew every step. */
SHARED void plan_large_item(GLOBAL const uint *sort_key, GLOBAL uint *counts, uint i)
{
  (void)i;
  uint large = lower_bound_of(sort_key, counts[COUNT_BOUNDED], 1u << CURVE_BITS);
  counts[COUNT_FILED] = large;
  set_leaves(counts, large);
}

/* Small ones by cell, large ones behind the last. */
SHARED void small_keys_item(GLOBAL const row *bounds, GLOBAL const row *grid, GLOBAL const uint *counts,
                            GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint body = counts[COUNT_BOUNDLESS] + i;
  box_bounds box = load_bounds(bounds, body);
  grid_cell c = cell_of(grid, counts, box);
  sort_key[i] = is_small(grid, box) ? cell_number(counts, c.x, c.y, c.z) : counts[COUNT_CELLS];
  sort_value[i] = body;
}

/* Calls VISIT(body, b) for each small body before body i that i, itself small, may meet. Items in the order of the
 * cells. */
#define SMALL_SEARCH(i, VISIT)                                                                                    \
  {                                                                                                               \
    uint boundless = counts[COUNT_BOUNDLESS], body = i < boundless ? i : sort_value[i - boundless];               \
    box_bounds own = load_bounds(bounds, body);                                                                   \
    grid_cell c = cell_of(grid, counts, own);                                                                     \
    for (int neighbour = 0; neighbour < (i >= boundless && is_small(grid, own) ? 9 : 0); ++neighbour) {           \
      grid_row cells = row_of_cells(cell_start, counts, c, -1, c.y + neighbour % 3 - 1, c.z + neighbour / 3 - 1); \
      for (; cells.at < cells.end; ++cells.at) {                                                                  \
        uint b = sort_value[cells.at];                                                                            \
        if (b < body && bounds_overlap(own, load_bounds(bounds, b)) &&                                            \
            pair_allowed(parameters, body_traits, body_filter, body, b))                                          \
          VISIT(body, b)                                                                                          \
      }                                                                                                           \
    }                                                                                                             \
  }

SHARED void small_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                             GLOBAL const uint *body_filter, GLOBAL const row *bounds, GLOBAL const row *grid,
                             GLOBAL const uint *sort_value, GLOBAL const uint *cell_start, GLOBAL const uint *counts,
                             GLOBAL uint *small_finds, GLOBAL uint *grid_finds, uint i)
{
  uint found = 0u;
#define VISIT(body, b) keep_find(grid_finds, i, found++, b);
  SMALL_SEARCH(i, VISIT)
#undef VISIT
  small_finds[i] = found;
}

SHARED void small_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                             GLOBAL const uint *body_filter, GLOBAL const row *bounds, GLOBAL const row *grid,
                             GLOBAL const uint *sort_value, GLOBAL const uint *cell_start,
                             GLOBAL const uint *grid_finds, GLOBAL const uint *counts, GLOBAL const uint *share_start,
                             GLOBAL ulong *pair_key, uint i)
{
  uint boundless = counts[COUNT_BOUNDLESS], to = share_start[2u * i], end = share_start[2u * i + 1u],
       capacity = counts[CAPACITY_PAIRS];
#define VISIT(body, b)                                        \
  {                                                           \
    if (to < capacity) pair_key[to++] = key_of_pair(body, b); \
  }
  if (end - to <= FINDS_KEPT)
    write_kept_finds(grid_finds, i, i < boundless ? i : sort_value[i - boundless], pair_key, to, end, capacity);
  else SMALL_SEARCH(i, VISIT)
#undef VISIT
}

/* Calls VISIT(body, b) for each half-space and large body that body i may meet; two large ones meet once. Items along
 * the curve. */
#define LARGE_SEARCH(i, VISIT)                                                                                        \
  {                                                                                                                   \
    uint boundless = counts[COUNT_BOUNDLESS], body = i < boundless ? i : hierarchy_nodes.leaf_body[i - boundless];    \
    hierarchy_search search = {hierarchy_nodes.box, hierarchy_nodes.link, load_bounds(bounds, body), BOUNDLESS};      \
    mask small = is_small(grid, search.box);                                                                          \
    if (!small) search.before = before_body(body);                                                                    \
    for (uint b = 0u; b < boundless && b < body; ++b)                                                                 \
      if (bounds_overlap(search.box, load_bounds(bounds, b)) &&                                                       \
          pair_allowed(parameters, body_traits, body_filter, body, b))                                                \
        VISIT(body, b)                                                                                                \
    uint next = i < boundless ? INDEX_NONE : root_slot(counts);                                                       \
    for (uint leaf = next_by_skipping(&search, &next); leaf != INDEX_NONE; leaf = next_by_skipping(&search, &next)) { \
      uint b = hierarchy_nodes.leaf_body[leaf / 2u];                                                                  \
      if ((small || b < body) && pair_allowed(parameters, body_traits, body_filter, body, b)) VISIT(body, b)          \
    }                                                                                                                 \
  }

SHARED void large_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                             GLOBAL const uint *body_filter, GLOBAL const row *bounds, GLOBAL const row *grid,
                             read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts, GLOBAL uint *large_finds,
                             GLOBAL uint *finds, uint i)
{
  uint found = 0u;
#define VISIT(body, b) keep_find(finds, i, found++, b);
  LARGE_SEARCH(i, VISIT)
#undef VISIT
  large_finds[i] = found;
}

SHARED void large_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_traits,
                             GLOBAL const uint *body_filter, GLOBAL const row *bounds, GLOBAL const row *grid,
                             read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *finds, GLOBAL const uint *counts,
                             GLOBAL const uint *share_start, GLOBAL ulong *pair_key, uint i)
{
  uint boundless = counts[COUNT_BOUNDLESS], to = share_start[2u * i + 1u], end = share_start[2u * i + 2u],
       capacity = counts[CAPACITY_PAIRS];
#define VISIT(body, b)                                        \
  {                                                           \
    if (to < capacity) pair_key[to++] = key_of_pair(body, b); \
  }
  if (end - to <= FINDS_KEPT)
    write_kept_finds(finds, i, i < boundless ? i : hierarchy_nodes.leaf_body[i - boundless], pair_key, to, end,
                     capacity);
  else LARGE_SEARCH(i, VISIT)
#undef VISIT
}

/* What both halves found, one beside the other, to be summed. */
SHARED void join_finds_item(GLOBAL const uint *small_finds, GLOBAL const uint *large_finds, GLOBAL uint *share_start,
                            uint i)
{
  share_start[2u * i] = small_finds[i];
  share_start[2u * i + 1u] = large_finds[i];
}

#endif
