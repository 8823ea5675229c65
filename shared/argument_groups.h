/* argument_groups.h - groups of buffers that kernels always take together.
 *
 * A group lists its buffers once: GROUP_name(BUFFER) is BUFFER(name in buffers.def, type, name within the group) for
 * each. A row of kernels.def names it, as IN_GROUP(name), OUT_GROUP(name) or INOUT_GROUP(name), and is launched with
 * all its buffers, in this order. The shared function takes one struct, read_name or write_name. A kernel must not read
 * a buffer that the scene lacks, in a group or outside of one.
 */
#ifndef TANDEM_SHARED_ARGUMENT_GROUPS_H
#define TANDEM_SHARED_ARGUMENT_GROUPS_H

#include "shared/real.h"

#define READ_MEMBER(buffer, type, member) GLOBAL const type *member;
#define WRITE_MEMBER(buffer, type, member) GLOBAL type *member;

/* --- the scene: shapes and what they are made of ---------------------------------------------------------- */
#define GROUP_shapes(BUFFER)                                                                                           \
  BUFFER(body_flags, uint, flags)                                                                                      \
  BUFFER(body_shape, float4, size)                                                                                     \
  BUFFER(body_convex, uint, convex)                                                                                    \
  BUFFER(body_shape_pose, float4, pose)

/* The tables of hulls, and of the triangles of meshes. */
#define GROUP_surfaces(BUFFER)                                                                                         \
  BUFFER(hull_header, uint, header)                                                                                    \
  BUFFER(hull_vertex, float4, vertex)                                                                                  \
  BUFFER(hull_plane, float4, plane)                                                                                    \
  BUFFER(hull_face_start, uint, face_start)                                                                            \
  BUFFER(hull_corner, uint, corner)                                                                                    \
  BUFFER(hull_edge, uint, edge)                                                                                        \
  BUFFER(hull_chunk, float4, chunk)                                                                                    \
  BUFFER(hull_link, uint, link)                                                                                        \
  BUFFER(mesh_vertex, float4, mesh_vertex)                                                                             \
  BUFFER(mesh_triangle, uint, triangle)

/* The trees of compounds and meshes. */
#define GROUP_trees(BUFFER)                                                                                            \
  BUFFER(body_tree, uint, of_body)                                                                                     \
  BUFFER(tree_header, uint, header)                                                                                    \
  BUFFER(tree_frame, float4, frame)                                                                                    \
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
  BUFFER(body_position, float4, position)                                                                              \
  BUFFER(body_orientation, float4, orientation)                                                                        \
  BUFFER(body_velocity, float4, velocity)                                                                              \
  BUFFER(body_gravity, float4, gravity)

/* The bodies that the setup of a contact reads. */
#define GROUP_touching_bodies(BUFFER)                                                                                  \
  BUFFER(body_flags, uint, flags)                                                                                      \
  BUFFER(body_shape, float4, shape)                                                                                    \
  BUFFER(body_mass, float4, mass)                                                                                      \
  BUFFER(body_gravity, float4, gravity)                                                                                \
  BUFFER(body_position, float4, position)                                                                              \
  BUFFER(solver_velocity, float4, velocity)                                                                            \
  BUFFER(solver_inertia, float4, inertia)                                                                              \
  BUFFER(body_class, uint, substep_class)

/* The bodies of the solver, for kernels that only read velocities. */
#define GROUP_solver_bodies(BUFFER)                                                                                    \
  BUFFER(solver_velocity, float4, velocity)                                                                            \
  BUFFER(solver_inertia, float4, inertia)                                                                              \
  BUFFER(solver_delta_pose, float4, delta)

/* The bodies of solve/avbd_bodies.h, each a block of the descent, and their order by colour. */
#define GROUP_blocks(BUFFER)                                                                                           \
  BUFFER(body_mass, float4, mass)                                                                                      \
  BUFFER(avbd_target, float4, target)                                                                                  \
  BUFFER(solver_inertia, float4, inertia)                                                                              \
  BUFFER(solver_delta_pose, float4, delta)                                                                             \
  BUFFER(solver_orientation, float4, orientation)                                                                      \
  BUFFER(sort_value, uint, order)

