/* midphase.cl - entries of shared/midphase. */
#include "cl/entry.h"
#include "shared/midphase/leaf_pairs.h"
#include "shared/midphase/subtree_pairs.h"
#include "shared/midphase/grazing.h"

__kernel void count_leaf_pairs(__global const Parameters *parameters, __global const uint *pair_a,
                               __global const uint *pair_b, __global const uint *body_traits,
                               __global const uint *body_filter, __global const row *body_shape,
                               __global const row *body_shape_pose, __global const uint *body_tree,
                               __global const uint *tree_header, __global const row *tree_frame,
                               __global const uint *tree_node, __global const uint *tree_leaf,
                               __global const row *body_position, __global const row *body_orientation,
                               __global const row *body_velocity, __global uint *leaf_start, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_leaf_pairs_item(parameters, pair_a, pair_b, body_traits, body_filter, body_shape, body_shape_pose, body_tree,
                        tree_header, tree_frame, tree_node, tree_leaf, body_position, body_orientation, body_velocity,
                        leaf_start, i);
}

__kernel void count_all_leaf_pairs(__global const uint *leaf_start, __global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  count_all_leaf_pairs_item(leaf_start, counts, i);
}

__kernel void
write_leaf_pairs(__global const Parameters *parameters, __global const uint *pair_a, __global const uint *pair_b,
                 __global const uint *body_traits, __global const uint *body_filter, __global const row *body_shape,
                 __global const row *body_shape_pose, __global const uint *body_tree, __global const uint *tree_header,
                 __global const row *tree_frame, __global const uint *tree_node, __global const uint *tree_leaf,
                 __global const row *body_position, __global const row *body_orientation,
                 __global const row *body_velocity, __global const uint *leaf_start, __global const uint *counts,
                 __global uint *leaf_pair_a, __global uint *leaf_pair_b, __global uint *pair_leaf, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  write_leaf_pairs_item(parameters, pair_a, pair_b, body_traits, body_filter, body_shape, body_shape_pose, body_tree,
                        tree_header, tree_frame, tree_node, tree_leaf, body_position, body_orientation, body_velocity,
                        leaf_start, counts, leaf_pair_a, leaf_pair_b, pair_leaf, i);
}

__kernel void group_body_pairs(__global uint *counts, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  group_body_pairs_item(counts, i);
}

__kernel void count_leaf_pairs_by_subtree(__global const Parameters *parameters, __global const uint *pair_a,
                                          __global const uint *pair_b, __global const uint *body_traits,
                                          __global const uint *body_filter, __global const row *body_shape,
                                          __global const row *body_shape_pose, __global const uint *body_tree,
                                          __global const uint *tree_header, __global const row *tree_frame,
                                          __global const uint *tree_node, __global const uint *tree_leaf,
                                          __global const uint *tree_subtree, __global const row *body_position,
                                          __global const row *body_orientation, __global const row *body_velocity,
                                          __global const uint *counts, __global uint *leaf_start, RANGE)
{
  __local uint local_memory[SUBTREE_LOCAL_WORDS];
  count_leaf_pairs_by_subtree_group(parameters, pair_a, pair_b, body_traits, body_filter, body_shape, body_shape_pose,
                                    body_tree, tree_header, tree_frame, tree_node, tree_leaf, tree_subtree,
                                    body_position, body_orientation, body_velocity, counts, leaf_start, local_memory,
                                    GROUP_NUMBER);
  END_GROUP;
}

__kernel void write_leaf_pairs_by_subtree(
    __global const Parameters *parameters, __global const uint *pair_a, __global const uint *pair_b,
    __global const uint *body_traits, __global const uint *body_filter, __global const row *body_shape,
    __global const row *body_shape_pose, __global const uint *body_tree, __global const uint *tree_header,
    __global const row *tree_frame, __global const uint *tree_node, __global const uint *tree_leaf,
    __global const uint *tree_subtree, __global const row *body_position, __global const row *body_orientation,
    __global const row *body_velocity, __global const uint *leaf_start, __global const uint *counts,
    __global uint *leaf_pair_a, __global uint *leaf_pair_b, __global uint *pair_leaf, RANGE)
{
  __local uint local_memory[SUBTREE_LOCAL_WORDS];
  write_leaf_pairs_by_subtree_group(parameters, pair_a, pair_b, body_traits, body_filter, body_shape, body_shape_pose,
                                    body_tree, tree_header, tree_frame, tree_node, tree_leaf, tree_subtree,
                                    body_position, body_orientation, body_velocity, leaf_start, counts, leaf_pair_a,
                                    leaf_pair_b, pair_leaf, local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void start_leaf_pairs(__global const uint *leaf_start, __global const uint *counts, __global uint *pair_start,
                               RANGE)
{
  FOR_EACH_IN_RANGE(i)
  start_leaf_pairs_item(leaf_start, counts, pair_start, i);
}

__kernel void group_manifolds(__global const Parameters *parameters, __global const uint *pair_a,
                              __global const uint *pair_b, __global const uint *pair_leaf,
                              __global const uint *body_traits, __global const row *body_velocity,
                              __global const row *manifold_normal, __global const uint *manifold_count,
                              __global const uint *counts, __global uint *manifold_group, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  group_manifolds_item(parameters, pair_a, pair_b, pair_leaf, body_traits, body_velocity, manifold_normal,
                       manifold_count, counts, manifold_group, i);
}

__kernel void merge_manifolds(__global const uint *pair_a, __global const uint *pair_b, __global const row *body_shape,
                              __global const uint *manifold_group, __global const uint *counts,
                              __global row *manifold_normal, __global row *manifold_points,
                              __global uint *manifold_count, __global uint *manifold_feature, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  merge_manifolds_item(pair_a, pair_b, body_shape, manifold_group, counts, manifold_normal, manifold_points,
                       manifold_count, manifold_feature, i);
}

__kernel void find_grazing(__global const Parameters *parameters, __global const uint *pair_a,
                           __global const uint *pair_b, __global const row *body_shape,
                           __global const row *manifold_normal, __global const row *manifold_points,
                           __global const uint *manifold_count, __global const uint *counts,
                           __global uint *manifold_grazing, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  find_grazing_item(parameters, pair_a, pair_b, body_shape, manifold_normal, manifold_points, manifold_count, counts,
                    manifold_grazing, i);
}

__kernel void drop_grazing(__global const uint *manifold_grazing, __global const uint *counts,
                           __global row *manifold_normal, __global row *manifold_points, __global uint *manifold_count,
                           __global uint *manifold_feature, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  drop_grazing_item(manifold_grazing, counts, manifold_normal, manifold_points, manifold_count, manifold_feature, i);
}
