/* narrowphase.cl - entries of the pair types in shared/narrowphase. */
#include "cl/entry.h"
#include "shared/narrowphase/sphere_sphere.h"
#include "shared/narrowphase/sphere_box.h"
#include "shared/narrowphase/box_box.h"
#include "shared/narrowphase/sphere_half_space.h"
#include "shared/narrowphase/box_half_space.h"
#include "shared/narrowphase/collide_convex.h"
#include "shared/narrowphase/follow_boxes.h"
#include "shared/narrowphase/follow_convexes.h"
#include "shared/narrowphase/limit_motion.h"
#include "shared/narrowphase/sat_split.h"

__kernel void collide_sphere_sphere(__global const uint *pair_a, __global const uint *pair_b,
                                    __global const uint *body_traits, __global const row *body_shape,
                                    __global const row *body_position, __global const row *body_velocity,
                                    __global const Parameters *parameters, __global const uint *counts,
                                    __global row *manifold_normal, __global row *manifold_points,
                                    __global uint *manifold_count, __global uint *manifold_feature, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  collide_sphere_sphere_item(pair_a, pair_b, body_traits, body_shape, body_position, body_velocity, parameters, counts,
                             manifold_normal, manifold_points, manifold_count, manifold_feature, i);
}

__kernel void collide_sphere_box(__global const uint *pair_a, __global const uint *pair_b,
                                 __global const uint *body_traits, __global const row *body_shape,
                                 __global const row *body_position, __global const row *body_orientation,
                                 __global const row *body_velocity, __global const Parameters *parameters,
                                 __global const uint *counts, __global row *manifold_normal,
                                 __global row *manifold_points, __global uint *manifold_count,
                                 __global uint *manifold_feature, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  collide_sphere_box_item(pair_a, pair_b, body_traits, body_shape, body_position, body_orientation, body_velocity,
                          parameters, counts, manifold_normal, manifold_points, manifold_count, manifold_feature, i);
}

__kernel void collide_box_box(__global const uint *pair_a, __global const uint *pair_b,
                              __global const uint *body_traits, __global const row *body_shape,
                              __global const row *body_position, __global const row *body_orientation,
                              __global const row *body_velocity, __global const Parameters *parameters,
                              __global const uint *counts, __global row *manifold_normal, __global row *manifold_points,
                              __global uint *manifold_count, __global uint *manifold_feature, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  collide_box_box_item(pair_a, pair_b, body_traits, body_shape, body_position, body_orientation, body_velocity,
                       parameters, counts, manifold_normal, manifold_points, manifold_count, manifold_feature, i);
}

__kernel void follow_boxes(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                           __global const row *body_shape, __global const row *body_position,
                           __global const row *body_orientation, __global const row *body_velocity,
                           __global const Parameters *parameters, __global const uint *counts,
                           __global row *manifold_normal, __global row *manifold_points, __global uint *manifold_count,
                           __global uint *manifold_feature, RANGE)
{
  __local uint local_memory[FOLLOW_PAIRS + 1u];
  follow_boxes_group(pair_a, pair_b, body_traits, body_shape, body_position, body_orientation, body_velocity,
                     parameters, counts, manifold_normal, manifold_points, manifold_count, manifold_feature,
                     local_memory, GROUP_NUMBER);
  END_GROUP;
}

__kernel void collide_sphere_half_space(__global const uint *pair_a, __global const uint *pair_b,
                                        __global const uint *body_traits, __global const row *body_shape,
                                        __global const row *body_position, __global const row *body_orientation,
                                        __global const row *body_velocity, __global const Parameters *parameters,
                                        __global const uint *counts, __global row *manifold_normal,
                                        __global row *manifold_points, __global uint *manifold_count,
                                        __global uint *manifold_feature, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  collide_sphere_half_space_item(pair_a, pair_b, body_traits, body_shape, body_position, body_orientation,
                                 body_velocity, parameters, counts, manifold_normal, manifold_points, manifold_count,
                                 manifold_feature, i);
}

__kernel void collide_box_half_space(__global const uint *pair_a, __global const uint *pair_b,
                                     __global const uint *body_traits, __global const row *body_shape,
                                     __global const row *body_position, __global const row *body_orientation,
                                     __global const row *body_velocity, __global const Parameters *parameters,
                                     __global const uint *counts, __global row *manifold_normal,
                                     __global row *manifold_points, __global uint *manifold_count,
                                     __global uint *manifold_feature, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  collide_box_half_space_item(pair_a, pair_b, body_traits, body_shape, body_position, body_orientation, body_velocity,
                              parameters, counts, manifold_normal, manifold_points, manifold_count, manifold_feature,
                              i);
}