/* The bodies of joints: with orientations, because arms and frames turn with them, and with their classes, because not
 * every pass moves all (substep_classes.h). */
#define GROUP_turning_bodies(BUFFER)                                                                                   \
  BUFFER(solver_inertia, float4, inertia)                                                                              \
  BUFFER(solver_delta_pose, float4, delta)                                                                             \
  BUFFER(solver_orientation, float4, orientation)                                                                      \
  BUFFER(body_class, uint, substep_class)

/* The nodes of the graph of contacts: batching/nodes.h. */
#define GROUP_nodes(BUFFER)                                                                                            \
  BUFFER(body_flags, uint, flags)                                                                                      \
  BUFFER(body_link, uint, link)

/* What the colouring of contacts notes at their bodies. */
#define GROUP_colored_bodies(BUFFER)                                                                                   \
  BUFFER(body_colors, uint, colors)                                                                                    \
  BUFFER(body_bid, uint, bid)

/* The calls of a program, sorted by body. */
#define GROUP_commands(BUFFER)                                                                                         \
  BUFFER(command_start, uint, start)                                                                                   \
  BUFFER(command, uint, command)                                                                                       \
  BUFFER(command_value, float4, value)

typedef struct {
  GROUP_bodies(READ_MEMBER)
} read_bodies;
typedef struct {
  GROUP_commands(READ_MEMBER)
} read_commands;
typedef struct {
  GROUP_touching_bodies(READ_MEMBER)
} read_touching_bodies;
typedef struct {
  GROUP_solver_bodies(READ_MEMBER)
} read_solver_bodies;
typedef struct {
  GROUP_turning_bodies(READ_MEMBER)
} read_turning_bodies;
typedef struct {
  GROUP_blocks(READ_MEMBER)
} read_blocks;
typedef struct {
  GROUP_nodes(READ_MEMBER)
} read_nodes;
typedef struct {
  GROUP_colored_bodies(WRITE_MEMBER)
} write_colored_bodies;

/* --- broadphase ------------------------------------------------------------------------------------------- */
/* The nodes of broadphase/hierarchy.h: boxes, links, and the bodies of the leaves. */
#define GROUP_hierarchy_nodes(BUFFER)                                                                                  \
  BUFFER(hierarchy, float4, box)                                                                                       \
  BUFFER(hierarchy_link, uint, link)                                                                                   \
  BUFFER(leaf_body, uint, leaf_body)

/* The intervals of broadphase/sweep_window.h in the order of the sweep: boxes, their bodies, the end of each interval,
 * and the last end in each block. */
#define GROUP_sweep_intervals(BUFFER)                                                                                  \
  BUFFER(sweep_bounds, float4, bounds)                                                                                 \
  BUFFER(sort_value, uint, body)                                                                                       \
  BUFFER(sweep_end, uint, end)                                                                                         \
  BUFFER(sweep_block, uint, block)

/* The sorted endpoints of boxes along each axis, and the place of each endpoint; then both as the last launch kept
 * them, with the boxes. */
#define GROUP_box_ends(BUFFER)                                                                                         \
  BUFFER(axis_order, uint, order)                                                                                      \
  BUFFER(axis_place, uint, place)

#define GROUP_kept_box_ends(BUFFER)                                                                                    \
  BUFFER(kept_bounds, float4, bounds)                                                                                  \
  BUFFER(kept_order, uint, order)                                                                                      \
  BUFFER(kept_place, uint, place)

/* The bodies that sleep: sleeping/sleeper_table.h. */
#define GROUP_sleepers(BUFFER)                                                                                         \
  BUFFER(sleeper_key, uint, key)                                                                                       \
  BUFFER(sleeper_body, uint, body)                                                                                     \
  BUFFER(sleeper_bounds, float4, bounds)

typedef struct {
  GROUP_sleepers(READ_MEMBER)
} read_sleepers;
typedef struct {
  GROUP_sleepers(WRITE_MEMBER)
} write_sleepers;
typedef struct {
  GROUP_hierarchy_nodes(READ_MEMBER)
} read_hierarchy_nodes;
typedef struct {
  GROUP_sweep_intervals(READ_MEMBER)
} read_sweep_intervals;
typedef struct {
  GROUP_box_ends(READ_MEMBER)
} read_box_ends;
typedef struct {
  GROUP_kept_box_ends(READ_MEMBER)
} read_kept_box_ends;
typedef struct {
  GROUP_kept_box_ends(WRITE_MEMBER)
} write_kept_box_ends;

