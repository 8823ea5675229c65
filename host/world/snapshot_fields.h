/* snapshot_fields.h - the fields of the records that snapshots and recordings hold, in the order of the files.
 *
 * Each function takes its record apart into as many names as it has fields, so that a field that is added to a record
 * and not named here does not compile. A change of these lists changes the format: snapshot_format of snapshot.h.
 */
#pragma once

#include <concepts>
#include <tuple>
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

template <Is<Material> T> auto fields_of(T &record)
{
  auto &[name, static_friction, dynamic_friction, restitution, friction_combine, restitution_combine, rolling_friction,
         spinning_friction] = record;
  return std::tie(name, static_friction, dynamic_friction, restitution, friction_combine, restitution_combine,
                  rolling_friction, spinning_friction);
}

template <Is<Axes> T> auto fields_of(T &record)
{
  auto &[x, y, z] = record;
  return std::tie(x, y, z);
}

template <Is<Body> T> auto fields_of(T &record)
{
  auto &[name, type, trigger, shape, material, position, orientation, shape_position, shape_orientation,
         linear_velocity, angular_velocity, mass, inertia, infinite_inertia, gravity_factor, linear_damping,
         angular_damping, filter_group, filter_mask, continuous, linear_locks, angular_locks, max_linear_speed,
         max_angular_speed, user_data] = record;
  return std::tie(name, type, trigger, shape, material, position, orientation, shape_position, shape_orientation,
                  linear_velocity, angular_velocity, mass, inertia, infinite_inertia, gravity_factor, linear_damping,
                  angular_damping, filter_group, filter_mask, continuous, linear_locks, angular_locks, max_linear_speed,
                  max_angular_speed, user_data);
}

/* Extensions are functions of the program; snapshots name their modules. */
template <Is<Settings> T> auto fields_of(T &record)
{
  auto &[step, substeps, iterations, solver, broadphase, bounds, midphase, narrowphase, support, support_cells,
         batching, check, events, pair_events, sleeping, sleep_speed, sleep_time, moved_bodies, max_pairs, specialise,
         extensions, contact_hertz, contact_damping_ratio, push_speed, slop, slop_share, restitution_speed, hit_speed] =
      record;
  return std::tie(step, substeps, iterations, solver, broadphase, bounds, midphase, narrowphase, support, support_cells,
                  batching, check, events, pair_events, sleeping, sleep_speed, sleep_time, moved_bodies, max_pairs,
                  specialise, contact_hertz, contact_damping_ratio, push_speed, slop, slop_share, restitution_speed,
                  hit_speed);
}

template <Is<HullPlane> T> auto fields_of(T &record)
{
  auto &[normal, distance] = record;
  return std::tie(normal, distance);
}

template <Is<HullEdge> T> auto fields_of(T &record)
{
  auto &[v0, v1, face_left, face_right] = record;
  return std::tie(v0, v1, face_left, face_right);
}

template <Is<ConvexHull> T> auto fields_of(T &record)
{
  auto &[vertices, faces, planes, edges, centroid, tolerance] = record;
  return std::tie(vertices, faces, planes, edges, centroid, tolerance);
}

template <Is<MeshEdge> T> auto fields_of(T &record)
{
  auto &[v0, v1, left, right, kind, cosine] = record;
  return std::tie(v0, v1, left, right, kind, cosine);
}

template <Is<MeshFindings> T> auto fields_of(T &record)
{
  auto &[welded_vertices, unused_vertices, degenerate_triangles, duplicate_triangles, boundary_edges,
         non_manifold_edges, misoriented_edges] = record;
  return std::tie(welded_vertices, unused_vertices, degenerate_triangles, duplicate_triangles, boundary_edges,
                  non_manifold_edges, misoriented_edges);
}

template <Is<TriangleMesh> T> auto fields_of(T &record)
{
  auto &[vertices, triangles, neighbours, triangle_edges, edges, findings, flat] = record;
  return std::tie(vertices, triangles, neighbours, triangle_edges, edges, findings, flat);
}

template <Is<Quarantine> T> auto fields_of(T &record)
{
  auto &[body, name, stage, step] = record;
  return std::tie(body, name, stage, step);
}

template <Is<BatchFault> T> auto fields_of(T &record)
{
  auto &[step, conflict, color, body, pair, other, constraints] = record;
  return std::tie(step, conflict, color, body, pair, other, constraints);
}

/* Of calls: */
template <Is<BodyId> T> auto fields_of(T &record)
{
  auto &[index, generation] = record;
  return std::tie(index, generation);
}

template <Is<ShapeId> T> auto fields_of(T &record)
{
  auto &[index, generation] = record;
  return std::tie(index, generation);
}

template <Is<BodyProperties> T> auto fields_of(T &record)
{
  auto &[type, trigger, continuous, material, mass, inertia, infinite_inertia, gravity_factor, linear_damping,
         angular_damping, filter_group, filter_mask, linear_locks, angular_locks, max_linear_speed, max_angular_speed,
         user_data] = record;
  return std::tie(type, trigger, continuous, material, mass, inertia, infinite_inertia, gravity_factor, linear_damping,
                  angular_damping, filter_group, filter_mask, linear_locks, angular_locks, max_linear_speed,
                  max_angular_speed, user_data);
}

template <Is<BodyState> T> auto fields_of(T &record)
{
  auto &[position, orientation, linear_velocity, angular_velocity] = record;
  return std::tie(position, orientation, linear_velocity, angular_velocity);
}

template <Is<Pose> T> auto fields_of(T &record)
{
  auto &[position, orientation] = record;
  return std::tie(position, orientation);
}

template <Is<Velocity> T> auto fields_of(T &record)
{
  auto &[linear, angular] = record;
  return std::tie(linear, angular);
}

template <Is<Force> T> auto fields_of(T &record)
{
  auto &[force, torque, point] = record;
  return std::tie(force, torque, point);
}

template <Is<Impulse> T> auto fields_of(T &record)
{
  auto &[impulse, angular_impulse, point] = record;
  return std::tie(impulse, angular_impulse, point);
}

} // namespace tandem