__kernel void collide_convex(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                             __global const row *body_shape, __global const uint *body_convex,
                             __global const row *body_shape_pose, __global const uint *hull_header,
                             __global const row *hull_vertex, __global const row *hull_plane,
                             __global const uint *hull_face_start, __global const uint *hull_corner,
                             __global const uint *hull_edge, __global const row *hull_strip,
                             __global const uint *hull_link, __global const uint *pair_leaf,
                             __global const row *mesh_vertex, __global const uint *mesh_triangle,
                             __global const row *body_position, __global const row *body_orientation,
                             __global const row *body_velocity, __global const Parameters *parameters,
                             __global const uint *counts, __global row *manifold_normal, __global row *manifold_points,
                             __global uint *manifold_count, __global uint *manifold_feature, uint method, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  collide_convex_item(pair_a, pair_b, body_traits, body_shape, body_convex, body_shape_pose, hull_header, hull_vertex,
                      hull_plane, hull_face_start, hull_corner, hull_edge, hull_strip, hull_link, pair_leaf,
                      mesh_vertex, mesh_triangle, body_position, body_orientation, body_velocity, parameters, counts,
                      manifold_normal, manifold_points, manifold_count, manifold_feature, method, i);
}

__kernel void
follow_convexes(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
                __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
                __global const uint *hull_face_start, __global const uint *hull_corner, __global const uint *hull_edge,
                __global const row *hull_strip, __global const uint *hull_link, __global const uint *pair_leaf,
                __global const row *mesh_vertex, __global const uint *mesh_triangle, __global const row *body_position,
                __global const row *body_orientation, __global const row *body_velocity,
                __global const Parameters *parameters, __global const uint *counts, __global row *manifold_normal,
                __global row *manifold_points, __global uint *manifold_count, __global uint *manifold_feature,
                uint method, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  follow_convexes_item(pair_a, pair_b, body_traits, body_shape, body_convex, body_shape_pose, hull_header, hull_vertex,
                       hull_plane, hull_face_start, hull_corner, hull_edge, hull_strip, hull_link, pair_leaf,
                       mesh_vertex, mesh_triangle, body_position, body_orientation, body_velocity, parameters, counts,
                       manifold_normal, manifold_points, manifold_count, manifold_feature, method, i);
}

__kernel void find_separating_axis(
    __global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
    __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
    __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
    __global const uint *hull_face_start, __global const uint *hull_corner, __global const uint *hull_edge,
    __global const row *hull_strip, __global const uint *hull_link, __global const uint *pair_leaf,
    __global const row *mesh_vertex, __global const uint *mesh_triangle, __global const row *body_position,
    __global const row *body_orientation, __global const row *body_velocity, __global const Parameters *parameters,
    __global row *split_axis, __global uint *split_state, uint method, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  find_separating_axis_item(pair_a, pair_b, body_traits, body_shape, body_convex, body_shape_pose, hull_header,
                            hull_vertex, hull_plane, hull_face_start, hull_corner, hull_edge, hull_strip, hull_link,
                            pair_leaf, mesh_vertex, mesh_triangle, body_position, body_orientation, body_velocity,
                            parameters, split_axis, split_state, method, i);
}

__kernel void find_clipping_faces(
    __global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
    __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
    __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
    __global const uint *hull_face_start, __global const uint *hull_corner, __global const uint *hull_edge,
    __global const row *hull_strip, __global const uint *hull_link, __global const uint *pair_leaf,
    __global const row *mesh_vertex, __global const uint *mesh_triangle, __global const row *body_position,
    __global const row *body_orientation, __global const row *body_velocity, __global const Parameters *parameters,
    __global const row *split_axis, __global const uint *split_state, __global uint *split_faces, uint method, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  find_clipping_faces_item(pair_a, pair_b, body_traits, body_shape, body_convex, body_shape_pose, hull_header,
                           hull_vertex, hull_plane, hull_face_start, hull_corner, hull_edge, hull_strip, hull_link,
                           pair_leaf, mesh_vertex, mesh_triangle, body_position, body_orientation, body_velocity,
                           parameters, split_axis, split_state, split_faces, method, i);
}