/* --- pairs and their manifolds ------------------------------------------------------------------------------ */
#define GROUP_pairs(BUFFER)                                                                                            \
  BUFFER(pair_a, uint, a)                                                                                              \
  BUFFER(pair_b, uint, b)

/* Pairs, with the first pair of each body and the range of bodies of its world. */
#define GROUP_world_pairs(BUFFER)                                                                                      \
  BUFFER(pair_a, uint, a)                                                                                              \
  BUFFER(pair_b, uint, b)                                                                                              \
  BUFFER(pair_start, uint, start)                                                                                      \
  BUFFER(body_world, uint, world)

/* Pairs with the lists that narrowphase kernels run over (narrowphase/pair_lists.h). */
#define GROUP_listed_pairs(BUFFER)                                                                                     \
  BUFFER(pair_a, uint, a)                                                                                              \
  BUFFER(pair_b, uint, b)                                                                                              \
  BUFFER(pair_of_kind, uint, of_kind)

/* Pairs, with the child or triangle of each body that takes part. */
#define GROUP_part_pairs(BUFFER)                                                                                       \
  BUFFER(pair_a, uint, a)                                                                                              \
  BUFFER(pair_b, uint, b)                                                                                              \
  BUFFER(pair_leaf, uint, leaf)

#define GROUP_listed_part_pairs(BUFFER)                                                                                \
  BUFFER(pair_a, uint, a)                                                                                              \
  BUFFER(pair_b, uint, b)                                                                                              \
  BUFFER(pair_of_kind, uint, of_kind)                                                                                  \
  BUFFER(pair_leaf, uint, leaf)

/* The pairs of leaves that the midphase writes; later kernels read them as part_pairs. */
#define GROUP_pairs_of_leaves(BUFFER)                                                                                  \
  BUFFER(leaf_pair_a, uint, a)                                                                                         \
  BUFFER(leaf_pair_b, uint, b)                                                                                         \
  BUFFER(pair_leaf, uint, leaf)

#define GROUP_manifolds(BUFFER)                                                                                        \
  BUFFER(manifold_normal, float4, normal)                                                                              \
  BUFFER(manifold_points, float4, points)                                                                              \
  BUFFER(manifold_count, uint, count)                                                                                  \
  BUFFER(manifold_feature, uint, feature)

typedef struct {
  GROUP_pairs(READ_MEMBER)
} read_pairs;
typedef struct {
  GROUP_world_pairs(READ_MEMBER)
} read_world_pairs;
typedef struct {
  GROUP_pairs(WRITE_MEMBER)
} write_pairs;
typedef struct {
  GROUP_listed_pairs(READ_MEMBER)
} read_listed_pairs;
typedef struct {
  GROUP_part_pairs(READ_MEMBER)
} read_part_pairs;
typedef struct {
  GROUP_listed_part_pairs(READ_MEMBER)
} read_listed_part_pairs;
typedef struct {
  GROUP_pairs_of_leaves(WRITE_MEMBER)
} write_pairs_of_leaves;
typedef struct {
  GROUP_manifolds(READ_MEMBER)
} read_manifolds;
typedef struct {
  GROUP_manifolds(WRITE_MEMBER)
} write_manifolds;

/* Buffers between the kernels of narrowphase/sat_split.h. */
#define GROUP_separating_axes(BUFFER)                                                                                  \
  BUFFER(split_axis, float4, axis)                                                                                     \
  BUFFER(split_state, uint, state)

#define GROUP_clipped_points(BUFFER)                                                                                   \
  BUFFER(split_point, float4, point)                                                                                   \
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

