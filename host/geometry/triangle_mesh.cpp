/* triangle_mesh.cpp - welds vertices, removes degenerate and duplicate triangles, and classifies edges; see
 * triangle_mesh.h. */
#include "host/geometry/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "host/geometry/convex_hull.h"
#include "host/geometry/vector.h"

namespace tandem {
namespace {

/* One side of a triangle: the edge low-high, and whether the triangle runs along it upward or downward. */
struct Side {
  uint32_t low, high;
  bool upward;
  uint32_t triangle, corner;
  auto operator<=>(const Side &) const = default;
};

std::vector<Side> sides_of(const std::vector<Triangle> &triangles)
{
  std::vector<Side> sides;
  for (uint32_t t = 0; t < triangles.size(); ++t)
    for (uint32_t corner = 0; corner < 3; ++corner) {
      const uint32_t from = triangles[t][corner], to = triangles[t][(corner + 1) % 3];
      if (from != to) sides.push_back({std::min(from, to), std::max(from, to), from < to, t, corner});
    }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/* Calls visit with the sides of one edge, for every edge. */
template <class Visit> void for_each_edge(const std::vector<Side> &sides, const Visit &visit)
{
  for (size_t begin = 0, end; begin < sides.size(); begin = end) {
    end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    visit(std::span(sides).subspan(begin, end - begin));
  }
}

/* A triangle that has collapsed to an edge runs along it both ways, so it neither closes nor opens a gap. */
void count_edges(const std::vector<Triangle> &triangles, MeshFindings &findings)
{
  std::vector<Triangle> whole;
  for (const Triangle &t : triangles)
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) whole.push_back(t);
  for_each_edge(sides_of(whole), [&](std::span<const Side> sides) {
    if (sides.size() == 1) ++findings.boundary_edges;
    if (sides.size() > 2) ++findings.non_manifold_edges;
    if (sides.size() == 2 && sides[0].upward == sides[1].upward) ++findings.misoriented_edges;
  });
}

Vector doubled_area(const std::vector<Vec3> &vertices, const Triangle &t)
{
  const Vector a = vector_of(vertices[t[0]]);
  return (vector_of(vertices[t[1]]) - a).cross(vector_of(vertices[t[2]]) - a);
}

Vector side_of(const std::vector<Vec3> &vertices, const Triangle &t, size_t corner)
{
  return vector_of(vertices[t[(corner + 1) % 3]]) - vector_of(vertices[t[corner]]);
}

/* The sine of the angle at a corner. */
double sine_at(const std::vector<Vec3> &vertices, const Triangle &t, size_t corner)
{
  const double sides = side_of(vertices, t, corner).norm() * side_of(vertices, t, (corner + 2) % 3).norm();
  return sides > 0 ? doubled_area(vertices, t).norm() / sides : 0;
}

/* The corner opposite the longest side, at which the two sides determine the plane of a thin triangle best. */
size_t widest_corner(const std::vector<Vec3> &vertices, const Triangle &t)
{
  size_t longest = 0;
  for (size_t side = 1; side < 3; ++side)
    if (side_of(vertices, t, side).norm() > side_of(vertices, t, longest).norm()) longest = side;
  return (longest + 2) % 3;
}

/* Kernels divide by the length of the doubled area, whose square must be a normal float. */
bool is_degenerate(const std::vector<Vec3> &vertices, const Triangle &t)
{
  return doubled_area(vertices, t).squared_norm() < double(std::numeric_limits<float>::min()) ||
         sine_at(vertices, t, widest_corner(vertices, t)) <= degenerate_sine;
}

void begin_with_plain_corner(const std::vector<Vec3> &vertices, Triangle &t)
{
  if (sine_at(vertices, t, 0) < plain_sine)
    std::rotate(t.begin(), t.begin() + ptrdiff_t(widest_corner(vertices, t)), t.end());
}

Triangle smallest_first(Triangle t)
{
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/* The triangles without those that have the same corners in the same sense as an earlier one. */
std::vector<Triangle> without_duplicates(const std::vector<Triangle> &triangles)
{
  std::vector<std::pair<Triangle, uint32_t>> sorted;
  for (uint32_t i = 0; i < triangles.size(); ++i) sorted.emplace_back(smallest_first(triangles[i]), i);
  std::sort(sorted.begin(), sorted.end());
  std::vector<char> repeated(triangles.size());
  for (size_t i = 1; i < sorted.size(); ++i) repeated[sorted[i].second] = sorted[i].first == sorted[i - 1].first;
  std::vector<Triangle> result;
  for (size_t i = 0; i < triangles.size(); ++i)
    if (!repeated[i]) result.push_back(triangles[i]);
  return result;
}

void drop_unused_vertices(TriangleMesh &mesh)
{
  std::vector<uint32_t> place(mesh.vertices.size(), 0);
  for (const Triangle &t : mesh.triangles)
    for (uint32_t corner : t) place[corner] = 1;
  std::vector<Vec3> used;
  for (size_t i = 0; i < place.size(); ++i)
    if (place[i]) {
      place[i] = uint32_t(used.size());
      used.push_back(mesh.vertices[i]);
    }
  for (Triangle &t : mesh.triangles)
    for (uint32_t &corner : t) corner = place[corner];
  mesh.findings.unused_vertices = uint32_t(mesh.vertices.size() - used.size());
  mesh.vertices = std::move(used);
}

/* How the right triangle bends away from the left one: an edge is convex if the right one lies below the plane of the
 * left. */
EdgeKind kind_of(const Vector &left_normal, const Vector &right_normal, const Vector &along)
{
  const double bend = left_normal.cross(right_normal).dot(along); /* the sine, positive where the surface is convex */
  if (std::abs(bend) <= flat_edge_sine && left_normal.dot(right_normal) > 0) return EdgeKind::flat;
  return bend >= 0 ? EdgeKind::convex : EdgeKind::concave;
}

void add_shared_edge(TriangleMesh &mesh, const Side &left, const Side &right)
{
  const Vector left_normal = doubled_area(mesh.vertices, mesh.triangles[left.triangle]).normalized();
  const Vector right_normal = doubled_area(mesh.vertices, mesh.triangles[right.triangle]).normalized();
  const Vector along = (vector_of(mesh.vertices[left.high]) - vector_of(mesh.vertices[left.low])).normalized();
  mesh.neighbours[left.triangle][left.corner] = right.triangle;
  mesh.neighbours[right.triangle][right.corner] = left.triangle;
  mesh.triangle_edges[left.triangle][left.corner] = mesh.triangle_edges[right.triangle][right.corner] =
      uint32_t(mesh.edges.size());
  mesh.edges.push_back({left.low, left.high, left.triangle, right.triangle, kind_of(left_normal, right_normal, along),
                        std::clamp(left_normal.dot(right_normal), -1.0, 1.0)});
}

void add_boundary(TriangleMesh &mesh, const Side &side)
{
  mesh.triangle_edges[side.triangle][side.corner] = uint32_t(mesh.edges.size());
  mesh.edges.push_back({side.low, side.high, side.upward ? side.triangle : no_triangle,
                        side.upward ? no_triangle : side.triangle, EdgeKind::boundary, 1.0});
}

void find_adjacency(TriangleMesh &mesh)
{
  mesh.neighbours.assign(mesh.triangles.size(), {no_triangle, no_triangle, no_triangle});
  mesh.triangle_edges.assign(mesh.triangles.size(), {});
  for_each_edge(sides_of(mesh.triangles), [&](std::span<const Side> sides) {
    if (sides.size() == 2 && sides[0].upward != sides[1].upward)
      add_shared_edge(mesh, sides[1], sides[0]); /* downward sorts first */
    else
      for (const Side &side : sides) add_boundary(mesh, side);
  });
}

/* Takes the plane through the first vertex, the one farthest from it, and the one farthest from the line of both. */
bool is_flat_mesh(const std::vector<Vec3> &vertices)
{
  Vector across, along;
  const Vector a = vector_of(vertices[0]);
  const auto longer = [](const Vector &p, const Vector &q) { return p.squared_norm() > q.squared_norm() ? p : q; };
  for (const Vec3 &v : vertices) along = longer(vector_of(v) - a, along);
  for (const Vec3 &v : vertices) across = longer(along.cross(vector_of(v) - a), across);
  double height = 0;
  for (const Vec3 &v : vertices) height = std::max(height, std::abs(across.normalized().dot(vector_of(v) - a)));
  return height <= hull_tolerance_of(vertices);
}

void check_indices(size_t vertices, std::span<const Triangle> triangles, const std::string &where)
{
  if (triangles.empty()) throw InputError(fmt::format("{}: a mesh needs at least one triangle", where));
  for (size_t t = 0; t < triangles.size(); ++t)
    for (uint32_t index : triangles[t])
      if (index >= vertices)
        throw InputError(fmt::format("{}: triangle {} names vertex {}, but there are {} (0 is the first)", where, t,
                                     index, vertices));
}

} // namespace

TriangleMesh triangle_mesh(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                           const std::string &where)
{
  require_within_reach(vertices, "vertex", where);
  check_indices(vertices.size(), triangles, where);
  DistinctPoints welded = distinct(vertices);
  TriangleMesh mesh;
  for (const Triangle &t : triangles)
    mesh.triangles.push_back({welded.index[t[0]], welded.index[t[1]], welded.index[t[2]]});
  mesh.vertices = std::move(welded.points);
  mesh.findings.welded_vertices = uint32_t(vertices.size() - mesh.vertices.size());
  mesh.triangles = without_duplicates(mesh.triangles);
  mesh.findings.duplicate_triangles = uint32_t(triangles.size() - mesh.triangles.size());
  count_edges(mesh.triangles, mesh.findings);
  mesh.findings.degenerate_triangles =
      uint32_t(std::erase_if(mesh.triangles, [&](const Triangle &t) { return is_degenerate(mesh.vertices, t); }));
  if (mesh.triangles.empty())
    throw InputError(
        fmt::format("{}: all {} triangles of the mesh have no area that floats can tell", where, triangles.size()));
  for (Triangle &t : mesh.triangles) begin_with_plain_corner(mesh.vertices, t);
  drop_unused_vertices(mesh);
  find_adjacency(mesh);
  mesh.flat = is_flat_mesh(mesh.vertices);
  return mesh;
}

TriangleMesh triangle_mesh(std::span<const Vec3> vertices, std::span<const uint32_t> indices, const std::string &where)
{
  if (indices.size() % 3 != 0)
    throw InputError(fmt::format("{}: {} indices are no whole number of triangles", where, indices.size()));
  std::vector<Triangle> triangles;
  for (size_t i = 0; i < indices.size(); i += 3) triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  return triangle_mesh(vertices, triangles, where);
}

std::string volume_warning(const TriangleMesh &mesh)
{
  const MeshFindings &found = mesh.findings;
  if (found.boundary_edges > 0)
    return fmt::format(
        "open mesh: {} boundary edges; its mass is that of the mesh closed by cones to the centre of its vertices",
        found.boundary_edges);
  if (found.misoriented_edges > 0)
    return fmt::format(
        "badly wound mesh: {} edges whose triangles face opposite ways; its volume counts some parts as hollow",
        found.misoriented_edges);
  if (found.non_manifold_edges > 0)
    return fmt::format("branching mesh: {} edges of more than two triangles; its volume counts where it overlaps twice",
                       found.non_manifold_edges);
  return "";
}

std::string cleaning_note(const TriangleMesh &mesh)
{
  const MeshFindings &found = mesh.findings;
  if (found.welded_vertices + found.unused_vertices + found.duplicate_triangles + found.degenerate_triangles == 0)
    return "";
  return fmt::format("mesh: {} repeated and {} unused vertices, {} repeated triangles and {} without area left out",
                     found.welded_vertices, found.unused_vertices, found.duplicate_triangles,
                     found.degenerate_triangles);
}

std::vector<Triangle> turned_round(std::span<const Triangle> triangles)
{
  std::vector<Triangle> result(triangles.begin(), triangles.end());
  for (Triangle &t : result) std::swap(t[1], t[2]);
  return result;
}

std::vector<AxisAlignedBox> triangle_bounds(const TriangleMesh &mesh)
{
  std::vector<AxisAlignedBox> result;
  for (const Triangle &t : mesh.triangles) {
    const Vec3 corners[] = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    result.push_back(bounds_of(corners));
  }
  return result;
}

} // namespace tandem
