/* polygon_crossing.cpp - projects the polygon along an axis and compares its sides pairwise; see polygon_crossing.h. */
#include "host/geometry/polygon_crossing.h"

#include <algorithm>

#include "host/geometry/vector.h"

namespace tandem {
namespace {

using Flat = std::array<double, 2>;

/* The normal of the plane through the first corner, the one farthest from it, and the one farthest from the line of
 * both. */
Vector normal_of_farthest(std::span<const Vec3> corners)
{
  Vector along, across;
  const Vector first = vector_of(corners[0]);
  const auto longer = [](const Vector &p, const Vector &q) { return p.squared_norm() > q.squared_norm() ? p : q; };
  for (const Vec3 &corner : corners) along = longer(vector_of(corner) - first, along);
  for (const Vec3 &corner : corners) across = longer(along.cross(vector_of(corner) - first), across);
  return across;
}

/* Newell's normal (twice the area vector), which is also right for corners that are not exactly in one plane. The two
 * halves of a self-crossing polygon may cancel in it; the normal of the farthest corners replaces it then. */
Vector normal_of(std::span<const Vec3> corners)
{
  constexpr double cancelled = 1e-3; /* of the triangle of the farthest corners */
  Vector area;
  const Vector first = vector_of(corners[0]);
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    area += (vector_of(corners[i]) - first).cross(vector_of(corners[i + 1]) - first);
  const Vector farthest = normal_of_farthest(corners);
  return area.norm() > cancelled * farthest.norm() ? area : farthest;
}

std::vector<Flat> flattened(std::span<const Vec3> corners)
{
  const Vector normal = normal_of(corners);
  const double size[3] = {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const auto dropped = size_t(std::max_element(size, size + 3) - size);
  std::vector<Flat> flat;
  for (const Vec3 &corner : corners) flat.push_back({corner[(dropped + 1) % 3], corner[(dropped + 2) % 3]});
  return flat;
}

/* The side of the line from a to b on which the point lies: -1, 0 or 1. */
int side_of(const Flat &a, const Flat &b, const Flat &point)
{
  const double left = (b[0] - a[0]) * (point[1] - a[1]), right = (b[1] - a[1]) * (point[0] - a[0]);
  return (left > right) - (left < right);
}

bool cross(const Flat &a, const Flat &b, const Flat &c, const Flat &d)
{
  return side_of(a, b, c) * side_of(a, b, d) < 0 && side_of(c, d, a) * side_of(c, d, b) < 0;
}

} // namespace

/* The sides are sorted along the first axis, so that only those that overlap along it are compared. */
bool crosses_itself(std::span<const Vec3> corners)
{
  if (corners.size() < 4) return false;
  const std::vector<Flat> flat = flattened(corners);
  const auto end_of = [&](size_t side) -> const Flat & { return flat[(side + 1) % flat.size()]; };
  const auto left_of = [&](size_t side) { return std::min(flat[side][0], end_of(side)[0]); };
  std::vector<size_t> order(flat.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return left_of(a) < left_of(b); });
  for (size_t i = 0; i < order.size(); ++i) {
    const double right = std::max(flat[order[i]][0], end_of(order[i])[0]);
    for (size_t k = i + 1; k < order.size() && left_of(order[k]) < right; ++k)
      if (cross(flat[order[i]], end_of(order[i]), flat[order[k]], end_of(order[k]))) return true;
  }
  return false;
}

} // namespace tandem