/* --- contacts ----------------------------------------------------------------------------------------------- */
/* The constraint that setup/contact.h makes of a manifold. */
#define GROUP_constraints(BUFFER)                                                                                      \
  BUFFER(constraint_pair, uint, pair)                                                                                  \
  BUFFER(constraint_a, uint, a)                                                                                        \
  BUFFER(constraint_b, uint, b)                                                                                        \
  BUFFER(constraint_normal, float4, normal)                                                                            \
  BUFFER(constraint_points, memory_real, points)                                                                       \
  BUFFER(constraint_center, float4, center)                                                                            \
  BUFFER(constraint_offset, float4, offset)                                                                            \
  BUFFER(constraint_normal_impulse, float4, normal_impulse)                                                            \
  BUFFER(constraint_friction_impulse, float4, friction_impulse)                                                        \
  BUFFER(constraint_restitution, float4, restitution)                                                                  \
  BUFFER(constraint_slop, memory_real, slop)

#define GROUP_contacts(BUFFER)                                                                                         \
  BUFFER(constraint_a, uint, a)                                                                                        \
  BUFFER(constraint_b, uint, b)                                                                                        \
  BUFFER(constraint_normal, float4, normal)

/* Whether a contact was there in the last step, and what it bore. */
#define GROUP_loads_before(BUFFER)                                                                                     \
  BUFFER(pair_cached, uint, cached)                                                                                    \
  BUFFER(constraint_pair, uint, pair)                                                                                  \
  BUFFER(constraint_normal_impulse, float4, normal_impulse)

/* The pair of each constraint, and the constraint of each pair. */
#define GROUP_contact_orders(BUFFER)                                                                                   \
  BUFFER(sort_value, uint, pair)                                                                                       \
  BUFFER(pair_constraint, uint, constraint)

/* The points of a contact, its friction patch, and the penetration that is left in place. */
#define GROUP_patches(BUFFER)                                                                                          \
  BUFFER(constraint_points, memory_real, points)                                                                       \
  BUFFER(constraint_center, float4, center)                                                                            \
  BUFFER(constraint_offset, float4, offset)                                                                            \
  BUFFER(constraint_slop, memory_real, slop)

#define GROUP_contact_impulses(BUFFER)                                                                                 \
  BUFFER(constraint_normal_impulse, float4, normal)                                                                    \
  BUFFER(constraint_friction_impulse, float4, friction)                                                                \
  BUFFER(constraint_restitution, float4, restitution)                                                                  \
  BUFFER(constraint_impulse, float4, carried)

/* The multipliers and penalties of contacts in solve/avbd.h. */
#define GROUP_duals(BUFFER)                                                                                            \
  BUFFER(constraint_normal_impulse, float4, normal)                                                                    \
  BUFFER(constraint_friction_impulse, float4, friction)                                                                \
  BUFFER(constraint_penalty, float4, penalty)

/* The pairs of each body, and which of them touch: in this step, and in the last. */
#define GROUP_touching_pairs(BUFFER)                                                                                   \
  BUFFER(pair_start, uint, start)                                                                                      \
  BUFFER(pair_b, uint, b)                                                                                              \
  BUFFER(pair_touching, uint, touching)

#define GROUP_cached_touching_pairs(BUFFER)                                                                            \
  BUFFER(cached_start, uint, start)                                                                                    \
  BUFFER(cached_b, uint, b)                                                                                            \
  BUFFER(cached_touching, uint, touching)

/* The iterates and the direction of solve/nncg.h. */
#define GROUP_nncg_rows(BUFFER)                                                                                        \
  BUFFER(nncg_impulse, float4, impulse)                                                                                \
  BUFFER(nncg_direction, float4, direction)

/* The iterates of solve/mass_split.h. */
#define GROUP_iterates(BUFFER)                                                                                         \
  BUFFER(split_previous_normal, float4, previous_normal)                                                               \
  BUFFER(split_previous_friction, float4, previous_friction)

/* The impulses on parts of bodies, and the sums of long lists of them: of contacts (solve/mass_split.h) and of joints
 * (joints/mass_split.h). */
#define GROUP_parts(BUFFER)                                                                                            \
  BUFFER(split_impulse, float4, impulse)                                                                               \
  BUFFER(split_partial, float4, partial)                                                                               \
  BUFFER(split_joint_impulse, float4, joint_impulse)                                                                   \
  BUFFER(split_joint_partial, float4, joint_partial)

