/* sweeps.cl - entries: a convex shape of any kind, also one that the scene lacks, on straight ways. */
#define ASKED_ABOUT_ANY_SHAPE
#include "cl/entry.h"
#include "shared/sweeps/sweep_shape.h"

__kernel void
sweep_shape(__global const Parameters *parameters, __global const uint *counts, __global const uint *body_traits,
            __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
            __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_strip,
            __global const uint *body_tree, __global const uint *tree_header, __global const row *tree_frame,
            __global const uint *tree_node, __global const uint *tree_leaf, __global const row *mesh_vertex,
            __global const uint *mesh_triangle, __global const row *body_position, __global const row *body_orientation,
            __global const row *hierarchy, __global const uint *hierarchy_link, __global const uint *leaf_body,
            __global const row *bounds, __global const row *grid, __global const uint *sort_value,
            __global const uint *cell_start, __global const uint *query_body, __global const uint *query_filter,
            __global const row *query_start, __global const row *query_turn, __global const row *query_way,
            __global const row *query_shape, __global const row *query_vertex, __global const row *query_strip,
            __global row *query_hit, __global row *query_point, __global uint *query_hit_body, uint kind, uint vertices,
            uint structure, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  sweep_shape_item(parameters, counts, body_traits, body_shape, body_convex, body_shape_pose, hull_header, hull_vertex,
                   hull_strip, body_tree, tree_header, tree_frame, tree_node, tree_leaf, mesh_vertex, mesh_triangle,
                   body_position, body_orientation, hierarchy, hierarchy_link, leaf_body, bounds, grid, sort_value,
                   cell_start, query_body, query_filter, query_start, query_turn, query_way, query_shape, query_vertex,
                   query_strip, query_hit, query_point, query_hit_body, kind, vertices, structure, i);
}
