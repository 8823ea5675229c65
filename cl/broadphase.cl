/* broadphase.cl - entries: bounds, and the broadphases over them. */
#include "cl/entry.h"
#include "shared/broadphase/bounds.h"
#include "shared/broadphase/brute_force.h"
#include "shared/broadphase/extent.h"
#include "shared/broadphase/grid.h"
#include "shared/broadphase/grid_symmetric.h"
#include "shared/broadphase/hybrid.h"
#include "shared/broadphase/near_pairs.h"
#include "shared/broadphase/sap3.h"
#include "shared/broadphase/sweep_window.h"
#include "shared/broadphase/tight_bounds.h"

__kernel void compute_bounds(__global const Parameters *parameters, __global const uint *body_traits,
                             __global const row *body_shape, __global const row *body_shape_pose,
                             __global const row *body_mass, __global const row *body_position,
                             __global const row *body_orientation, __global const row *body_velocity,
                             __global row *bounds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  compute_bounds_item(parameters, body_traits, body_shape, body_shape_pose, body_mass, body_position, body_orientation,
                      body_velocity, bounds, i);
}

__kernel void compute_query_bounds(__global const Parameters *parameters, __global const uint *body_traits,
                                   __global const row *body_shape, __global const row *body_shape_pose,
                                   __global const row *body_position, __global const row *body_orientation,
                                   __global row *bounds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  compute_query_bounds_item(parameters, body_traits, body_shape, body_shape_pose, body_position, body_orientation,
                            bounds, i);
}

__kernel void tighten_bounds(__global const Parameters *parameters, __global const uint *body_traits,
                             __global const row *body_shape, __global const uint *body_convex,
                             __global const row *body_shape_pose, __global const uint *hull_header,
                             __global const row *hull_vertex, __global const row *hull_strip,
                             __global const row *body_mass, __global const row *body_position,
                             __global const row *body_orientation, __global const row *body_velocity,
                             __global row *bounds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  tighten_bounds_item(parameters, body_traits, body_shape, body_convex, body_shape_pose, hull_header, hull_vertex,
                      hull_strip, body_mass, body_position, body_orientation, body_velocity, bounds, i);
}

__kernel void brute_force_count(__global const Parameters *parameters, __global const uint *body_traits,
                                __global const uint *body_filter, __global const row *bounds, __global uint *pair_start,
                                RANGE)
{
  FOR_EACH_IN_RANGE(i)
  brute_force_count_item(parameters, body_traits, body_filter, bounds, pair_start, i);
}

__kernel void brute_force_write(__global const Parameters *parameters, __global const uint *body_traits,
                                __global const uint *body_filter, __global const row *bounds,
                                __global const uint *pair_start, __global const uint *counts, __global uint *pair_a,
                                __global uint *pair_b, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  brute_force_write_item(parameters, body_traits, body_filter, bounds, pair_start, counts, pair_a, pair_b, i);
}

