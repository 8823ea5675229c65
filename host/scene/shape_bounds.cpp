/* shape_bounds.cpp - see shape_bounds.h. The bounds are computed once, so they are computed in double and rounded
 * outward at the end. */
#include "host/scene/shape_bounds.h"

#include <algorithm>
#include <cmath>

#include <tandem/round_to_float.h>

#include "host/geometry/convex_hull.h"
#include "host/geometry/triangle_mesh.h"

namespace tandem {
namespace {

Double3 double3(const Vec3 &v) { return {v[0], v[1], v[2]}; }
double length(const Double3 &v)
{
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
} /* hypot differs between libraries */
float outward(double x) { return std::nextafter(round_to_float(x), HUGE_VALF); }

/* The pose of a shape in a body; the columns x y z are its axes. */
struct Frame {
  Double3 x, y, z, origin;
};

Frame frame_of(const Vec3 &position, const Quat &orientation)
{
  const double a = orientation[0], b = orientation[1], c = orientation[2], d = orientation[3];
  const double norm = std::sqrt(a * a + b * b + c * c + d * d), x = a / norm, y = b / norm, z = c / norm, w = d / norm;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
          double3(position)};
}
Double3 turned(const Frame &frame, const Double3 &own)
{
  Double3 v{};
  for (size_t k = 0; k < 3; ++k) v[k] = frame.x[k] * own[0] + frame.y[k] * own[1] + frame.z[k] * own[2];
  return v;
}
Double3 placed(const Frame &frame, const Double3 &own)
{
  Double3 point = turned(frame, own);
  for (size_t k = 0; k < 3; ++k) point[k] += frame.origin[k];
  return point;
}
Frame product(const Frame &outer, const Frame &inner)
{
  return {turned(outer, inner.x), turned(outer, inner.y), turned(outer, inner.z), placed(outer, inner.origin)};
}

/* The parts of a round shape, whose convex hull contains the shape: balls about points of the body, or discs across an
 * axis. */
struct Round {
  Double3 center;
  double radius;
  bool disc;
  Double3 axis;
};

std::vector<Double3> corners_of(const Shape &shape)
{
  std::vector<Double3> corners;
  if (shape.type != ShapeType::box)
    for (const Vec3 &v : shape.hull ? shape.hull->vertices : shape.mesh->vertices) corners.push_back(double3(v));
  else
    for (int k = 0; k < 8; ++k)
      corners.push_back({k & 1 ? shape.size[0] : -shape.size[0], k & 2 ? shape.size[1] : -shape.size[1],
                         k & 4 ? shape.size[2] : -shape.size[2]});
  return corners;
}

bool has_corners(const Shape &shape) { return shape.type == ShapeType::box || shape.hull || shape.mesh; }

void add_rounds(std::vector<Round> &rounds, const Shape &shape, const Frame &frame)
{
  if (shape.compound)
    for (const Child &child : shape.compound->children)
      add_rounds(rounds, child.shape, product(frame, frame_of(child.position, child.orientation)));
  else if (has_corners(shape))
    for (const Double3 &corner : corners_of(shape)) rounds.push_back({placed(frame, corner), 0, false, {}});
  else if (shape.type == ShapeType::sphere) rounds.push_back({frame.origin, shape.size[0], false, {}});
  else
    for (size_t end : {0, 2})
      rounds.push_back({placed(frame, {0, end == 0 ? -double(shape.size[1]) : double(shape.size[1]), 0}),
                        shape.size[end], shape.type == ShapeType::cylinder, frame.y});
}

std::vector<Round> rounds_of(const Shape &shape, const Vec3 &position, const Quat &orientation)
{
  std::vector<Round> rounds;
  add_rounds(rounds, shape, frame_of(position, orientation));
  return rounds;
}

/* The extent of a disc along an axis is its projection. */
double reach_along(const Round &round, size_t axis)
{
  return round.disc ? round.radius * std::sqrt(std::max(0.0, 1 - round.axis[axis] * round.axis[axis])) : round.radius;
}

/* The distance from the body's centre to the farthest point. */
double farthest_from_centre(const Round &round)
{
  if (!round.disc) return length(round.center) + round.radius;
  const double along =
      round.center[0] * round.axis[0] + round.center[1] * round.axis[1] + round.center[2] * round.axis[2];
  const double across = std::sqrt(std::max(0.0, length(round.center) * length(round.center) - along * along));
  return length({along, across + round.radius, 0});
}

Vec3 extents_about_origin(const std::vector<Vec3> &points)
{
  Vec3 size{0, 0, 0};
  for (const Vec3 &v : points)
    for (size_t k = 0; k < 3; ++k) size[k] = std::max(size[k], std::abs(v[k]));
  return size;
}

float least_of(const Vec3 &v) { return std::min({v[0], v[1], v[2]}); }

} // namespace

ShapeBox box_around(const Shape &shape, const Vec3 &position, const Quat &orientation)
{
  Double3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const Round &round : rounds_of(shape, position, orientation))
    for (size_t k = 0; k < 3; ++k) {
      const double reach = reach_along(round, k);
      low[k] = std::min(low[k], round.center[k] - reach);
      high[k] = std::max(high[k], round.center[k] + reach);
    }
  ShapeBox box;
  for (size_t k = 0; k < 3; ++k) {
    box.center[k] = round_to_float(0.5 * (low[k] + high[k]));
    box.half_extents[k] = outward(std::max(high[k] - double{box.center[k]}, double{box.center[k]} - low[k]));
  }
  return box;
}

ShapeBox box_around(const Scene &scene, const Body &body)
{
  return box_around(scene.shapes[body.shape], body.shape_position, body.shape_orientation);
}

float bounding_radius(const Scene &scene, const Body &body)
{
  const Shape &shape = scene.shapes[body.shape];
  const bool centred = body.shape_position == Vec3{0, 0, 0};
  if (shape.type == ShapeType::half_space) return 0;
  if (shape.type == ShapeType::sphere && centred) return shape.size[0];
  if (shape.type == ShapeType::box && centred) return round_to_float(length(double3(shape.size)));
  double radius = 0;
  for (const Round &round : rounds_of(shape, body.shape_position, body.shape_orientation))
    radius = std::max(radius, farthest_from_centre(round));
  return outward(radius);
}

Vec3 kernel_size(const Shape &shape)
{
  if (shape.hull) return extents_about_origin(shape.hull->vertices);
  if (shape.mesh) return extents_about_origin(shape.mesh->vertices);
  if (!shape.compound) return shape.size;
  float least = HUGE_VALF;
  for (const Child &child : shape.compound->children) least = std::min(least, least_of(kernel_size(child.shape)));
  return {least, least, least};
}

} // namespace tandem
