/* face_merger_test.cpp - merged faces are flat and convex within the tolerance, and open surfaces are recognised. */
#include "host/geometry/face_merger.h"
#include "tests/catch.h"
#include "tests/host/geometry/shapes.h"

using namespace tandem;
using namespace tandem::geometry_test;

namespace {

/* A shallow pyramid: a base of `sides` corners on the unit circle, and an apex above, counter-clockwise seen from
 * outside. */
std::vector<Vector> pyramid_points(int sides, double height)
{
  std::vector<Vector> points;
  for (int i = 0; i < sides; ++i)
    points.emplace_back(std::cos(2 * std::numbers::pi * i / sides), 0, -std::sin(2 * std::numbers::pi * i / sides));
  points.emplace_back(0, height, 0);
  return points;
}

std::vector<Polygon> pyramid_faces(uint32_t sides)
{
  std::vector<Polygon> faces{{}};
  for (uint32_t i = 0; i < sides; ++i) {
    faces[0].insert(faces[0].begin(), i);
    faces.push_back({i, (i + 1) % sides, sides});
  }
  return faces;
}

double deepest_dent(const std::vector<Vector> &points, const Polygon &face)
{
  const Vector normal = newell_normal(points, face).normalized();
  double deepest = 0;
  for (size_t i = 0; i < face.size(); ++i) {
    const Vector &before = points[face[i]], &at = points[face[(i + 1) % face.size()]],
                 &after = points[face[(i + 2) % face.size()]];
    deepest = std::max(deepest, -(at - before).cross(after - at).dot(normal) / (after - before).norm());
  }
  return deepest;
}

} // namespace

TEST_CASE("face merger: sides of a shallow pyramid are joined as far as the polygon stays flat and convex",
          "[sanitizer]")
{
  const double tolerance = 0.01;
  size_t fewest = 100, most = 0;
  for (double height = 0.25 * tolerance; height < 10 * tolerance; height *= 1.1) {
    const std::vector<Vector> points = pyramid_points(7, height);
    const std::vector<Polygon> faces = merged_faces(points, pyramid_faces(7), tolerance);
    for (const Polygon &face : faces) CHECK(deepest_dent(points, face) <= tolerance);
    fewest = std::min(fewest, faces.size());
    most = std::max(most, faces.size());
  }
  CHECK(fewest <= 4); /* seven sides about the apex in no more than three convex pieces */
  CHECK(most == 8);
}

TEST_CASE("face merger: triangles of a box become its sides, triangles of an icosahedron stay")
{
  std::vector<Vector> box, icosahedron;
  for (const Vec3 &p : box_corners(1, 2, 3)) box.push_back(vector_of(p));
  for (const Vec3 &p : icosahedron_points()) icosahedron.push_back(vector_of(p));
  const auto polygons = [](const std::vector<Triangle> &triangles) {
    std::vector<Polygon> result;
    for (const Triangle &t : triangles) result.push_back({t[0], t[1], t[2]});
    return result;
  };
  CHECK(merged_faces(box, polygons(box_triangles()), 1e-9).size() == 6);
  CHECK(merged_faces(icosahedron, polygons(icosahedron_triangles()), 1e-9).size() == 20);
}

TEST_CASE("face merger: a surface is closed if each edge has a face on both sides, and it has no handles")
{
  const std::vector<Polygon> pyramid = pyramid_faces(5);
  CHECK(is_closed_surface(pyramid));
  std::vector<Polygon> open(pyramid.begin() + 1, pyramid.end()), flipped = pyramid, twice = pyramid,
                                                                 collapsed = pyramid;
  CHECK_FALSE(is_closed_surface(open));
  std::swap(flipped[2][0], flipped[2][1]);
  CHECK_FALSE(is_closed_surface(flipped));
  twice.push_back(pyramid[1]);
  CHECK_FALSE(is_closed_surface(twice));
  collapsed[1].pop_back();
  CHECK_FALSE(is_closed_surface(collapsed));
  std::vector<Polygon> two = pyramid; /* apart from each other: V - E + F is 4 */
  for (Polygon face : pyramid) {
    for (uint32_t &corner : face) corner += 6;
    two.push_back(face);
  }
  CHECK_FALSE(is_closed_surface(two));
}