/* The constraints of each body, and its joints. */
#define GROUP_body_lists(BUFFER)                                                                                       \
  BUFFER(body_constraint_start, uint, start)                                                                           \
  BUFFER(body_constraint, uint, entries)                                                                               \
  BUFFER(body_joint_start, uint, joint_start)                                                                          \
  BUFFER(body_joint, uint, joint_entries)

/* The pairs of the last step, and the contacts of those that touched. */
#define GROUP_cached_pairs(BUFFER)                                                                                     \
  BUFFER(cached_start, uint, start)                                                                                    \
  BUFFER(cached_b, uint, b)                                                                                            \
  BUFFER(cached_normal, float4, normal)                                                                                \
  BUFFER(cached_color, uint, color)

#define GROUP_cached_contacts(BUFFER)                                                                                  \
  BUFFER(pair_cached, uint, of_pair)                                                                                   \
  BUFFER(cached_feature, uint, feature)                                                                                \
  BUFFER(cached_single_impulse, memory_real, single_impulse)                                                           \
  BUFFER(cached_normal_impulse, float4, normal_impulse)                                                                \
  BUFFER(cached_friction_impulse, float4, friction_impulse)

/* The normal impulses of pairs of single points, and of others. */
#define GROUP_cached_normal_impulses(BUFFER)                                                                           \
  BUFFER(cached_single_impulse, memory_real, single)                                                                   \
  BUFFER(cached_normal_impulse, float4, rows)

/* The contacts of the last step, and what stood on each body. */
#define GROUP_cached_loads(BUFFER)                                                                                     \
  BUFFER(pair_cached, uint, of_pair)                                                                                   \
  BUFFER(cached_feature, uint, feature)                                                                                \
  BUFFER(cached_single_impulse, memory_real, single_impulse)                                                           \
  BUFFER(cached_normal_impulse, float4, normal_impulse)                                                                \
  BUFFER(cached_friction_impulse, float4, friction_impulse)                                                            \
  BUFFER(cached_standing, uint, standing)

/* What contacts say of the bodies that they bear: that they do not fall, what stands on them, and whether they wish for
 * many substeps. */
#define GROUP_borne_bodies(BUFFER)                                                                                     \
  BUFFER(body_falls, uint, falls)                                                                                      \
  BUFFER(previous_cached_standing, uint, standing)                                                                     \
  BUFFER(body_wish, uint, wish)

/* The bodies of setup/standing.h, with the number of contacts that each stands on. */
#define GROUP_stacked_bodies(BUFFER)                                                                                   \
  BUFFER(body_shape, float4, shape)                                                                                    \
  BUFFER(body_supports, uint, supports)                                                                                \
  BUFFER(solver_velocity, float4, velocity)

typedef struct {
  GROUP_nncg_rows(WRITE_MEMBER)
} write_nncg_rows;
typedef struct {
  GROUP_constraints(WRITE_MEMBER)
} write_constraints;
typedef struct {
  GROUP_contacts(READ_MEMBER)
} read_contacts;
typedef struct {
  GROUP_patches(READ_MEMBER)
} read_patches;
typedef struct {
  GROUP_contact_impulses(WRITE_MEMBER)
} write_contact_impulses;
typedef struct {
  GROUP_duals(READ_MEMBER)
} read_duals;
typedef struct {
  GROUP_duals(WRITE_MEMBER)
} write_duals;
typedef struct {
  GROUP_touching_pairs(READ_MEMBER)
} read_touching_pairs;
typedef struct {
  GROUP_cached_touching_pairs(READ_MEMBER)
} read_cached_touching_pairs;
typedef struct {
  GROUP_iterates(WRITE_MEMBER)
} write_iterates;
typedef struct {
  GROUP_parts(READ_MEMBER)
} read_parts;
typedef struct {
  GROUP_body_lists(READ_MEMBER)
} read_body_lists;
typedef struct {
  GROUP_cached_pairs(READ_MEMBER)
} read_cached_pairs;
typedef struct {
  GROUP_cached_contacts(READ_MEMBER)
} read_cached_contacts;
typedef struct {
  GROUP_cached_normal_impulses(WRITE_MEMBER)
} write_cached_normal_impulses;
typedef struct {
  GROUP_cached_loads(READ_MEMBER)
} read_cached_loads;
typedef struct {
  GROUP_stacked_bodies(READ_MEMBER)
} read_stacked_bodies;
typedef struct {
  GROUP_borne_bodies(WRITE_MEMBER)
} write_borne_bodies;
typedef struct {
  GROUP_contact_orders(READ_MEMBER)
} read_contact_orders;
typedef struct {
  GROUP_loads_before(READ_MEMBER)
} read_loads_before;

