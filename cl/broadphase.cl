/* broadphase.cl - entries: bounds, and the broadphases over them. */
#include "cl/entry.h"
#include "shared/broadphase/bounds.h"
#include "shared/broadphase/brute_force.h"
#include "shared/broadphase/extent.h"
#include "shared/broadphase/grid.h"
#include "shared/broadphase/hierarchy_walks.h"
#include "shared/broadphase/sweep.h"
#include "shared/broadphase/overlap.h"

__kernel void compute_bounds(__global const Parameters *parameters, __global const uint *body_traits,
                             __global const row *body_shape, __global const row *body_shape_pose,
                             __global const row *body_mass, __global const row *body_position, __global const row *body_orientation,
                             __global const row *body_velocity, __global row *bounds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  compute_bounds_item(parameters, body_traits, body_shape, body_shape_pose, body_mass, body_position, body_orientation,
                      body_velocity, bounds, i);
}

__kernel void brute_force_count(__global const Parameters *parameters, __global const uint *body_traits,
                                __global const uint *body_filter, __global const row *bounds,
                                __global uint *pair_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  brute_force_count_item(parameters, body_traits, body_filter, bounds, pair_start, i);
}

__kernel void brute_force_write(__global const Parameters *parameters, __global const uint *body_traits,
                                __global const uint *body_filter, __global const row *bounds,
                                __global const uint *pair_start, __global const uint *counts,
                                __global uint *pair_a, __global uint *pair_b, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  brute_force_write_item(parameters, body_traits, body_filter, bounds, pair_start, counts, pair_a, pair_b, i);
}

__kernel void extent_tiles(__global const row *bounds, __global const uint *counts, __global row *bounds_sums,
                           RANGE)
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

__kernel void lay_out(__global const Parameters *parameters, __global const row *bounds_sums,
                      __global row *grid, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  lay_out_item(parameters, bounds_sums, grid, counts, i);
}

__kernel void grid_keys(__global const row *bounds, __global const row *grid, __global const uint *counts,
                        __global uint *sort_key, __global uint *sort_value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  grid_keys_item(bounds, grid, counts, sort_key, sort_value, i);
}

__kernel void grid_cells(__global const uint *sort_key, __global const uint *counts, __global uint *cell_start,
                         RANGE)
{
  FOR_EACH_IN_RANGE(i)
  grid_cells_item(sort_key, counts, cell_start, i);
}

__kernel void grid_count(__global const Parameters *parameters, __global const uint *body_traits,
                         __global const uint *body_filter, __global const row *bounds,
                         __global const row *grid, __global const uint *sort_value,
                         __global const uint *cell_start, __global const uint *counts,
                         __global uint *pair_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  grid_count_item(parameters, body_traits, body_filter, bounds, grid, sort_value, cell_start, counts,
                  pair_start, i);
}

__kernel void grid_write(__global const Parameters *parameters, __global const uint *body_traits,
                         __global const uint *body_filter, __global const row *bounds,
                         __global const row *grid, __global const uint *sort_value,
                         __global const uint *cell_start, __global const uint *counts,
                         __global const uint *pair_start, __global uint *pair_a, __global uint *pair_b, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  grid_write_item(parameters, body_traits, body_filter, bounds, grid, sort_value, cell_start, counts,
                  pair_start, pair_a, pair_b, i);
}

__kernel void sweep_keys(__global const row *bounds, __global const uint *counts, __global uint *sort_key,
                         __global uint *sort_value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_keys_item(bounds, counts, sort_key, sort_value, i);
}

__kernel void sweep_gather(__global const row *bounds, __global const uint *sort_value,
                           __global row *sweep_bounds, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_gather_item(bounds, sort_value, sweep_bounds, i);
}

__kernel void sweep_count(__global const Parameters *parameters, __global const uint *body_traits,
                          __global const uint *body_filter, __global const row *bounds,
                          __global const row *sweep_bounds, __global const uint *sort_value,
                          __global const uint *counts, __global uint *sweep_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_count_item(parameters, body_traits, body_filter, bounds, sweep_bounds, sort_value, counts, sweep_start,
                   i);
}

__kernel void sweep_write(__global const Parameters *parameters, __global const uint *body_traits,
                          __global const uint *body_filter, __global const row *bounds,
                          __global const row *sweep_bounds, __global const uint *sort_value,
                          __global const uint *counts, __global const uint *sweep_start,
                          __global ulong *pair_key, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_write_item(parameters, body_traits, body_filter, bounds, sweep_bounds, sort_value, counts, sweep_start,
                   pair_key, i);
}

__kernel void sweep_unpack(__global const ulong *pair_key, __global uint *pair_a, __global uint *pair_b, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_unpack_item(pair_key, pair_a, pair_b, i);
}

__kernel void sweep_starts(__global const uint *pair_a, __global const uint *counts, __global uint *pair_start,
                           RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_starts_item(pair_a, counts, pair_start, i);
}

__kernel void curve_keys(__global const row *bounds, __global const row *grid, __global const uint *counts,
                         __global uint *sort_key, __global uint *sort_value, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  curve_keys_item(bounds, grid, counts, sort_key, sort_value, i);
}

__kernel void hierarchy_leaves(__global const row *bounds, __global const uint *sort_value, __global const uint *counts,
                               __global row *hierarchy, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  hierarchy_leaves_item(bounds, sort_value, counts, hierarchy, i);
}

__kernel void hierarchy_levels(__global const uint *counts, __global row *hierarchy, uint height, RANGE)
{
  hierarchy_levels_group(counts, hierarchy, height, 0, GROUP_NUMBER);
  END_GROUP;
}

__kernel void hierarchy_count(__global const Parameters *parameters, __global const uint *body_traits,
                              __global const uint *body_filter, __global const row *bounds,
                              __global const row *hierarchy, __global const uint *sort_value,
                              __global const uint *counts, __global uint *pair_start, uint walk, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  hierarchy_count_item(parameters, body_traits, body_filter, bounds, hierarchy, sort_value, counts, pair_start,
                       walk, i);
}

__kernel void hierarchy_write(__global const Parameters *parameters, __global const uint *body_traits,
                              __global const uint *body_filter, __global const row *bounds,
                              __global const row *hierarchy, __global const uint *sort_value,
                              __global const uint *counts, __global const uint *pair_start,
                              __global uint *pair_a, __global uint *pair_b, uint walk, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  hierarchy_write_item(parameters, body_traits, body_filter, bounds, hierarchy, sort_value, counts, pair_start,
                       pair_a, pair_b, walk, i);
}

__kernel void count_pairs(__global const uint *pair_start, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_pairs_item(pair_start, counts, i);
}
