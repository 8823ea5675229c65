/* queries.cl - entries: rays and boxes against all bodies, between steps. */
#include "cl/entry.h"
#include "shared/queries/box_queries.h"
#include "shared/queries/cast_rays.h"

__kernel void
cast_rays(__global const Parameters *parameters, __global const uint *counts, __global const uint *body_traits,
          __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
          __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
          __global const uint *body_tree, __global const uint *tree_header, __global const row *tree_frame,
          __global const uint *tree_node, __global const uint *tree_leaf, __global const row *mesh_vertex,
          __global const uint *mesh_triangle, __global const row *body_position, __global const row *body_orientation,
          __global const row *hierarchy, __global const uint *hierarchy_link, __global const uint *leaf_body,
          __global const row *bounds, __global const row *grid, __global const uint *sort_value,
          __global const uint *cell_start, __global const uint *query_body, __global const uint *query_filter,
          __global const row *query_start, __global const row *query_way, __global row *query_hit,
          __global row *query_point, __global uint *query_hit_body, uint structure, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  cast_rays_item(parameters, counts, body_traits, body_shape, body_convex, body_shape_pose, hull_header, hull_vertex,
                 hull_plane, body_tree, tree_header, tree_frame, tree_node, tree_leaf, mesh_vertex, mesh_triangle,
                 body_position, body_orientation, hierarchy, hierarchy_link, leaf_body, bounds, grid, sort_value,
                 cell_start, query_body, query_filter, query_start, query_way, query_hit, query_point, query_hit_body,
                 structure, i);
}

__kernel void
find_blocked_rays(__global const Parameters *parameters, __global const uint *counts, __global const uint *body_traits,
                  __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
                  __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
                  __global const uint *body_tree, __global const uint *tree_header, __global const row *tree_frame,
                  __global const uint *tree_node, __global const uint *tree_leaf, __global const row *mesh_vertex,
                  __global const uint *mesh_triangle, __global const row *body_position,
                  __global const row *body_orientation, __global const row *hierarchy,
                  __global const uint *hierarchy_link, __global const uint *leaf_body, __global const row *bounds,
                  __global const row *grid, __global const uint *sort_value, __global const uint *cell_start,
                  __global const uint *query_body, __global const uint *query_filter, __global const row *query_start,
                  __global const row *query_way, __global uint *query_found, uint structure, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  find_blocked_rays_item(parameters, counts, body_traits, body_shape, body_convex, body_shape_pose, hull_header,
                         hull_vertex, hull_plane, body_tree, tree_header, tree_frame, tree_node, tree_leaf, mesh_vertex,
                         mesh_triangle, body_position, body_orientation, hierarchy, hierarchy_link, leaf_body, bounds,
                         grid, sort_value, cell_start, query_body, query_filter, query_start, query_way, query_found,
                         structure, i);
}

__kernel void
count_ray_hits(__global const Parameters *parameters, __global const uint *counts, __global const uint *body_traits,
               __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
               __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
               __global const uint *body_tree, __global const uint *tree_header, __global const row *tree_frame,
               __global const uint *tree_node, __global const uint *tree_leaf, __global const row *mesh_vertex,
               __global const uint *mesh_triangle, __global const row *body_position,
               __global const row *body_orientation, __global const row *hierarchy, __global const uint *hierarchy_link,
               __global const uint *leaf_body, __global const row *bounds, __global const row *grid,
               __global const uint *sort_value, __global const uint *cell_start, __global const uint *query_body,
               __global const uint *query_filter, __global const row *query_start, __global const row *query_way,
               __global uint *query_found, uint structure, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_ray_hits_item(parameters, counts, body_traits, body_shape, body_convex, body_shape_pose, hull_header,
                      hull_vertex, hull_plane, body_tree, tree_header, tree_frame, tree_node, tree_leaf, mesh_vertex,
                      mesh_triangle, body_position, body_orientation, hierarchy, hierarchy_link, leaf_body, bounds,
                      grid, sort_value, cell_start, query_body, query_filter, query_start, query_way, query_found,
                      structure, i);
}

__kernel void
write_ray_hits(__global const Parameters *parameters, __global const uint *counts, __global const uint *body_traits,
               __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
               __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
               __global const uint *body_tree, __global const uint *tree_header, __global const row *tree_frame,
               __global const uint *tree_node, __global const uint *tree_leaf, __global const row *mesh_vertex,
               __global const uint *mesh_triangle, __global const row *body_position,
               __global const row *body_orientation, __global const row *hierarchy, __global const uint *hierarchy_link,
               __global const uint *leaf_body, __global const row *bounds, __global const row *grid,
               __global const uint *sort_value, __global const uint *cell_start, __global const uint *query_body,
               __global const uint *query_filter, __global const row *query_start, __global const row *query_way,
               __global const uint *query_found, __global row *query_hit, __global row *query_point,
               __global uint *query_hit_body, uint structure, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  write_ray_hits_item(parameters, counts, body_traits, body_shape, body_convex, body_shape_pose, hull_header,
                      hull_vertex, hull_plane, body_tree, tree_header, tree_frame, tree_node, tree_leaf, mesh_vertex,
                      mesh_triangle, body_position, body_orientation, hierarchy, hierarchy_link, leaf_body, bounds,
                      grid, sort_value, cell_start, query_body, query_filter, query_start, query_way, query_found,
                      query_hit, query_point, query_hit_body, structure, i);
}

__kernel void count_box_hits(__global const uint *counts, __global const uint *body_traits,
                             __global const row *hierarchy, __global const uint *hierarchy_link,
                             __global const uint *leaf_body, __global const row *bounds, __global const row *grid,
                             __global const uint *sort_value, __global const uint *cell_start,
                             __global const uint *query_body, __global const uint *query_filter,
                             __global const row *query_start, __global const row *query_way,
                             __global const row *query_extent, __global uint *query_found, uint structure, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_box_hits_item(counts, body_traits, hierarchy, hierarchy_link, leaf_body, bounds, grid, sort_value, cell_start,
                      query_body, query_filter, query_start, query_way, query_extent, query_found, structure, i);
}

__kernel void write_box_hits(__global const uint *counts, __global const uint *body_traits,
                             __global const row *hierarchy, __global const uint *hierarchy_link,
                             __global const uint *leaf_body, __global const row *bounds, __global const row *grid,
                             __global const uint *sort_value, __global const uint *cell_start,
                             __global const uint *query_body, __global const uint *query_filter,
                             __global const row *query_start, __global const row *query_way,
                             __global const row *query_extent, __global const uint *query_found,
                             __global row *query_hit, __global uint *query_hit_body, uint structure, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  write_box_hits_item(counts, body_traits, hierarchy, hierarchy_link, leaf_body, bounds, grid, sort_value, cell_start,
                      query_body, query_filter, query_start, query_way, query_extent, query_found, query_hit,
                      query_hit_body, structure, i);
}