__kernel void extent_tiles(__global const row *bounds, __global const uint *counts, __global row *bounds_sums, RANGE)
{
  __local uint local_memory[EXTENT_VALUES * EXTENT_WIDTH];
  extent_tiles_group(bounds, counts, bounds_sums, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void extent_whole(__global const uint *counts, __global row *bounds_sums, RANGE)
{
  __local uint local_memory[EXTENT_VALUES * EXTENT_WIDTH];
  extent_whole_group(counts, bounds_sums, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void lay_out(__global const Parameters *parameters, __global const row *bounds_sums, __global row *grid,
                      __global uint *counts, uint hybrid, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  lay_out_item(parameters, bounds_sums, grid, counts, hybrid, i);
}

__kernel void find_principal_direction(__global const row *bounds_sums, __global const uint *counts, __global row *grid,
                                       RANGE)
{
  FOR_EACH_IN_RANGE(i)
  find_principal_direction_item(bounds_sums, counts, grid, i);
}

__kernel void grid_keys(__global const row *bounds, __global const row *grid, __global const uint *counts,
                        __global uint *sort_key, __global uint *sort_value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  grid_keys_item(bounds, grid, counts, sort_key, sort_value, i);
}

__kernel void grid_cells(__global const uint *sort_key, __global const uint *counts, __global uint *cell_start,
                         uint length, RANGE)
{
  __local uint local_memory[TILE / CELLS_PER_SAMPLE + 1];
  grid_cells_group(sort_key, counts, cell_start, length, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void grid_count(__global const Parameters *parameters, __global const uint *body_traits,
                         __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                         __global const uint *sort_value, __global const uint *cell_start, __global const uint *counts,
                         __global uint *pair_start, __global uint *finds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  grid_count_item(parameters, body_traits, body_filter, bounds, grid, sort_value, cell_start, counts, pair_start, finds,
                  i);
}

__kernel void grid_write(__global const Parameters *parameters, __global const uint *body_traits,
                         __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                         __global const uint *sort_value, __global const uint *cell_start, __global const uint *finds,
                         __global const uint *counts, __global const uint *pair_start, __global uint *pair_a,
                         __global uint *pair_b, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  grid_write_item(parameters, body_traits, body_filter, bounds, grid, sort_value, cell_start, finds, counts, pair_start,
                  pair_a, pair_b, i);
}

__kernel void symmetric_count(__global const Parameters *parameters, __global const uint *body_traits,
                              __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                              __global const uint *sort_value, __global const uint *cell_start,
                              __global const uint *counts, __global uint *sweep_start, __global uint *finds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  symmetric_count_item(parameters, body_traits, body_filter, bounds, grid, sort_value, cell_start, counts, sweep_start,
                       finds, i);
}

__kernel void symmetric_write(__global const Parameters *parameters, __global const uint *body_traits,
                              __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                              __global const uint *sort_value, __global const uint *cell_start,
                              __global const uint *finds, __global const uint *counts, __global const uint *sweep_start,
                              __global ulong *pair_key, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  symmetric_write_item(parameters, body_traits, body_filter, bounds, grid, sort_value, cell_start, finds, counts,
                       sweep_start, pair_key, i);
}

__kernel void sweep_keys(__global const row *bounds, __global const row *grid, __global const uint *counts,
                         __global uint *sort_key, __global uint *sort_value, uint principal, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_keys_item(bounds, grid, counts, sort_key, sort_value, principal, i);
}

__kernel void sweep_gather(__global const row *bounds, __global const uint *sort_value, __global row *sweep_bounds,
                           RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_gather_item(bounds, sort_value, sweep_bounds, i);
}

__kernel void sweep_count(__global const Parameters *parameters, __global const uint *body_traits,
                          __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                          __global const row *sweep_bounds, __global const uint *sort_key,
                          __global const uint *sort_value, __global const uint *counts, __global uint *sweep_start,
                          RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_count_item(parameters, body_traits, body_filter, bounds, grid, sweep_bounds, sort_key, sort_value, counts,
                   sweep_start, i);
}

__kernel void sweep_write(__global const Parameters *parameters, __global const uint *body_traits,
                          __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                          __global const row *sweep_bounds, __global const uint *sort_key,
                          __global const uint *sort_value, __global const uint *counts,
                          __global const uint *sweep_start, __global ulong *pair_key, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_write_item(parameters, body_traits, body_filter, bounds, grid, sweep_bounds, sort_key, sort_value, counts,
                   sweep_start, pair_key, i);
}

__kernel void sweep_ends(__global const row *grid, __global const row *sweep_bounds, __global const uint *sort_key,
                         __global const uint *counts, __global uint *sweep_end, uint principal, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_ends_item(grid, sweep_bounds, sort_key, counts, sweep_end, principal, i);
}

__kernel void sweep_blocks(__global const uint *sweep_end, __global const uint *counts, __global uint *sweep_block,
                           RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_blocks_item(sweep_end, counts, sweep_block, i);
}

__kernel void window_count(__global const Parameters *parameters, __global const uint *body_traits,
                           __global const uint *body_filter, __global const row *bounds,
                           __global const row *sweep_bounds, __global const uint *sort_value,
                           __global const uint *sweep_end, __global const uint *sweep_block,
                           __global const uint *counts, __global uint *share_start, RANGE)
{
  __local uint local_memory[SWEEP_LOCAL_WORDS];
  window_count_group(parameters, body_traits, body_filter, bounds, sweep_bounds, sort_value, sweep_end, sweep_block,
                     counts, share_start, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void window_write(__global const Parameters *parameters, __global const uint *body_traits,
                           __global const uint *body_filter, __global const row *bounds,
                           __global const row *sweep_bounds, __global const uint *sort_value,
                           __global const uint *sweep_end, __global const uint *sweep_block,
                           __global const uint *counts, __global const uint *share_start, __global ulong *pair_key,
                           RANGE)
{
  __local uint local_memory[SWEEP_LOCAL_WORDS];
  window_write_group(parameters, body_traits, body_filter, bounds, sweep_bounds, sort_value, sweep_end, sweep_block,
                     counts, share_start, pair_key, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void axis_keys(__global const row *bounds, __global const uint *counts, __global uint *sort_key,
                        __global uint *sort_value, uint axis, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  axis_keys_item(bounds, counts, sort_key, sort_value, axis, i);
}

__kernel void axis_places(__global const uint *sort_value, __global const uint *counts, __global uint *axis_order,
                          __global uint *axis_place, uint axis, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  axis_places_item(sort_value, counts, axis_order, axis_place, axis, i);
}

__kernel void count_changes(__global const Parameters *parameters, __global const uint *body_traits,
                            __global const uint *body_filter, __global const row *bounds,
                            __global const uint *axis_order, __global const uint *axis_place,
                            __global const row *kept_bounds, __global const uint *kept_order,
                            __global const uint *kept_place, __global const uint *counts, __global uint *share_start,
                            RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_changes_item(parameters, body_traits, body_filter, bounds, axis_order, axis_place, kept_bounds, kept_order,
                     kept_place, counts, share_start, i);
}

__kernel void total_changes(__global const uint *share_start, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  total_changes_item(share_start, counts, i);
}

__kernel void write_changes(__global const Parameters *parameters, __global const uint *body_traits,
                            __global const uint *body_filter, __global const row *bounds,
                            __global const uint *axis_order, __global const uint *axis_place,
                            __global const row *kept_bounds, __global const uint *kept_order,
                            __global const uint *kept_place, __global const uint *counts,
                            __global const uint *share_start, __global ulong *pair_key, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  write_changes_item(parameters, body_traits, body_filter, bounds, axis_order, axis_place, kept_bounds, kept_order,
                     kept_place, counts, share_start, pair_key, i);
}

__kernel void merge_count(__global const ulong *pair_key, __global const uint *kept_start, __global const uint *kept_b,
                          __global const uint *counts, __global uint *pair_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  merge_count_item(pair_key, kept_start, kept_b, counts, pair_start, i);
}

__kernel void merge_write(__global const ulong *pair_key, __global const uint *kept_start, __global const uint *kept_b,
                          __global const uint *counts, __global const uint *pair_start, __global uint *pair_a,
                          __global uint *pair_b, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  merge_write_item(pair_key, kept_start, kept_b, counts, pair_start, pair_a, pair_b, i);
}

__kernel void keep_ends(__global const row *bounds, __global const uint *axis_order, __global const uint *axis_place,
                        __global const uint *counts, __global row *kept_bounds, __global uint *kept_order,
                        __global uint *kept_place, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  keep_ends_item(bounds, axis_order, axis_place, counts, kept_bounds, kept_order, kept_place, i);
}

__kernel void keep_or_forget(__global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  keep_or_forget_item(counts, i);
}

__kernel void count_strays(__global const row *bounds, __global const uint *leaf_body, __global const row *filed_bounds,
                           __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_strays_item(bounds, leaf_body, filed_bounds, counts, i);
}

__kernel void plan_hierarchy(__global uint *counts, uint keep, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  plan_hierarchy_item(counts, keep, i);
}

__kernel void curve_keys(__global const row *bounds, __global const row *grid, __global const uint *counts,
                         __global uint *sort_key, __global uint *sort_value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  curve_keys_item(bounds, grid, counts, sort_key, sort_value, i);
}

__kernel void file_leaves(__global const row *boxes, __global const uint *sort_value, __global uint *leaf_body,
                          __global row *filed_bounds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  file_leaves_item(boxes, sort_value, leaf_body, filed_bounds, i);
}

__kernel void link_nodes(__global const uint *sort_key, __global const uint *counts, __global uint *hierarchy_link,
                         __global uint *hierarchy_stretch, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  link_nodes_item(sort_key, counts, hierarchy_link, hierarchy_stretch, i);
}

__kernel void pyramid_leaves(__global const row *boxes, __global const uint *leaf_body, __global const uint *counts,
                             __global row *box_pyramid, __global uint *tile_changed, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  pyramid_leaves_item(boxes, leaf_body, counts, box_pyramid, tile_changed, i);
}

__kernel void pyramid_levels(__global const uint *counts, __global const uint *tile_changed, __global row *box_pyramid,
                             uint height, RANGE)
{
  pyramid_levels_group(counts, tile_changed, box_pyramid, height, 0, GROUP_NUMBER);
  END_GROUP;
}

__kernel void node_boxes(__global const row *box_pyramid, __global const uint *hierarchy_stretch,
                         __global const uint *tile_changed, __global const uint *counts, __global row *hierarchy, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  node_boxes_item(box_pyramid, hierarchy_stretch, tile_changed, counts, hierarchy, i);
}

__kernel void leave_fat_boxes(__global const Parameters *parameters, __global const row *bounds,
                              __global const row *body_velocity, __global row *fat_bounds, __global uint *body_rest,
                              __global uint *body_left, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  leave_fat_boxes_item(parameters, bounds, body_velocity, fat_bounds, body_rest, body_left, counts, i);
}

__kernel void plan_trees(__global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  plan_trees_item(counts, i);
}

__kernel void refit_leaves(__global const row *fat_bounds, __global const uint *body_left,
                           __global const uint *leaf_body, __global const row *filed_bounds,
                           __global uint *tile_changed, __global row *box_pyramid, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  refit_leaves_item(fat_bounds, body_left, leaf_body, filed_bounds, tile_changed, box_pyramid, counts, i);
}

__kernel void tree_keys(__global const uint *body_traits, __global const row *fat_bounds,
                        __global const uint *body_rest, __global const row *grid, __global const uint *counts,
                        __global uint *sort_key, __global uint *sort_value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  tree_keys_item(body_traits, fat_bounds, body_rest, grid, counts, sort_key, sort_value, i);
}

__kernel void near_count(__global const Parameters *parameters, __global const uint *body_traits,
                         __global const uint *body_filter, __global const row *fat_bounds,
                         __global const uint *body_left, __global const row *hierarchy,
                         __global const uint *hierarchy_link, __global const uint *leaf_body,
                         __global const uint *counts, __global uint *sweep_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  near_count_item(parameters, body_traits, body_filter, fat_bounds, body_left, hierarchy, hierarchy_link, leaf_body,
                  counts, sweep_start, i);
}

__kernel void count_near_keys(__global const uint *sweep_start, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_near_keys_item(sweep_start, counts, i);
}

__kernel void near_write(__global const Parameters *parameters, __global const uint *body_traits,
                         __global const uint *body_filter, __global const row *fat_bounds,
                         __global const uint *body_left, __global const row *hierarchy,
                         __global const uint *hierarchy_link, __global const uint *leaf_body,
                         __global const uint *counts, __global const uint *sweep_start, __global ulong *near_key, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  near_write_item(parameters, body_traits, body_filter, fat_bounds, body_left, hierarchy, hierarchy_link, leaf_body,
                  counts, sweep_start, near_key, i);
}

__kernel void merge_near_count(__global const uint *body_left, __global const ulong *near_key,
                               __global const uint *near_start, __global const uint *near_b,
                               __global const uint *counts, __global uint *sweep_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  merge_near_count_item(body_left, near_key, near_start, near_b, counts, sweep_start, i);
}

__kernel void merge_near_write(__global const uint *body_left, __global const ulong *near_key,
                               __global const uint *sweep_start, __global const uint *counts, __global uint *near_start,
                               __global uint *near_b, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  merge_near_write_item(body_left, near_key, sweep_start, counts, near_start, near_b, i);
}

__kernel void turn_near_list(__global const uint *sweep_start, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  turn_near_list_item(sweep_start, counts, i);
}

__kernel void filter_near(__global const row *bounds, __global const uint *near_start, __global const uint *near_b,
                          __global const uint *counts, __global uint *near_found, __global uint *pair_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  filter_near_item(bounds, near_start, near_b, counts, near_found, pair_start, i);
}

__kernel void take_near(__global const uint *near_start, __global const uint *near_found,
                        __global const uint *pair_start, __global const uint *counts, __global uint *pair_a,
                        __global uint *pair_b, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  take_near_item(near_start, near_found, pair_start, counts, pair_a, pair_b, i);
}

__kernel void keep_near(__global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  keep_near_item(counts, i);
}

__kernel void hierarchy_count(__global const Parameters *parameters, __global const uint *body_traits,
                              __global const uint *body_filter, __global const row *bounds,
                              __global const row *hierarchy, __global const uint *hierarchy_link,
                              __global const uint *leaf_body, __global const uint *counts, __global uint *pair_start,
                              __global uint *finds, uint walk, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  hierarchy_count_item(parameters, body_traits, body_filter, bounds, hierarchy, hierarchy_link, leaf_body, counts,
                       pair_start, finds, walk, i);
}

__kernel void hierarchy_write(__global const Parameters *parameters, __global const uint *body_traits,
                              __global const uint *body_filter, __global const row *bounds,
                              __global const row *hierarchy, __global const uint *hierarchy_link,
                              __global const uint *leaf_body, __global const uint *finds, __global const uint *counts,
                              __global const uint *pair_start, __global uint *pair_a, __global uint *pair_b, uint walk,
                              RANGE)
{
  FOR_EACH_IN_RANGE(i)
  hierarchy_write_item(parameters, body_traits, body_filter, bounds, hierarchy, hierarchy_link, leaf_body, finds,
                       counts, pair_start, pair_a, pair_b, walk, i);
}

__kernel void large_keys(__global const row *bounds, __global const row *grid, __global const uint *counts,
                         __global uint *sort_key, __global uint *sort_value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  large_keys_item(bounds, grid, counts, sort_key, sort_value, i);
}

__kernel void plan_large(__global const uint *sort_key, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  plan_large_item(sort_key, counts, i);
}

__kernel void large_count(__global const Parameters *parameters, __global const uint *body_traits,
                          __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                          __global const row *hierarchy, __global const uint *hierarchy_link,
                          __global const uint *leaf_body, __global const uint *counts, __global uint *large_finds,
                          __global uint *finds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  large_count_item(parameters, body_traits, body_filter, bounds, grid, hierarchy, hierarchy_link, leaf_body, counts,
                   large_finds, finds, i);
}

__kernel void small_keys(__global const row *bounds, __global const row *grid, __global const uint *counts,
                         __global uint *sort_key, __global uint *sort_value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  small_keys_item(bounds, grid, counts, sort_key, sort_value, i);
}

__kernel void small_count(__global const Parameters *parameters, __global const uint *body_traits,
                          __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                          __global const uint *sort_value, __global const uint *cell_start, __global const uint *counts,
                          __global uint *small_finds, __global uint *grid_finds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  small_count_item(parameters, body_traits, body_filter, bounds, grid, sort_value, cell_start, counts, small_finds,
                   grid_finds, i);
}

__kernel void join_finds(__global const uint *small_finds, __global const uint *large_finds, __global uint *share_start,
                         RANGE)
{
  FOR_EACH_IN_RANGE(i)
  join_finds_item(small_finds, large_finds, share_start, i);
}

__kernel void large_write(__global const Parameters *parameters, __global const uint *body_traits,
                          __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                          __global const row *hierarchy, __global const uint *hierarchy_link,
                          __global const uint *leaf_body, __global const uint *finds, __global const uint *counts,
                          __global const uint *share_start, __global ulong *pair_key, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  large_write_item(parameters, body_traits, body_filter, bounds, grid, hierarchy, hierarchy_link, leaf_body, finds,
                   counts, share_start, pair_key, i);
}

__kernel void small_write(__global const Parameters *parameters, __global const uint *body_traits,
                          __global const uint *body_filter, __global const row *bounds, __global const row *grid,
                          __global const uint *sort_value, __global const uint *cell_start,
                          __global const uint *grid_finds, __global const uint *counts,
                          __global const uint *share_start, __global ulong *pair_key, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  small_write_item(parameters, body_traits, body_filter, bounds, grid, sort_value, cell_start, grid_finds, counts,
                   share_start, pair_key, i);
}

__kernel void count_pairs(__global const uint *starts, __global uint *counts, uint length, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_pairs_item(starts, counts, length, i);
}

__kernel void unpack_pairs(__global const ulong *pair_key, __global uint *pair_a, __global uint *pair_b, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  unpack_pairs_item(pair_key, pair_a, pair_b, i);
}

__kernel void start_pairs(__global const uint *pair_a, __global const uint *counts, __global uint *pair_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  start_pairs_item(pair_a, counts, pair_start, i);
}