/* --- joints, in the order of their colours ------------------------------------------------------------------ */
#define GROUP_joints(BUFFER)                                                                                           \
  BUFFER(joint_a, uint, a)                                                                                             \
  BUFFER(joint_b, uint, b)                                                                                             \
  BUFFER(joint_modes, uint, modes)                                                                                     \
  BUFFER(joint_arm_a, float4, arm_a)                                                                                   \
  BUFFER(joint_arm_b, float4, arm_b)                                                                                   \
  BUFFER(joint_frame_a, float4, frame_a)                                                                               \
  BUFFER(joint_frame_b, float4, frame_b)                                                                               \
  BUFFER(joint_offset, float4, offset)

/* What joints limit, drive and brake. */
#define GROUP_joint_axes(BUFFER)                                                                                       \
  BUFFER(joint_axis_kind, uint, kind)                                                                                  \
  BUFFER(joint_axis_row, float4, row)

/* Which worlds of a batch joints belong to, and which of them take further passes. */
#define GROUP_joint_worlds(BUFFER)                                                                                     \
  BUFFER(body_world, uint, of_body)                                                                                    \
  BUFFER(world_overflows, uint, overflows)

#define GROUP_joint_places(BUFFER)                                                                                     \
  BUFFER(body_position, float4, position)                                                                              \
  BUFFER(joint_world_frame, float4, world_frame)

#define GROUP_joint_impulses(BUFFER)                                                                                   \
  BUFFER(joint_linear_impulse, float4, linear)                                                                         \
  BUFFER(joint_angular_impulse, float4, angular)                                                                       \
  BUFFER(joint_axis_impulse, float4, axis)

#define GROUP_cached_joint_impulses(BUFFER)                                                                            \
  BUFFER(cached_joint_linear_impulse, float4, linear)                                                                  \
  BUFFER(cached_joint_angular_impulse, float4, angular)                                                                \
  BUFFER(cached_joint_axis_impulse, float4, axis)

/* The iterates of joints/mass_split.h. */
#define GROUP_joint_iterates(BUFFER)                                                                                   \
  BUFFER(split_previous_linear, float4, linear)                                                                        \
  BUFFER(split_previous_angular, float4, angular)                                                                      \
  BUFFER(split_previous_axis, float4, axis)

/* The multipliers and penalties of joints in joints/avbd.h, and what a substep leaves open. */
#define GROUP_joint_duals(BUFFER)                                                                                      \
  BUFFER(joint_linear_impulse, float4, linear)                                                                         \
  BUFFER(joint_angular_impulse, float4, angular)                                                                       \
  BUFFER(joint_axis_impulse, float4, axis)                                                                             \
  BUFFER(joint_linear_penalty, float4, linear_penalty)                                                                 \
  BUFFER(joint_angular_penalty, float4, angular_penalty)                                                               \
  BUFFER(joint_axis_penalty, float4, axis_penalty)                                                                     \
  BUFFER(joint_linear_left, float4, linear_left)                                                                       \
  BUFFER(joint_angular_left, float4, angular_left)                                                                     \
  BUFFER(joint_axis_left, memory_real, axis_left)

/* The same with what joints limit, drive and brake, for a body that is moved against its joints. */
#define GROUP_joint_blocks(BUFFER)                                                                                     \
  BUFFER(joint_axis_kind, uint, kind)                                                                                  \
  BUFFER(joint_axis_row, float4, row)                                                                                  \
  BUFFER(joint_linear_impulse, float4, linear)                                                                         \
  BUFFER(joint_angular_impulse, float4, angular)                                                                       \
  BUFFER(joint_axis_impulse, float4, axis)                                                                             \
  BUFFER(joint_linear_penalty, float4, linear_penalty)                                                                 \
  BUFFER(joint_angular_penalty, float4, angular_penalty)                                                               \
  BUFFER(joint_axis_penalty, float4, axis_penalty)                                                                     \
  BUFFER(joint_linear_left, float4, linear_left)                                                                       \
  BUFFER(joint_angular_left, float4, angular_left)                                                                     \
  BUFFER(joint_axis_left, memory_real, axis_left)

