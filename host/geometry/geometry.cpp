/* geometry.cpp - bounds, scaling, removal of duplicate points and checks of points; see geometry.h. */
#include "host/geometry/geometry.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

namespace tandem {
namespace {

struct PointHash {
  size_t operator()(const Vec3 &p) const
  {
    size_t hash = 0;
    for (float x : p) hash = hash * 0x9e3779b97f4a7c15u + std::hash<float>{}(x); /* equal for both zeros, as == is */
    return hash;
  }
};

} // namespace

AxisAlignedBox bounds_of(std::span<const Vec3> points)
{
  AxisAlignedBox bounds{points[0], points[0]};
  for (const Vec3 &p : points)
    for (size_t axis = 0; axis < 3; ++axis) {
      bounds.lower[axis] = std::min(bounds.lower[axis], p[axis]);
      bounds.upper[axis] = std::max(bounds.upper[axis], p[axis]);
    }
  return bounds;
}

std::vector<Vec3> scaled(std::span<const Vec3> points, const Vec3 &scale, const std::string &where)
{
  for (float factor : scale)
    if (!std::isfinite(factor) || factor == 0)
      throw InputError(fmt::format("{}: scale is [{}, {}, {}]; three finite numbers other than zero are needed", where,
                                   scale[0], scale[1], scale[2]));
  std::vector<Vec3> result(points.begin(), points.end());
  for (Vec3 &p : result)
    for (size_t axis = 0; axis < 3; ++axis) p[axis] *= scale[axis];
  return result;
}

DistinctPoints distinct(std::span<const Vec3> points)
{
  DistinctPoints result;
  std::unordered_map<Vec3, uint32_t, PointHash> places;
  result.index.reserve(points.size());
  for (const Vec3 &p : points) {
    const auto [place, fresh] = places.try_emplace(p, uint32_t(result.points.size()));
    if (fresh) result.points.push_back({p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f}); /* -0 + 0 is 0 */
    result.index.push_back(place->second);
  }
  return result;
}

void require_finite(std::span<const Vec3> points, const char *what, const std::string &where)
{
  for (size_t i = 0; i < points.size(); ++i)
    for (float x : points[i])
      if (!std::isfinite(x))
        throw InputError(fmt::format("{}: {} {} is [{}, {}, {}]; three finite numbers are needed", where, what, i,
                                     points[i][0], points[i][1], points[i][2]));
}

void require_within_reach(std::span<const Vec3> points, const char *what, const std::string &where)
{
  require_finite(points, what, where);
  for (size_t i = 0; i < points.size(); ++i)
    for (float x : points[i])
      if (std::abs(x) > longest_length)
        throw InputError(fmt::format(
            "{}: {} {} is [{}, {}, {}]; at most {} is possible, so that what is computed from it stays a float", where,
            what, i, points[i][0], points[i][1], points[i][2], longest_length));
}

} // namespace tandem
