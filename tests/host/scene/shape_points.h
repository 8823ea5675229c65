/* shape_points.h - random shapes and poses, and points of their surfaces, against which bounds are tested.
 *
 *   sphere, ends of a capsule   toward the body's axes and away from its centre, and anywhere
 *   cylinder                    both rims, a point every tenth of a degree
 *   box, hull                   vertices
 *
 * Every shape is the convex hull of these points, so bounds that contain them contain the shape.
 */
#pragma once

#include "host/geometry/convex_hull.h"
#include "host/geometry/triangle_mesh.h"
#include "tests/physics/bodies.h"

namespace tandem::shape_points {

using physics_tests::direction;
using physics_tests::pi;
using physics_tests::Vector;

inline Shape any_shape(Random &random)
{
  const auto size = [&] { return float(std::exp(random.uniform(std::log(0.05), std::log(2)))); };
  switch (random.below(8)) {
  case 0: return sphere_shape(size());
  case 1: return box_shape(size(), size(), size());
  case 2: return capsule_shape(size(), size());
  case 3: {
    const float low = size(), high = size(); /* neither ball holds the other */
    return {ShapeType::capsule, {low, 0.51f * std::abs(low - high) + size(), high}};
  }
  case 4: return cylinder_shape(size(), size());
  case 5: return {ShapeType::cylinder, {size(), size(), size()}};
  case 6: return random.below(2) ? cone_shape(size(), size()) : Shape{ShapeType::cylinder, {0, size(), size()}};
  default: return physics_tests::random_hull_shape(random, 4 + int(random.below(40)), size());
  }
}

/* A square of so many points along each side, up to 0.3 m high and low. */
inline Shape any_height_field(Random &random, uint32_t columns, float spacing)
{
  std::vector<float> heights;
  for (uint32_t i = 0; i < columns * columns; ++i) heights.push_back(float(random.uniform(-0.3, 0.3)));
  return height_field_shape(heights, columns, spacing, spacing, "heights");
}

/* A body with a shape at any pose in it: a third of the shapes are at its centre, a third of these without a
 * rotation. */
inline Body &add_any(Scene &scene, Random &random, const Point &at)
{
  Body &body = physics_tests::add_body(scene, BodyType::dynamic, any_shape(random), at);
  body.orientation = random.orientation();
  body.inertia = {1, 1, 1}; /* its frame need not be that of its mass */
  if (random.below(3)) body.shape_position = physics_tests::vec3_of(random.uniform(0, 2) * direction(random));
  if (random.below(3)) body.shape_orientation = random.orientation();
  return body;
}

/* The points are in the body's frame. */
inline std::vector<Vector> points_of(const Scene &scene, const Body &body, Random &random)
{
  const Shape &shape = scene.shapes[body.shape];
  const Vector place = physics_tests::vector_of(body.shape_position), size = physics_tests::vector_of(shape.size);
  const physics_tests::Matrix axes = physics_tests::axes_of(body.shape_orientation);
  std::vector<Vector> points;
  const auto own = [&](const Vector &p) { points.push_back(place + axes * p); };
  const auto ball = [&](const Vector &middle, double radius) {
    const Vector center = place + axes * middle;
    for (int k = 0; k < 3; ++k)
      for (double sign : {-1.0, 1.0}) points.push_back(center + sign * radius * Vector::Unit(k));
    points.push_back(center + radius * (center.norm() > 0 ? Vector(center.normalized()) : Vector(1, 0, 0)));
    for (int k = 0; k < 50; ++k) points.push_back(center + radius * direction(random));
  };
  const auto rim = [&](double height, double radius) {
    for (int k = 0; k < 3600; ++k) own({radius * std::cos(k * pi / 1800), height, radius * std::sin(k * pi / 1800)});
  };
  switch (shape.type) {
  case ShapeType::sphere: ball(Vector::Zero(), size.x()); break;
  case ShapeType::capsule: ball({0, -size.y(), 0}, size.x()), ball({0, size.y(), 0}, size.z()); break;
  case ShapeType::cylinder: rim(-size.y(), size.x()), rim(size.y(), size.z()); break;
  case ShapeType::box:
    for (int k = 0; k < 8; ++k) own(Vector(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).cwiseProduct(size));
    break;
  case ShapeType::hull:
    for (const Vec3 &v : shape.hull->vertices) own(physics_tests::vector_of(v));
    break;
  case ShapeType::mesh:
    for (const Vec3 &v : shape.mesh->vertices) own(physics_tests::vector_of(v));
    break;
  case ShapeType::half_space:
  case ShapeType::compound: break;
  }
  return points;
}

} // namespace tandem::shape_points
