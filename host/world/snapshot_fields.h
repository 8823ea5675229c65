/* snapshot_fields.h - the fields of the records that snapshots and recordings hold, in the order of the files: each
 * function calls `visit` with all of them (host/base/byte_stream.h).
 *
 * Each function takes its record apart into as many names as it has fields, so that a field that is added to a record
 * and not named here does not compile. A change of these lists changes the format: the format of snapshot_kind.
 */
#pragma once

#include <concepts>
#include <type_traits>

#include <tandem/bodies.h>
#include <tandem/events.h>
#include <tandem/scene.h>
#include <tandem/settings.h>
#include <tandem/world.h>

#include "host/geometry/convex_hull.h"
#include "host/geometry/triangle_mesh.h"

namespace tandem {

/* The record itself or a constant one, so that one list serves readers and writers. */
template <class T, class Record>
concept Is = std::same_as<std::remove_const_t<T>, Record>;

template <Is<Material> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[name, static_friction, dynamic_friction, restitution, friction_combine, restitution_combine, rolling_friction,
         spinning_friction] = record;
  return visit(name, static_friction, dynamic_friction, restitution, friction_combine, restitution_combine,
               rolling_friction, spinning_friction);
}

template <Is<Axes> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[x, y, z] = record;
  return visit(x, y, z);
}

template <Is<Body> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[name, type, trigger, shape, material, position, orientation, shape_position, shape_orientation,
         linear_velocity, angular_velocity, mass, inertia, infinite_inertia, gravity_factor, linear_damping,
         angular_damping, filter_group, filter_mask, continuous, linear_locks, angular_locks, max_linear_speed,
         max_angular_speed, user_data] = record;
  return visit(name, type, trigger, shape, material, position, orientation, shape_position, shape_orientation,
               linear_velocity, angular_velocity, mass, inertia, infinite_inertia, gravity_factor, linear_damping,
               angular_damping, filter_group, filter_mask, continuous, linear_locks, angular_locks, max_linear_speed,
               max_angular_speed, user_data);
}

template <Is<JointAxis> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[lower, upper, limit_stiffness, limit_damping, restitution, target_position, target_velocity, stiffness,
         damping, motor, force, max_force, friction, max_speed] = record;
  return visit(lower, upper, limit_stiffness, limit_damping, restitution, target_position, target_velocity, stiffness,
               damping, motor, force, max_force, friction, max_speed);
}

template <Is<Joint> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[name, type, enabled, body_a, body_b, position_a, position_b, orientation_a, orientation_b, collide,
         break_force, break_torque, held_directions, held_rotations, directions, rotations] = record;
  return visit(name, type, enabled, body_a, body_b, position_a, position_b, orientation_a, orientation_b, collide,
               break_force, break_torque, held_directions, held_rotations, directions, rotations);
}

template <Is<JointId> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[index, generation] = record;
  return visit(index, generation);
}

template <Is<JointAxisChange> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[axis, to] = record;
  return visit(axis, to);
}

template <Is<Coupling> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[name, type, joint_a, joint_b, coordinate_a, coordinate_b, teeth_a, teeth_b, travel, ratio, offset,
         only_pulls] = record;
  return visit(name, type, joint_a, joint_b, coordinate_a, coordinate_b, teeth_a, teeth_b, travel, ratio, offset,
               only_pulls);
}

template <Is<Articulation> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[name, joints, root, armatures] = record;
  return visit(name, joints, root, armatures);
}

template <Is<Actuator> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[name, joint, axis, sets, offset, factor, lower, upper] = record;
  return visit(name, joint, axis, sets, offset, factor, lower, upper);
}

/* Extensions are functions of the program; snapshots name their modules. */
template <Is<Settings> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[step, substeps, iterations, solver, broadphase, bounds, midphase, narrowphase, support, support_cells,
         batching, check, events, pair_events, sleeping, sleep_speed, sleep_time, moved_bodies, tree_joint_forces,
         max_pairs, specialise, extensions, contact_hertz, contact_damping_ratio, joint_hertz, joint_damping_ratio,
         push_speed, slop, slop_share, restitution_speed, hit_speed] = record;
  return visit(step, substeps, iterations, solver, broadphase, bounds, midphase, narrowphase, support, support_cells,
               batching, check, events, pair_events, sleeping, sleep_speed, sleep_time, moved_bodies, tree_joint_forces,
               max_pairs, specialise, contact_hertz, contact_damping_ratio, joint_hertz, joint_damping_ratio,
               push_speed, slop, slop_share, restitution_speed, hit_speed);
}

template <Is<HullPlane> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[normal, distance] = record;
  return visit(normal, distance);
}

template <Is<HullEdge> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[v0, v1, face_left, face_right] = record;
  return visit(v0, v1, face_left, face_right);
}

template <Is<ConvexHull> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[vertices, faces, planes, edges, centroid, tolerance] = record;
  return visit(vertices, faces, planes, edges, centroid, tolerance);
}

template <Is<MeshEdge> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[v0, v1, left, right, kind, cosine] = record;
  return visit(v0, v1, left, right, kind, cosine);
}

template <Is<MeshFindings> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[welded_vertices, unused_vertices, degenerate_triangles, duplicate_triangles, boundary_edges,
         non_manifold_edges, misoriented_edges] = record;
  return visit(welded_vertices, unused_vertices, degenerate_triangles, duplicate_triangles, boundary_edges,
               non_manifold_edges, misoriented_edges);
}

template <Is<TriangleMesh> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[vertices, triangles, neighbours, triangle_edges, edges, findings, flat] = record;
  return visit(vertices, triangles, neighbours, triangle_edges, edges, findings, flat);
}

template <Is<Quarantine> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[body, name, stage, step] = record;
  return visit(body, name, stage, step);
}

template <Is<BatchFault> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[step, conflict, color, body, pair, other, constraints] = record;
  return visit(step, conflict, color, body, pair, other, constraints);
}

/* Of calls: */
template <Is<BodyId> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[index, generation] = record;
  return visit(index, generation);
}

template <Is<ShapeId> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[index, generation] = record;
  return visit(index, generation);
}

template <Is<BodyProperties> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[type, trigger, continuous, material, mass, inertia, infinite_inertia, gravity_factor, linear_damping,
         angular_damping, filter_group, filter_mask, linear_locks, angular_locks, max_linear_speed, max_angular_speed,
         user_data] = record;
  return visit(type, trigger, continuous, material, mass, inertia, infinite_inertia, gravity_factor, linear_damping,
               angular_damping, filter_group, filter_mask, linear_locks, angular_locks, max_linear_speed,
               max_angular_speed, user_data);
}

template <Is<BodyState> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[position, orientation, linear_velocity, angular_velocity] = record;
  return visit(position, orientation, linear_velocity, angular_velocity);
}

template <Is<Pose> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[position, orientation] = record;
  return visit(position, orientation);
}

template <Is<QueryFilter> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[group, mask] = record;
  return visit(group, mask);
}

template <Is<Ray> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[origin, direction, reach, filter] = record;
  return visit(origin, direction, reach, filter);
}

template <Is<Velocity> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[linear, angular] = record;
  return visit(linear, angular);
}

template <Is<Force> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[force, torque, point] = record;
  return visit(force, torque, point);
}

template <Is<Impulse> T, class Visit> auto visit_fields(T &record, const Visit &visit)
{
  auto &[impulse, angular_impulse, point] = record;
  return visit(impulse, angular_impulse, point);
}

} // namespace tandem
