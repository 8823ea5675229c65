/* shape_bounds.cpp - see shape_bounds.h. In double, since it is done once; rounded outward in the end. */
#include "host/shape_bounds.h"

#include <algorithm>
#include <cmath>

#include "host/geometry/convex_hull.h"

namespace tandem {
namespace {

Double3 double3(const Vec3 &v) { return {v[0], v[1], v[2]}; }
double length(const Double3 &v) { return std::hypot(v[0], v[1], v[2]); }
float outward(double x) { return std::nextafter(float(x), HUGE_VALF); }

/* Columns: the axes of the shape in its body. */
struct Axes {
  Double3 x, y, z;
};
Axes axes_of(const Quat &orientation)
{
  const double a = orientation[0], b = orientation[1], c = orientation[2], d = orientation[3]; /* of floats hypot is a float */
  const double norm = std::sqrt(a * a + b * b + c * c + d * d), x = a / norm, y = b / norm, z = c / norm, w = d / norm;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

Double3 placed(const Body &body, const Axes &axes, const Double3 &own)
{
  Double3 point = double3(body.shape_position);
  for (size_t k = 0; k < 3; ++k) point[k] += axes.x[k] * own[0] + axes.y[k] * own[1] + axes.z[k] * own[2];
  return point;
}

/* A shape as points with a radius around each (or, for a disc, across its axis). */
struct Round {
  Double3 center;
  double radius;
};

std::vector<Round> ends_of(const Shape &shape)
{
  const double half = shape.size[1];
  return {{{0, -half, 0}, shape.size[0]}, {{0, half, 0}, shape.size[2]}};
}

std::vector<Double3> corners_of(const Shape &shape)
{
  std::vector<Double3> corners;
  if (shape.type == ShapeType::hull)
    for (const Vec3 &v : shape.hull->vertices) corners.push_back(double3(v));
  else
    for (int k = 0; k < 8; ++k)
      corners.push_back({k & 1 ? shape.size[0] : -shape.size[0], k & 2 ? shape.size[1] : -shape.size[1], k & 4 ? shape.size[2] : -shape.size[2]});
  return corners;
}

bool is_polytope(const Shape &shape) { return shape.type == ShapeType::box || shape.type == ShapeType::hull; }

std::vector<Round> rounds_of(const Shape &shape)
{
  if (shape.type == ShapeType::sphere) return {{{0, 0, 0}, shape.size[0]}};
  if (!is_polytope(shape)) return ends_of(shape);
  std::vector<Round> points;
  for (const Double3 &corner : corners_of(shape)) points.push_back({corner, 0});
  return points;
}

/* How far a round end reaches along a body axis: a disc only as far as it is seen from there. */
double reach_along(const Shape &shape, const Axes &axes, size_t axis, double radius)
{
  return shape.type == ShapeType::cylinder ? radius * std::sqrt(std::max(0.0, 1 - axes.y[axis] * axes.y[axis])) : radius;
}

/* From the body's centre to the farthest point of a round end. */
double farthest(const Shape &shape, const Axes &axes, const Double3 &center, double radius)
{
  if (shape.type != ShapeType::cylinder) return length(center) + radius;
  const double along = center[0] * axes.y[0] + center[1] * axes.y[1] + center[2] * axes.y[2];
  const double across = std::sqrt(std::max(0.0, length(center) * length(center) - along * along));
  return std::hypot(along, across + radius);
}

} // namespace

ShapeBox box_around(const Scene &scene, const Body &body)
{
  const Shape &shape = scene.shapes[body.shape];
  const Axes axes = axes_of(body.shape_orientation);
  Double3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const Round &end : rounds_of(shape)) {
    const Double3 center = placed(body, axes, end.center);
    for (size_t k = 0; k < 3; ++k) {
      const double reach = reach_along(shape, axes, k, end.radius);
      low[k] = std::min(low[k], center[k] - reach);
      high[k] = std::max(high[k], center[k] + reach);
    }
  }
  ShapeBox box;
  for (size_t k = 0; k < 3; ++k) {
    box.center[k] = float(0.5 * (low[k] + high[k]));
    box.half_extents[k] = outward(std::max(high[k] - double{box.center[k]}, double{box.center[k]} - low[k]));
  }
  return box;
}

float bounding_radius(const Scene &scene, const Body &body)
{
  const Shape &shape = scene.shapes[body.shape];
  const bool centred = body.shape_position == Vec3{0, 0, 0};
  if (shape.type == ShapeType::half_space) return 0;
  if (shape.type == ShapeType::sphere && centred) return shape.size[0];
  if (shape.type == ShapeType::box && centred) return std::hypot(shape.size[0], shape.size[1], shape.size[2]);
  const Axes axes = axes_of(body.shape_orientation);
  double radius = 0;
  for (const Round &end : rounds_of(shape)) radius = std::max(radius, farthest(shape, axes, placed(body, axes, end.center), end.radius));
  return outward(radius);
}

Vec3 kernel_size(const Shape &shape)
{
  if (shape.type != ShapeType::hull) return shape.size;
  Vec3 size{0, 0, 0};
  for (const Vec3 &v : shape.hull->vertices)
    for (size_t k = 0; k < 3; ++k) size[k] = std::max(size[k], std::abs(v[k]));
  return size;
}

} // namespace tandem