#define GROUP_joint_penalties(BUFFER)                                                                                  \
  BUFFER(joint_linear_penalty, float4, linear)                                                                         \
  BUFFER(joint_angular_penalty, float4, angular)                                                                       \
  BUFFER(joint_axis_penalty, float4, axis)

#define GROUP_cached_joint_penalties(BUFFER)                                                                           \
  BUFFER(cached_joint_linear_penalty, float4, linear)                                                                  \
  BUFFER(cached_joint_angular_penalty, float4, angular)                                                                \
  BUFFER(cached_joint_axis_penalty, float4, axis)

/* Joints that are coupled, and how; the joints of a coupling are numbered by their places. */
#define GROUP_couplings(BUFFER)                                                                                        \
  BUFFER(coupling_a, uint, a)                                                                                          \
  BUFFER(coupling_b, uint, b)                                                                                          \
  BUFFER(coupling_kind, uint, kind)                                                                                    \
  BUFFER(coupling_row, float4, row)

typedef struct {
  GROUP_joints(READ_MEMBER)
} read_joints;
typedef struct {
  GROUP_couplings(READ_MEMBER)
} read_couplings;
typedef struct {
  GROUP_joint_axes(READ_MEMBER)
} read_joint_axes;
typedef struct {
  GROUP_joint_duals(WRITE_MEMBER)
} write_joint_duals;
typedef struct {
  GROUP_joint_blocks(READ_MEMBER)
} read_joint_blocks;
typedef struct {
  GROUP_joint_penalties(READ_MEMBER)
} read_joint_penalties;
typedef struct {
  GROUP_joint_penalties(WRITE_MEMBER)
} write_joint_penalties;
typedef struct {
  GROUP_joint_iterates(WRITE_MEMBER)
} write_joint_iterates;
typedef struct {
  GROUP_cached_joint_penalties(READ_MEMBER)
} read_cached_joint_penalties;
typedef struct {
  GROUP_cached_joint_penalties(WRITE_MEMBER)
} write_cached_joint_penalties;
typedef struct {
  GROUP_joint_worlds(READ_MEMBER)
} read_joint_worlds;
typedef struct {
  GROUP_joint_places(READ_MEMBER)
} read_joint_places;
typedef struct {
  GROUP_joint_impulses(READ_MEMBER)
} read_joint_impulses;
typedef struct {
  GROUP_joint_impulses(WRITE_MEMBER)
} write_joint_impulses;
typedef struct {
  GROUP_cached_joint_impulses(READ_MEMBER)
} read_cached_joint_impulses;
typedef struct {
  GROUP_cached_joint_impulses(WRITE_MEMBER)
} write_cached_joint_impulses;

/* --- queries ---------------------------------------------------------------------------------------------- */
/* The structures of the broadphase that queries search for bodies along a path: the hierarchy, and the boxes and cells
 * of the grid. */
#define GROUP_search_structures(BUFFER)                                                                                \
  BUFFER(hierarchy, float4, node)                                                                                      \
  BUFFER(hierarchy_link, uint, link)                                                                                   \
  BUFFER(leaf_body, uint, leaf_body)                                                                                   \
  BUFFER(bounds, float4, bounds)                                                                                       \
  BUFFER(grid, float4, grid)                                                                                           \
  BUFFER(sort_value, uint, sorted_body)                                                                                \
  BUFFER(cell_start, uint, cell_start)                                                                                 \
  BUFFER(counts, uint, counts)

/* The index and the filter of each body, then the queries themselves. */
#define GROUP_queries(BUFFER)                                                                                          \
  BUFFER(query_body, uint, body)                                                                                       \
  BUFFER(query_filter, uint, filter)                                                                                   \
  BUFFER(query_start, float4, start)                                                                                   \
  BUFFER(query_displacement, float4, displacement)

