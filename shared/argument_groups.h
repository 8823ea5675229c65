/* argument_groups.h - buffers that always travel together, by one name.
 *
 * A group lists its buffers once: GROUP_name(BUFFER) is BUFFER(name in buffers.def, type, name within the group) for
 * each. A row of kernels.def names it, as IN_GROUP(name), OUT_GROUP(name) or INOUT_GROUP(name), and is launched with
 * all its buffers, in this order; the shared function takes one struct, read_name or write_name. Of buffers that a
 * scene lacks nothing may be read, as of any other argument.
 */
#ifndef TANDEM_SHARED_ARGUMENT_GROUPS_H
#define TANDEM_SHARED_ARGUMENT_GROUPS_H

#include "shared/platform.h"

#define READ_MEMBER(buffer, type, member) GLOBAL const type *member;
#define WRITE_MEMBER(buffer, type, member) GLOBAL type *member;

/* --- the scene: shapes and what they are made of ---------------------------------------------------------- */
#define GROUP_shapes(BUFFER)                                                                                           \
  BUFFER(body_traits, uint, traits)                                                                                    \
  BUFFER(body_shape, row, size)                                                                                        \
  BUFFER(body_convex, uint, convex)                                                                                    \
  BUFFER(body_shape_pose, row, pose)

/* Of hulls, and of triangles of meshes. */
#define GROUP_surfaces(BUFFER)                                                                                         \
  BUFFER(hull_header, uint, header)                                                                                    \
  BUFFER(hull_vertex, row, vertex)                                                                                     \
  BUFFER(hull_plane, row, plane)                                                                                       \
  BUFFER(hull_face_start, uint, face_start)                                                                            \
  BUFFER(hull_corner, uint, corner)                                                                                    \
  BUFFER(hull_edge, uint, edge)                                                                                        \
  BUFFER(hull_strip, row, strip)                                                                                       \
  BUFFER(hull_link, uint, link)                                                                                        \
  BUFFER(mesh_vertex, row, mesh_vertex)                                                                                \
  BUFFER(mesh_triangle, uint, triangle)

/* Of compounds and meshes. */
#define GROUP_trees(BUFFER)                                                                                            \
  BUFFER(body_tree, uint, of_body)                                                                                     \
  BUFFER(tree_header, uint, header)                                                                                    \
  BUFFER(tree_frame, row, frame)                                                                                       \
  BUFFER(tree_node, uint, node)                                                                                        \
  BUFFER(tree_leaf, uint, leaf)

typedef struct {
  GROUP_shapes(READ_MEMBER)
} read_shapes;
typedef struct {
  GROUP_surfaces(READ_MEMBER)
} read_surfaces;
typedef struct {
  GROUP_trees(READ_MEMBER)
} read_trees;

/* --- bodies ------------------------------------------------------------------------------------------------ */
#define GROUP_bodies(BUFFER)                                                                                           \
  BUFFER(body_position, row, position)                                                                                 \
  BUFFER(body_orientation, row, orientation)                                                                           \
  BUFFER(body_velocity, row, velocity)

typedef struct {
  GROUP_bodies(READ_MEMBER)
} read_bodies;

/* --- pairs and their manifolds ------------------------------------------------------------------------------ */
#define GROUP_pairs(BUFFER)                                                                                            \
  BUFFER(pair_a, uint, a)                                                                                              \
  BUFFER(pair_b, uint, b)

/* With the child or triangle of each body that takes part. */
#define GROUP_part_pairs(BUFFER)                                                                                       \
  BUFFER(pair_a, uint, a)                                                                                              \
  BUFFER(pair_b, uint, b)                                                                                              \
  BUFFER(pair_leaf, uint, leaf)

/* What the midphase makes of pairs of bodies; part_pairs from then on. */
#define GROUP_pairs_of_leaves(BUFFER)                                                                                  \
  BUFFER(leaf_pair_a, uint, a)                                                                                         \
  BUFFER(leaf_pair_b, uint, b)                                                                                         \
  BUFFER(pair_leaf, uint, leaf)

#define GROUP_manifolds(BUFFER)                                                                                        \
  BUFFER(manifold_normal, row, normal)                                                                                 \
  BUFFER(manifold_points, row, points)                                                                                 \
  BUFFER(manifold_count, uint, count)                                                                                  \
  BUFFER(manifold_feature, uint, feature)

typedef struct {
  GROUP_pairs(READ_MEMBER)
} read_pairs;
typedef struct {
  GROUP_part_pairs(READ_MEMBER)
} read_part_pairs;
typedef struct {
  GROUP_pairs_of_leaves(WRITE_MEMBER)
} write_pairs_of_leaves;
typedef struct {
  GROUP_manifolds(READ_MEMBER)
} read_manifolds;
typedef struct {
  GROUP_manifolds(WRITE_MEMBER)
} write_manifolds;

/* Between the kernels of narrowphase/sat_split.h. */
#define GROUP_separating_axes(BUFFER)                                                                                  \
  BUFFER(split_axis, row, axis)                                                                                        \
  BUFFER(split_state, uint, state)

#define GROUP_clipped_points(BUFFER)                                                                                   \
  BUFFER(split_point, row, point)                                                                                      \
  BUFFER(split_count, uint, count)

typedef struct {
  GROUP_separating_axes(READ_MEMBER)
} read_separating_axes;
typedef struct {
  GROUP_separating_axes(WRITE_MEMBER)
} write_separating_axes;
typedef struct {
  GROUP_clipped_points(READ_MEMBER)
} read_clipped_points;
typedef struct {
  GROUP_clipped_points(WRITE_MEMBER)
} write_clipped_points;

#endif
