/* box_reference.h - contacts of boxes by textbook methods, in double precision: distances by support points, every axis
 * tried, polygons clipped side by side. It shares nothing with the kernels.
 */
#pragma once

#include <algorithm>
#include <array>

#include "tests/shared/narrowphase/pairs.h"

namespace tandem::narrowphase_tests {

struct ReferenceBox {
  Vector center, extent;
  Eigen::Matrix3d axes; /* columns */

  explicit ReferenceBox(const TestBody &body) : center(body.center()), extent(body.extent()), axes(body.axes()) {}

  double support(const Vector &direction) const
  {
    return center.dot(direction) + (axes.transpose() * direction).cwiseAbs().dot(extent);
  }
  /* The signed distance of a point from the surface; it is negative inside. */
  double distance(const Vector &point) const
  {
    const Vector q = (axes.transpose() * (point - center)).cwiseAbs() - extent;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
  }
};

/* The gap between two boxes along a unit direction from a to b. */
inline double gap_along(const ReferenceBox &a, const ReferenceBox &b, const Vector &direction)
{
  return -b.support(-direction) - a.support(direction);
}

struct ReferenceAxis {
  Vector direction; /* unit, from a to b */
  double gap;
  double sharpness; /* sine of the angle of the two edges; 1 for faces */
  bool edges;
};

inline std::vector<ReferenceAxis> all_axes(const ReferenceBox &a, const ReferenceBox &b)
{
  std::vector<ReferenceAxis> axes;
  const auto consider = [&](Vector direction, bool edges) {
    const double length = direction.norm();
    if (length < 1e-4) return;
    direction /= length;
    for (double sign : {1.0, -1.0})
      axes.push_back({sign * direction, gap_along(a, b, sign * direction), length, edges});
  };
  for (int k = 0; k < 3; ++k) consider(a.axes.col(k), false);
  for (int j = 0; j < 3; ++j) consider(b.axes.col(j), false);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j) consider(Vector(a.axes.col(k)).cross(Vector(b.axes.col(j))), true);
  return axes;
}

using Polygon = std::vector<Vector>;

/* The part of a polygon with normal . x <= limit (Sutherland and Hodgman). */
inline Polygon clipped(const Polygon &polygon, const Vector &normal, double limit)
{
  Polygon result;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vector &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double d = normal.dot(from) - limit, e = normal.dot(to) - limit;
    if (d <= 0) result.push_back(from);
    if ((d < 0 && e > 0) || (d > 0 && e < 0)) result.push_back(from + (to - from) * (d / (d - e)));
  }
  return result;
}

/* Face `axis` of the incident box on the side opposed to `outward`, clipped to the sides of the reference box around
 * its face `face`, widened by `slack`. */
inline Polygon contact_polygon(const ReferenceBox &reference, int face, const Vector &outward,
                               const ReferenceBox &incident, int axis, double slack = 0)
{
  const Vector n = incident.axes.col(axis);
  const Vector u = incident.axes.col((axis + 1) % 3), v = incident.axes.col((axis + 2) % 3);
  const double eu = incident.extent[(axis + 1) % 3], ev = incident.extent[(axis + 2) % 3];
  const Vector middle = incident.center - (n.dot(outward) < 0 ? -1 : 1) * incident.extent[axis] * n;
  Polygon polygon = {middle - eu * u - ev * v, middle + eu * u - ev * v, middle + eu * u + ev * v,
                     middle - eu * u + ev * v};
  for (int side : {(face + 1) % 3, (face + 2) % 3})
    for (double sign : {1.0, -1.0}) {
      const Vector normal = sign * reference.axes.col(side);
      polygon = clipped(polygon, normal, normal.dot(reference.center) + reference.extent[side] + slack);
    }
  return polygon;
}

/* The area of the convex hull of points seen along a direction (Andrew's monotone chain). */
inline double hull_area(const std::vector<Vector> &points, const Vector &direction)
{
  const Vector u = direction.unitOrthogonal(), v = direction.cross(u);
  std::vector<std::pair<double, double>> flat, hull;
  for (const Vector &p : points) flat.push_back({p.dot(u), p.dot(v)});
  std::sort(flat.begin(), flat.end());
  const auto extend = [&](auto begin, auto end) {
    const size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2) {
        const auto &a = hull[hull.size() - 2], &b = hull.back();
        if ((b.first - a.first) * (p->second - a.second) - (b.second - a.second) * (p->first - a.first) > 0) break;
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    if (!hull.empty()) hull.pop_back();
  };
  extend(flat.begin(), flat.end());
  extend(flat.rbegin(), flat.rend());
  double area = 0;
  for (size_t i = 0; i < hull.size(); ++i) {
    const auto &a = hull[i], &b = hull[(i + 1) % hull.size()];
    area += a.first * b.second - a.second * b.first;
  }
  return std::abs(area) / 2;
}

} // namespace tandem::narrowphase_tests
