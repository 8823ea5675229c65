/* hybrid.h - small bodies in a grid, large ones in a hierarchy (GS-4150 slide 30).
 *
 *      small - small    a grid whose cells are two ordinary bodies wide, whatever the size of the largest body
 *      large - any      a hierarchy of boxes over the large bodies alone, which every body traverses
 *
 * A grid suits bodies of one size; with a few hundred large ones its cells would hold thousands. The bounds decide in
 * every step which bodies are large, so a fast body counts as large while it is fast. The two halves are separate
 * kernels, so each can be placed on another backend. A pair may be found by either body, so pairs are keys that are
 * sorted afterwards (pair_keys.h).
 */
#ifndef TANDEM_SHARED_BROADPHASE_HYBRID_H
#define TANDEM_SHARED_BROADPHASE_HYBRID_H

#include "shared/broadphase/grid.h"
#include "shared/broadphase/hierarchy_walks.h"
#include "shared/broadphase/pair_keys.h"

/* A small body is no larger than a cell. Half-spaces are neither small nor large: all bodies are tested against
 * them. */
SHARED mask is_small(GLOBAL const float4 *grid, box_bounds box)
{
  vec3 size = subtract(box.upper, box.lower);
  return maximum(size.x, maximum(size.y, size.z)) * load_float4(grid, 0u).w <= R(1.0);
}

/* The keys sort large bodies along the curve and all others behind them. */
SHARED void large_keys_item(GLOBAL const float4 *bounds, GLOBAL const float4 *grid, GLOBAL const uint *counts,
                            GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint body = counts[COUNT_UNBOUNDED] + i;
  box_bounds box = load_bounds(bounds, body);
  sort_key[i] = is_small(grid, box) ? 1u << CURVE_BITS : curve_key(grid, box);
  sort_value[i] = body;
}

/* The hierarchy holds the large bodies alone, and is built anew every step. */
SHARED void plan_large_item(GLOBAL const uint *sort_key, GLOBAL uint *counts, uint i)
{
  (void)i;
  uint large = lower_bound_of(sort_key, counts[COUNT_BOUNDED], 1u << CURVE_BITS);
  counts[COUNT_INSERTED] = large;
  set_leaves(counts, large);
}

/* The keys sort small bodies by cell, and large ones behind the last cell. */
SHARED void small_keys_item(GLOBAL const float4 *bounds, GLOBAL const float4 *grid, GLOBAL const uint *counts,
                            GLOBAL uint *sort_key, GLOBAL uint *sort_value, uint i)
{
  uint body = counts[COUNT_UNBOUNDED] + i;
  box_bounds box = load_bounds(bounds, body);
  grid_cell c = cell_of(grid, counts, box);
  sort_key[i] = is_small(grid, box) ? cell_number(counts, c.x, c.y, c.z) : counts[COUNT_CELLS];
  sort_value[i] = body;
}

/* Finds the small bodies before the searching one, if it is small itself. */
SHARED uint search_small(const pair_search *search, GLOBAL const float4 *grid, GLOBAL const uint *sort_value,
                         GLOBAL const uint *cell_start, GLOBAL const uint *counts, const find_list *list, uint at)
{
  if (search->body < counts[COUNT_UNBOUNDED] || !is_small(grid, search->box)) return at;
  return find_around(search, grid, sort_value, cell_start, counts, list, at);
}

SHARED void small_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                             GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                             GLOBAL const uint *sort_value, GLOBAL const uint *cell_start, GLOBAL const uint *counts,
                             GLOBAL uint *small_neighbors, GLOBAL uint *grid_neighbors, uint i)
{
  uint body = searching_body(sort_value, counts[COUNT_UNBOUNDED], i);
  pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, body);
  find_list list = first_neighbors(grid_neighbors, i);
  small_neighbors[i] = search_small(&search, grid, sort_value, cell_start, counts, &list, 0u);
}

SHARED void small_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                             GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                             GLOBAL const uint *sort_value, GLOBAL const uint *cell_start,
                             GLOBAL const uint *grid_neighbors, GLOBAL const uint *counts,
                             GLOBAL const uint *share_start, GLOBAL ulong *pair_key, uint i)
{
  uint body = searching_body(sort_value, counts[COUNT_UNBOUNDED], i), first = share_start[2u * i],
       end = share_start[2u * i + 1u], capacity = counts[CAPACITY_PAIRS];
  if (end - first <= NEIGHBORS_KEPT) {
    write_kept_keys(grid_neighbors, i, body, pair_key, first, end, capacity);
  } else {
    pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, body);
    find_list list = finds_as_keys(pair_key, capacity);
    search_small(&search, grid, sort_value, cell_start, counts, &list, first);
  }
}

/* Finds the half-spaces and large bodies that the searching body overlaps. A large body searches only for those before
 * it, so that a pair of two large ones is found once. */
FORCE_INLINE uint search_large(const pair_search *search, GLOBAL const float4 *grid,
                               read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts, const find_list *list,
                               uint at)
{
  uint unbounded = counts[COUNT_UNBOUNDED], body = search->body;
  mask small = is_small(grid, search->box);
  searched_tree tree = {hierarchy_nodes.box, hierarchy_nodes.link, small ? UNBOUNDED : before_body(body)};
  at = find_among_first(search, unbounded, list, at);
  if (body < unbounded) return at;
  return find_by_skipping(search, &tree, hierarchy_nodes.leaf_body, root_slot(counts), small ? INDEX_NONE : body, list,
                          at);
}

SHARED void large_count_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                             GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                             read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *counts,
                             GLOBAL uint *large_neighbors, GLOBAL uint *neighbors, uint i)
{
  uint body = searching_body(hierarchy_nodes.leaf_body, counts[COUNT_UNBOUNDED], i);
  pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, body);
  find_list list = first_neighbors(neighbors, i);
  large_neighbors[i] = search_large(&search, grid, hierarchy_nodes, counts, &list, 0u);
}

SHARED void large_write_item(GLOBAL const Parameters *parameters, GLOBAL const uint *body_flags,
                             GLOBAL const uint *body_filter, GLOBAL const float4 *bounds, GLOBAL const float4 *grid,
                             read_hierarchy_nodes hierarchy_nodes, GLOBAL const uint *neighbors,
                             GLOBAL const uint *counts, GLOBAL const uint *share_start, GLOBAL ulong *pair_key, uint i)
{
  uint body = searching_body(hierarchy_nodes.leaf_body, counts[COUNT_UNBOUNDED], i), first = share_start[2u * i + 1u],
       end = share_start[2u * i + 2u], capacity = counts[CAPACITY_PAIRS];
  if (end - first <= NEIGHBORS_KEPT) {
    write_kept_keys(neighbors, i, body, pair_key, first, end, capacity);
  } else {
    pair_search search = search_of_body(parameters, body_flags, body_filter, bounds, body);
    find_list list = finds_as_keys(pair_key, capacity);
    search_large(&search, grid, hierarchy_nodes, counts, &list, first);
  }
}

/* Writes the numbers of finds of both halves side by side, so that one scan sums them. */
SHARED void join_neighbors_item(GLOBAL const uint *small_neighbors, GLOBAL const uint *large_neighbors,
                                GLOBAL uint *share_start, uint i)
{
  share_start[2u * i] = small_neighbors[i];
  share_start[2u * i + 1u] = large_neighbors[i];
}

#endif
