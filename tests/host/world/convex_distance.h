/* convex_distance.h - the distance of bodies in double precision, for the tests of queries.
 *
 * The reference shares nothing with the kernels: it works on supports in double, and searches the sub-simplices of four
 * points by brute force. It proves what it says: `lower` is a gap that a direction shows, and `upper` the length of a
 * vector between two points of the shapes.
 */
#pragma once

#include <array>
#include <vector>

#include "host/geometry/convex_hull.h"
#include "host/geometry/triangle_mesh.h"
#include "tests/physics/bodies.h"

namespace tandem::convex_distance {

using physics_tests::axes_of;
using physics_tests::Matrix;
using physics_tests::Vector;
using physics_tests::vector_of;

/* A convex part of a body, in the world: a core and a radius around it. Without points the core is the one of a
 * cylinder or a capsule. */
struct Solid {
  ShapeType type;
  Vector size;
  Matrix axes;
  Vector middle;
  std::vector<Vector> points;
  double radius;

  Vector support(const Vector &direction) const
  {
    if (points.empty()) return middle + axes * own_support(axes.transpose() * direction);
    const Vector *best = &points.front();
    for (const Vector &point : points)
      if (point.dot(direction) > best->dot(direction)) best = &point;
    return *best;
  }
  double reach() const
  {
    double most = size.norm() + std::max(size.x(), size.z());
    for (const Vector &point : points) most = std::max(most, (point - middle).norm());
    return most + radius;
  }

private:
  Vector own_support(const Vector &d) const
  {
    const double low = size.x() - radius, high = size.z() - radius, across = std::hypot(d.x(), d.z());
    if (type == ShapeType::capsule) {
      const Vector top = Vector(0, size.y(), 0) + high * d.normalized(),
                   bottom = Vector(0, -size.y(), 0) + low * d.normalized();
      return top.dot(d) > bottom.dot(d) ? top : bottom;
    }
    const Vector outward = across > 0 ? Vector(d.x() / across, 0, d.z() / across) : Vector(1, 0, 0);
    const Vector top = Vector(0, size.y(), 0) + size.z() * outward,
                 bottom = Vector(0, -size.y(), 0) + size.x() * outward;
    return top.dot(d) > bottom.dot(d) ? top : bottom;
  }
};

inline void append_solids(std::vector<Solid> &solids, const Shape &shape, const Matrix &axes, const Vector &middle)
{
  const Vector size = vector_of(shape.size);
  Solid solid{shape.type, size, axes, middle, {}, 0};
  const auto add = [&](const Vector &own) { solid.points.push_back(middle + axes * own); };
  switch (shape.type) {
  case ShapeType::sphere: add(Vector::Zero()), solid.radius = size.x(); break;
  case ShapeType::box:
    for (int k = 0; k < 8; ++k) add(Vector(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).cwiseProduct(size));
    break;
  case ShapeType::hull:
    for (const Vec3 &vertex : shape.hull->vertices) add(vector_of(vertex));
    break;
  case ShapeType::capsule: solid.radius = std::min(size.x(), size.z()); break;
  case ShapeType::mesh:
    for (const auto &corners : shape.mesh->triangles) {
      solid.points.clear();
      for (const uint32_t corner : corners) add(vector_of(shape.mesh->vertices[corner]));
      solids.push_back(solid);
    }
    return;
  case ShapeType::compound:
    for (const Child &child : shape.compound->children)
      append_solids(solids, child.shape, axes * axes_of(child.orientation), middle + axes * vector_of(child.position));
    return;
  case ShapeType::cylinder:
  case ShapeType::half_space: break;
  }
  solids.push_back(solid);
}

inline std::vector<Solid> solids_of(const Shape &shape, const Pose &pose)
{
  std::vector<Solid> solids;
  append_solids(solids, shape, axes_of(pose.orientation), vector_of(pose.position));
  return solids;
}
inline std::vector<Solid> solids_of(const Scene &scene, const Body &body)
{
  std::vector<Solid> solids;
  const Matrix axes = axes_of(body.orientation);
  append_solids(solids, scene.shapes[body.shape], axes * axes_of(body.shape_orientation),
                vector_of(body.position) + axes * vector_of(body.shape_position));
  return solids;
}

/* Bounds of a distance; both are 0 or less where the shapes overlap. normal: from a to b, of the lower bound. */
struct DistanceBounds {
  double lower, upper;
  Vector normal;
};

struct Simplex {
  std::vector<Vector> points;
  Vector nearest;
};

/* The least vector of all sub-simplices whose nearest point has weights that are all positive. */
inline Simplex nearest_sub_simplex(const std::vector<Vector> &points)
{
  Simplex best{{}, Vector::Constant(1e150)};
  for (unsigned chosen = 1; chosen < 1u << points.size(); ++chosen) {
    std::vector<Vector> some;
    for (size_t k = 0; k < points.size(); ++k)
      if (chosen >> k & 1) some.push_back(points[k]);
    Eigen::MatrixXd sides(3, static_cast<Eigen::Index>(some.size() - 1));
    for (size_t k = 1; k < some.size(); ++k) sides.col(static_cast<Eigen::Index>(k - 1)) = some[k] - some[0];
    const Eigen::VectorXd weights =
        some.size() == 1 ? Eigen::VectorXd() : Eigen::VectorXd(sides.colPivHouseholderQr().solve(-some[0]));
    if (some.size() > 1 && (weights.minCoeff() < 0 || weights.sum() > 1)) continue;
    const Vector nearest = some.size() == 1 ? some[0] : Vector(some[0] + sides * weights);
    if (nearest.norm() < best.nearest.norm()) best = {some, nearest};
  }
  return best;
}

inline DistanceBounds distance_between(const Solid &a, const Solid &b)
{
  DistanceBounds found{-1e300, 1e300, Vector::UnitX()};
  const double size = a.reach() + b.reach() + (a.middle - b.middle).norm(), radii = a.radius + b.radius;
  Simplex simplex{{}, a.support(Vector::UnitX()) - b.support(-Vector::UnitX())};
  for (int round = 0; round < 300; ++round) {
    found.upper = simplex.nearest.norm();
    if (found.upper < 1e-13 * size) return {-radii, -radii, found.normal};
    const Vector toward = -simplex.nearest / found.upper, next = a.support(toward) - b.support(-toward);
    if (-next.dot(toward) > found.lower) found.lower = -next.dot(toward), found.normal = toward;
    if (found.upper - found.lower < 1e-13 * size) break;
    simplex.points.push_back(next);
    simplex = nearest_sub_simplex(simplex.points);
    if (simplex.points.size() == 4) return {-radii, -radii, found.normal};
  }
  return {found.lower - radii, found.upper - radii, found.normal};
}

/* y of a half-space's own axes is up. */
inline DistanceBounds distance_to_plane(const Solid &a, const Solid &plane)
{
  const Vector up = plane.axes.col(1);
  const double gap = up.dot(a.support(-up) - plane.middle) - a.radius;
  return {gap, gap, -up};
}

/* The least over all parts. */
inline DistanceBounds distance_between(const std::vector<Solid> &a, const std::vector<Solid> &b)
{
  DistanceBounds least{1e300, 1e300, Vector::Zero()};
  for (const Solid &one : a)
    for (const Solid &other : b) {
      DistanceBounds found = other.type == ShapeType::half_space ? distance_to_plane(one, other)
                             : one.type == ShapeType::half_space ? distance_to_plane(other, one)
                                                                 : distance_between(one, other);
      if (one.type == ShapeType::half_space) found.normal = -found.normal;
      if (found.lower < least.lower) least.normal = found.normal;
      least.lower = std::min(least.lower, found.lower);
      least.upper = std::min(least.upper, found.upper);
    }
  return least;
}

} // namespace tandem::convex_distance
