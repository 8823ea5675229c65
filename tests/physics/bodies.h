/* bodies.h - bodies of any convex shape for the tests of physics: placed by the pose of their shape, with their mass
 * computed, and observed by their shape's axis. */
#pragma once

#include "host/geometry/shape_mass.h"
#include "tests/physics/physics.h"

namespace tandem::physics_tests {

/* `at` and `turn` place the shape's own frame; the body's frame follows from its mass. */
inline Body &add_dynamic_body(Scene &scene, const Shape &shape, const Vector &at, const Quat &turn = {0, 0, 0, 1},
                              float mass = 1)
{
  Body &body = add_body(scene, BodyType::dynamic, shape, point_of(at));
  body.orientation = turn;
  body.mass = mass;
  take_mass_properties(scene, body);
  return body;
}

/* The pose of a body's shape. */
inline ShapePlace place_of_shape(const Body &given, const BodyState &state)
{
  Body body = given;
  body.position = state.position;
  body.orientation = state.orientation;
  return tandem::place_of_shape(body);
}
inline Vector middle_of(const Body &body, const BodyState &state)
{
  const ShapePlace place = place_of_shape(body, state);
  return {place.position[0], place.position[1], place.position[2]};
}
/* The +Y axis of the shape, from its lower end to its upper one. */
inline Vector axis_of(const Body &body, const BodyState &state)
{
  const Double3 axis = turned(place_of_shape(body, state).orientation, {0, 1, 0});
  return {axis[0], axis[1], axis[2]};
}

/* A hull of points on an ellipsoid, none of whose half axes exceeds `size`. */
inline Shape random_hull_shape(Random &random, int points, double size)
{
  const Vector axes(random.uniform(0.5, 1), random.uniform(0.5, 1), random.uniform(0.5, 1));
  std::vector<Vec3> cloud;
  while (int(cloud.size()) < points) {
    const Vector p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (p.norm() > 0.1 && p.norm() < 1) cloud.push_back(vec3_of(size * axes.cwiseProduct(p.normalized())));
  }
  return hull_shape(cloud, "stone");
}

inline std::vector<Vec3> corners_of_box(float x, float y, float z)
{
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back({k & 1 ? x : -x, k & 2 ? y : -y, k & 4 ? z : -z});
  return corners;
}

inline Shape hull_of_box(float x, float y, float z) { return hull_shape(corners_of_box(x, y, z), "box"); }

/* The closed surface of a box, made of twelve triangles. */
inline Shape mesh_of_box(float x, float y, float z)
{
  const std::vector<uint32_t> triangles = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                           2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return mesh_shape(corners_of_box(x, y, z), triangles, "box");
}

/* The kinetic and potential energy, J. */
inline double mechanical_energy(World &world)
{
  double energy = world.statistics().kinetic_energy;
  const std::vector<BodyState> states = world.bodies();
  for (size_t i = 0; i < states.size(); ++i)
    if (const Body &body = world.scene().bodies[i]; body.type == BodyType::dynamic)
      energy += body.mass * gravity * states[i].position[1];
  return energy;
}

} // namespace tandem::physics_tests