__kernel void
clip_faces(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
           __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
           __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
           __global const uint *hull_face_start, __global const uint *hull_corner, __global const uint *hull_edge,
           __global const row *hull_strip, __global const uint *hull_link, __global const uint *pair_leaf,
           __global const row *mesh_vertex, __global const uint *mesh_triangle, __global const row *body_position,
           __global const row *body_orientation, __global const row *body_velocity,
           __global const Parameters *parameters, __global const uint *counts, __global const row *split_axis,
           __global const uint *split_state, __global const uint *split_faces, __global row *split_point,
           __global uint *split_count, uint method, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  clip_faces_item(pair_a, pair_b, body_traits, body_shape, body_convex, body_shape_pose, hull_header, hull_vertex,
                  hull_plane, hull_face_start, hull_corner, hull_edge, hull_strip, hull_link, pair_leaf, mesh_vertex,
                  mesh_triangle, body_position, body_orientation, body_velocity, parameters, counts, split_axis,
                  split_state, split_faces, split_point, split_count, method, i);
}

__kernel void
reduce_contacts(__global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
                __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
                __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
                __global const uint *hull_face_start, __global const uint *hull_corner, __global const uint *hull_edge,
                __global const row *hull_strip, __global const uint *hull_link, __global const uint *pair_leaf,
                __global const row *mesh_vertex, __global const uint *mesh_triangle, __global const row *body_position,
                __global const row *body_orientation, __global const row *body_velocity,
                __global const Parameters *parameters, __global const uint *counts, __global const row *split_axis,
                __global const uint *split_state, __global const uint *split_faces, __global const row *split_point,
                __global const uint *split_count, __global row *manifold_normal, __global row *manifold_points,
                __global uint *manifold_count, __global uint *manifold_feature, uint method, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  reduce_contacts_item(pair_a, pair_b, body_traits, body_shape, body_convex, body_shape_pose, hull_header, hull_vertex,
                       hull_plane, hull_face_start, hull_corner, hull_edge, hull_strip, hull_link, pair_leaf,
                       mesh_vertex, mesh_triangle, body_position, body_orientation, body_velocity, parameters, counts,
                       split_axis, split_state, split_faces, split_point, split_count, manifold_normal, manifold_points,
                       manifold_count, manifold_feature, method, i);
}

__kernel void collide_convex_half_space(
    __global const uint *pair_a, __global const uint *pair_b, __global const uint *body_traits,
    __global const row *body_shape, __global const uint *body_convex, __global const row *body_shape_pose,
    __global const uint *hull_header, __global const row *hull_vertex, __global const row *hull_plane,
    __global const uint *hull_face_start, __global const uint *hull_corner, __global const uint *hull_edge,
    __global const row *hull_strip, __global const uint *hull_link, __global const uint *pair_leaf,
    __global const row *mesh_vertex, __global const uint *mesh_triangle, __global const row *body_position,
    __global const row *body_orientation, __global const row *body_velocity, __global const Parameters *parameters,
    __global const uint *counts, __global row *manifold_normal, __global row *manifold_points,
    __global uint *manifold_count, __global uint *manifold_feature, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  collide_convex_half_space_item(pair_a, pair_b, body_traits, body_shape, body_convex, body_shape_pose, hull_header,
                                 hull_vertex, hull_plane, hull_face_start, hull_corner, hull_edge, hull_strip,
                                 hull_link, pair_leaf, mesh_vertex, mesh_triangle, body_position, body_orientation,
                                 body_velocity, parameters, counts, manifold_normal, manifold_points, manifold_count,
                                 manifold_feature, i);
}

__kernel void
limit_motion(__global const Parameters *parameters, __global const uint *pair_a, __global const uint *pair_b,
             __global const uint *body_traits, __global const row *body_shape, __global const uint *body_convex,
             __global const row *body_shape_pose, __global const uint *hull_header, __global const row *hull_vertex,
             __global const row *hull_plane, __global const uint *hull_face_start, __global const uint *hull_corner,
             __global const uint *hull_edge, __global const row *hull_strip, __global const uint *hull_link,
             __global const uint *pair_leaf, __global const row *mesh_vertex, __global const uint *mesh_triangle,
             __global const row *body_position, __global const row *body_orientation, __global const row *solver_delta,
             __global uint *body_share, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  limit_motion_item(parameters, pair_a, pair_b, body_traits, body_shape, body_convex, body_shape_pose, hull_header,
                    hull_vertex, hull_plane, hull_face_start, hull_corner, hull_edge, hull_strip, hull_link, pair_leaf,
                    mesh_vertex, mesh_triangle, body_position, body_orientation, solver_delta, body_share, i);
}