/* The queries of one shape that is cast along many paths. */
#define GROUP_shape_queries(BUFFER)                                                                                    \
  BUFFER(query_body, uint, body)                                                                                       \
  BUFFER(query_filter, uint, filter)                                                                                   \
  BUFFER(query_start, float4, start)                                                                                   \
  BUFFER(query_turn, float4, turn)                                                                                     \
  BUFFER(query_displacement, float4, displacement)                                                                     \
  BUFFER(query_shape, float4, shape)                                                                                   \
  BUFFER(query_vertex, float4, vertex)                                                                                 \
  BUFFER(query_chunk, float4, chunk)

#define GROUP_hits(BUFFER)                                                                                             \
  BUFFER(query_hit, float4, hit)                                                                                       \
  BUFFER(query_point, float4, point)                                                                                   \
  BUFFER(query_hit_body, uint, body)

typedef struct {
  GROUP_search_structures(READ_MEMBER)
} read_search_structures;
typedef struct {
  GROUP_queries(READ_MEMBER)
} read_queries;
typedef struct {
  GROUP_shape_queries(READ_MEMBER)
} read_shape_queries;
typedef struct {
  GROUP_hits(WRITE_MEMBER)
} write_hits;

/* --- articulations ------------------------------------------------------------------------------------------- */
/* Their tables: articulations/tree.h, articulations/bodies.h. */
#define GROUP_links(BUFFER)                                                                                            \
  BUFFER(link_code, uint, code)                                                                                        \
  BUFFER(link_row, float4, row)                                                                                        \
  BUFFER(link_range, float4, range)                                                                                    \
  BUFFER(link_body, uint, body)                                                                                        \
  BUFFER(link_freedom, uint, freedom)                                                                                  \
  BUFFER(articulation_place, uint, place)                                                                              \
  BUFFER(articulation_ground, float4, ground)                                                                          \
  BUFFER(body_link, uint, of_body)

/* Couplings of two joints of one tree. */
#define GROUP_tree_couplings(BUFFER)                                                                                   \
  BUFFER(tree_coupling, uint, of_tree)                                                                                 \
  BUFFER(coupling_link, uint, link)                                                                                    \
  BUFFER(coupling_kind, uint, kind)                                                                                    \
  BUFFER(coupling_row, float4, row)

/* What a step knows of them. */
#define GROUP_link_states(BUFFER)                                                                                      \
  BUFFER(link_state, float4, state)                                                                                    \
  BUFFER(link_root, float4, root)                                                                                      \
  BUFFER(link_work, float4, work)                                                                                      \
  BUFFER(link_next, uint, next)                                                                                        \
  BUFFER(link_path, float4, path)                                                                                      \
  BUFFER(tree_change, memory_real, change)                                                                             \
  BUFFER(tree_contact, uint, contact)                                                                                  \
  BUFFER(tree_colors, uint, colors)

/* The rows of their contacts, in the freedoms of their trees: articulations/contact_rows.h. */
#define GROUP_contact_freedoms(BUFFER)                                                                                 \
  BUFFER(contact_row, float4, row)                                                                                     \
  BUFFER(contact_term, float4, term)                                                                                   \
  BUFFER(contact_freedom, uint, freedom)

/* Bodies where and as fast as a substep has taken them. */
#define GROUP_moved_bodies(BUFFER)                                                                                     \
  BUFFER(solver_velocity, float4, velocity)                                                                            \
  BUFFER(solver_delta_pose, float4, delta)                                                                             \
  BUFFER(solver_orientation, float4, orientation)

typedef struct {
  GROUP_links(READ_MEMBER)
} read_links;
typedef struct {
  GROUP_tree_couplings(READ_MEMBER)
} read_tree_couplings;
typedef struct {
  GROUP_link_states(WRITE_MEMBER)
} write_link_states;
typedef struct {
  GROUP_contact_freedoms(READ_MEMBER)
} read_contact_freedoms;
typedef struct {
  GROUP_contact_freedoms(WRITE_MEMBER)
} write_contact_freedoms;
typedef struct {
  GROUP_moved_bodies(WRITE_MEMBER)
} write_moved_bodies;

#endif
