/* round.cpp - places points on circles and spheres and makes their hull; see round.h. */
#include "host/io/gltf/round.h"

#include <numbers>

#include <tandem/round_to_float.h>

#include "host/base/trigonometry.h"

namespace tandem {
namespace {

constexpr int segments = 24; /* of a circle */

void add_circle(std::vector<Vec3> &points, double radius, double y)
{
  for (int k = 0; k < segments; ++k) {
    const auto [sine, cosine] = sine_cosine(2 * std::numbers::pi * k / segments);
    points.push_back({round_to_float(radius * cosine), round_to_float(y), round_to_float(radius * sine)});
  }
}

void add_ball(std::vector<Vec3> &points, double radius, double y)
{
  for (double pole : {-radius, radius}) points.push_back({0, round_to_float(y + pole), 0});
  for (int ring = 1; ring < segments / 2; ++ring) {
    const auto [sine, cosine] = sine_cosine(2 * std::numbers::pi * ring / segments);
    add_circle(points, radius * sine, y - radius * cosine);
  }
}

} // namespace

Shape round_hull(ShapeType type, const Vec3 &size, const Vec3 &scale, const std::string &where)
{
  std::vector<Vec3> points;
  if (type == ShapeType::sphere) add_ball(points, size[0], 0);
  else
    for (const auto &[radius, y] : {std::pair{size[0], -size[1]}, {size[2], size[1]}}) {
      if (type == ShapeType::capsule) add_ball(points, radius, y);
      else add_circle(points, radius, y);
    }
  for (Vec3 &p : points)
    for (size_t axis = 0; axis < 3; ++axis) p[axis] *= scale[axis];
  return hull_shape(points, where);
}

} // namespace tandem
