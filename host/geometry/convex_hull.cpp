/* convex_hull.cpp - normalises points, finds their exact hull, merges its faces and computes planes and edges; see
 * convex_hull.h. */
#include "host/geometry/convex_hull.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/geometry/face_merger.h"
#include "host/geometry/mass_properties.h"
#include "host/geometry/quickhull.h"

namespace tandem {
namespace {

double longest_side(const AxisAlignedBox &bounds)
{
  double longest = 0;
  for (size_t axis = 0; axis < 3; ++axis) longest = std::max(longest, double(bounds.upper[axis]) - bounds.lower[axis]);
  return longest;
}

/* The points relative to the centre of their bounds, scaled to a size from 1/2 to 1 and rounded to the grid of
 * quickhull. The scale is a power of two, so scaling does not round. */
struct Normalised {
  std::vector<Vector> points;
  double scale;
};

Normalised normalised(std::span<const Vec3> points)
{
  const AxisAlignedBox bounds = bounds_of(points);
  const Vector center = (vector_of(bounds.lower) + vector_of(bounds.upper)) / 2;
  int exponent;
  std::frexp(longest_side(bounds), &exponent);
  Normalised result{{}, std::ldexp(1.0, -exponent)};
  for (const Vec3 &p : points) result.points.push_back(on_hull_grid((vector_of(p) - center) * result.scale));
  return result;
}

template <class Measure> size_t farthest(const std::vector<Vector> &points, const Measure &measure)
{
  size_t best = 0;
  for (size_t i = 1; i < points.size(); ++i)
    if (measure(points[i]) > measure(points[best])) best = i;
  return best;
}

/* "in one place", "in a line", "in a plane", or "" if the points span a volume. */
std::string flatness(const std::vector<Vector> &points, double tolerance)
{
  const Vector a = points[0];
  const Vector b = points[farthest(points, [&](const Vector &p) { return (p - a).norm(); })];
  if ((b - a).norm() <= tolerance) return "in one place";
  const Vector along = (b - a).normalized();
  const auto from_line = [&](const Vector &p) { return (p - a).cross(along).norm(); };
  const Vector c = points[farthest(points, from_line)];
  if (from_line(c) <= tolerance) return "in a line";
  const Vector normal = (b - a).cross(c - a).normalized();
  const auto from_plane = [&](const Vector &p) { return std::abs(normal.dot(p - a)); };
  return from_plane(points[farthest(points, from_plane)]) <= tolerance ? "in a plane" : "";
}

[[noreturn]] void refuse_flat(const std::string &where, size_t count, const std::string &how)
{
  throw InputError(fmt::format("{}: all {} points lie {}; a hull needs four that do not", where, count, how));
}

/* The indices of the points that the faces name, ascending. */
std::vector<uint32_t> named_by(const std::vector<Polygon> &faces)
{
  std::vector<uint32_t> names;
  for (const Polygon &face : faces) names.insert(names.end(), face.begin(), face.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/* The points that are corners of three faces or more. The others lie inside a face or an edge, within the tolerance. */
std::vector<uint32_t> true_corners(const std::vector<Polygon> &faces)
{
  std::vector<uint32_t> corners = named_by(faces);
  std::vector<uint32_t> count(corners.empty() ? 0 : corners.back() + size_t{1});
  for (const Polygon &face : faces)
    for (uint32_t corner : face) ++count[corner];
  std::erase_if(corners, [&](uint32_t corner) { return count[corner] < 3; });
  return corners;
}

/* The faces of the hull of the points in `kept`, with the indices of all points. */
std::vector<Polygon> faces_of(const std::vector<Vector> &points, const std::vector<uint32_t> &kept, double within)
{
  std::vector<Vector> chosen;
  for (uint32_t index : kept) chosen.push_back(points[index]);
  std::vector<Polygon> faces = hull_triangles(chosen, within);
  for (Polygon &face : faces)
    for (uint32_t &corner : face) corner = kept[corner];
  return faces;
}

std::vector<HullEdge> edges_of(const std::vector<std::vector<uint32_t>> &faces)
{
  std::vector<std::array<uint32_t, 3>> sides; /* from, to, face */
  for (uint32_t face = 0; face < faces.size(); ++face)
    for (size_t i = 0; i < faces[face].size(); ++i)
      sides.push_back({faces[face][i], faces[face][(i + 1) % faces[face].size()], face});
  std::sort(sides.begin(), sides.end());
  std::vector<HullEdge> edges;
  for (const auto &[from, to, face] : sides)
    if (from < to) {
      const auto twin = std::lower_bound(sides.begin(), sides.end(), std::array<uint32_t, 3>{to, from, 0});
      edges.push_back({from, to, face, (*twin)[2]});
    }
  return edges;
}

/* Finds the greatest normal . x over a surface that is convex within `slack`, from a vertex near the maximum: all
 * vertices that lie less than the slack below the maximum are connected. */
class Top {
public:
  Top(const std::vector<Vector> &points, const std::vector<HullEdge> &edges)
      : points_(points), neighbours_(points.size()), seen_(points.size())
  {
    for (const HullEdge &edge : edges) {
      neighbours_[edge.v0].push_back(edge.v1);
      neighbours_[edge.v1].push_back(edge.v0);
    }
  }

  double height(const Vector &normal, uint32_t start, double slack)
  {
    double highest = normal.dot(points_[start]);
    std::vector<uint32_t> waiting{start};
    ++visit_;
    while (!waiting.empty()) {
      const uint32_t at = waiting.back();
      waiting.pop_back();
      for (uint32_t next : neighbours_[at]) {
        const double here = normal.dot(points_[next]);
        if (seen_[next] == visit_ || here < highest - slack) continue;
        seen_[next] = visit_;
        highest = std::max(highest, here);
        waiting.push_back(next);
      }
    }
    return highest;
  }

private:
  const std::vector<Vector> &points_;
  std::vector<std::vector<uint32_t>> neighbours_;
  std::vector<size_t> seen_; /* the number of the last visit */
  size_t visit_ = 0;
};

/* Of these of the points; the faces have the indices of all points. */
struct ExactHull {
  std::vector<uint32_t> points;
  std::vector<Polygon> faces;
};

/* Few faces within `tolerance` of the exact hull of all points. A first hull omits points that rounding put
 * slightly outside of flat regions; the exact hull of the rest is then merged until no point is left out. The result is
 * empty if too few points remain, because the hull is hardly thicker than the tolerance. */
std::vector<Polygon> simplified(const std::vector<Vector> &points, const ExactHull &all, double tolerance)
{
  std::vector<uint32_t> kept = named_by(faces_of(points, named_by(all.faces), tolerance));
  while (kept.size() >= 4) {
    const std::vector<Polygon> exact = kept == all.points ? all.faces : faces_of(points, kept, 0);
    if (exact.empty()) return {};
    std::vector<Polygon> merged = merged_faces(points, exact, tolerance);
    std::vector<uint32_t> corners = true_corners(merged);
    if (corners.size() == named_by(exact).size()) return merged;
    kept = std::move(corners);
  }
  return {};
}

/* The largest distance of a point of the exact hull outside the planes of these faces. */
double farthest_outside(const std::vector<Vector> &points, const std::vector<Polygon> &exact,
                        const std::vector<Polygon> &faces)
{
  Top top(points, edges_of(exact));
  double farthest = 0;
  for (const Polygon &face : faces) {
    const Vector normal = newell_normal(points, face).normalized();
    double own = -INFINITY;
    for (uint32_t corner : face) own = std::max(own, normal.dot(points[corner]));
    farthest = std::max(farthest, top.height(normal, face[0], 1e-14) - own);
  }
  return farthest;
}

/* Flat hulls may lose points that matter; the tolerance is reduced until they are kept. */
std::vector<Polygon> find_faces(const std::vector<Vector> &points, double tolerance, const std::string &where)
{
  ExactHull exact;
  exact.points.resize(points.size());
  std::iota(exact.points.begin(), exact.points.end(), 0u);
  exact.faces = faces_of(points, exact.points, 0);
  if (!exact.faces.empty())
    for (double within : {tolerance, tolerance / 4, tolerance / 16, tolerance / 64, tolerance / 1024, 0.0}) {
      std::vector<Polygon> faces = simplified(points, exact, within);
      if (!faces.empty() && farthest_outside(points, exact.faces, faces) <= hull_outside * tolerance) return faces;
    }
  throw InputError(
      fmt::format("{}: no convex hull of these {} points: roundings leave its surface open", where, points.size()));
}

void fit_planes(ConvexHull &hull)
{
  std::vector<Vector> points;
  for (const Vec3 &v : hull.vertices) points.push_back(vector_of(v));
  Top top(points, hull.edges);
  hull.planes.clear();
  for (const Polygon &face : hull.faces) {
    const Vector normal = newell_normal(points, face).normalized();
    hull.planes.push_back({array_of(normal), top.height(normal, face[0], 4 * hull.tolerance)});
  }
}

/* Replaces the indices of points by those of the hull's own vertices. */
void renumber(std::vector<Polygon> &faces, const std::vector<uint32_t> &kept)
{
  for (Polygon &face : faces) {
    for (uint32_t &corner : face) corner = uint32_t(std::lower_bound(kept.begin(), kept.end(), corner) - kept.begin());
    start_at_smallest(face);
  }
  std::sort(faces.begin(), faces.end());
}

} // namespace

double hull_tolerance_of(std::span<const Vec3> points)
{
  const AxisAlignedBox bounds = bounds_of(points);
  double largest = 0;
  for (size_t axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(double(bounds.lower[axis])), std::abs(double(bounds.upper[axis]))});
  return std::max(hull_tolerance * longest_side(bounds), hull_rounding * largest);
}

ConvexHull convex_hull(std::span<const Vec3> given, const std::string &where)
{
  require_finite(given, "point", where);
  const std::vector<Vec3> points = distinct(given).points;
  if (points.size() < 4)
    throw InputError(fmt::format("{}: a hull needs four different points, not {}", where, points.size()));
  ConvexHull hull;
  hull.tolerance = hull_tolerance_of(points);
  const Normalised unit = normalised(points);
  if (const std::string how = flatness(unit.points, hull.tolerance * unit.scale); !how.empty())
    refuse_flat(where, points.size(), how);

  std::vector<Polygon> faces = find_faces(unit.points, hull.tolerance * unit.scale, where);
  const std::vector<uint32_t> kept = named_by(faces);
  for (uint32_t index : kept) hull.vertices.push_back(points[index]);
  renumber(faces, kept);
  hull.faces = std::move(faces);
  hull.edges = edges_of(hull.faces);
  fit_planes(hull);
  hull.centroid = hull_mass(hull).center;
  return hull;
}

ConvexHull translated(const ConvexHull &hull, const Double3 &offset)
{
  ConvexHull result = hull;
  for (Vec3 &v : result.vertices)
    for (size_t axis = 0; axis < 3; ++axis) v[axis] = round_to_float(v[axis] + offset[axis]);
  result.tolerance = std::max(hull.tolerance, hull_tolerance_of(result.vertices));
  fit_planes(result);
  result.centroid = hull_mass(result).center;
  return result;
}

double radius_about(const ConvexHull &hull, const Double3 &center)
{
  double radius = 0;
  for (const Vec3 &v : hull.vertices) radius = std::max(radius, (vector_of(v) - vector_of(center)).norm());
  return radius;
}

} // namespace tandem
