/* quickhull_test.cpp - hulls computed in integers are closed and exactly convex, and do not depend on the order of the
 * points. */
#include <algorithm>
#include <set>

#include "host/base/random.h"
#include "host/geometry/face_merger.h"
#include "host/geometry/quickhull.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

std::vector<Vector> random_points(Random &random, int count, int grain)
{
  std::vector<Vector> points;
  for (int i = 0; i < count; ++i) {
    const auto draw = [&] { return (random.below(uint32_t(grain) + 1) - 0.5 * grain) / grain; };
    const double x = draw(), y = draw(), z = draw();
    points.push_back(on_hull_grid({x, y, z}));
  }
  return points;
}

/* Six times the volume between a triangle and a point: exact in 113 bits, as coordinates have 30 at most. */
__extension__ typedef __float128 Exact;
Exact height(const std::vector<Vector> &points, const Polygon &t, const Vector &p)
{
  const Vector &a = points[t[0]], u = points[t[1]] - a, v = points[t[2]] - a, w = p - a;
  return (Exact(u.y) * v.z - Exact(u.z) * v.y) * w.x + (Exact(u.z) * v.x - Exact(u.x) * v.z) * w.y +
         (Exact(u.x) * v.y - Exact(u.y) * v.x) * w.z;
}

/* The faces with those in one plane joined, by their corners: what no order of points may change. */
std::set<std::set<std::array<double, 3>>> faces_by_place(const std::vector<Vector> &points, double tolerance)
{
  std::set<std::set<std::array<double, 3>>> faces;
  for (const Polygon &face : merged_faces(points, hull_triangles(points, 0), tolerance)) {
    std::set<std::array<double, 3>> corners;
    for (const uint32_t corner : face) corners.insert(array_of(points[corner]));
    faces.insert(corners);
  }
  return faces;
}

} // namespace

TEST_CASE("quickhull: every surface is closed, and no point lies above a face, by exact numbers", "[address]")
{
  Random random(1);
  int surfaces = 0;
  for (int turn = 0; turn < 300; ++turn) {
    const int grains[] = {1 << 30, 1, 2, 4, 16};
    const std::vector<Vector> points = random_points(random, 4 + int(random.below(60)), grains[turn % 5]);
    const std::vector<Polygon> faces = hull_triangles(points, 0);
    CAPTURE(turn, points.size());
    if (faces.empty()) continue; /* of a coarse grid, some lie in a plane */
    ++surfaces;
    REQUIRE(is_closed_surface(faces));
    for (const Polygon &face : faces)
      for (const Vector &p : points) REQUIRE(height(points, face, p) <= 0);
  }
  CHECK(surfaces > 250);
}

TEST_CASE("quickhull: points in a plane, a line or a place have no hull", "[address]")
{
  Random random(2);
  std::vector<Vector> plane, line, place;
  for (int i = 0; i < 30; ++i) {
    const double x = random.below(64) / 128.0, y = random.below(64) / 128.0;
    plane.push_back({x, y, (x + y) / 2});
    line.push_back({x, x / 2, -x});
    place.push_back({0.25, 0.25, 0.25});
  }
  CHECK(hull_triangles(plane, 0).empty());
  CHECK(hull_triangles(line, 0).empty());
  CHECK(hull_triangles(place, 0).empty());
  CHECK(hull_triangles({}, 0).empty());
  plane.push_back({0, 0, hull_grid}); /* the least that can be told apart */
  CHECK_FALSE(hull_triangles(plane, 0).empty());
}

TEST_CASE("quickhull: within a tolerance, points little above a face are no corners, and others are", "[address]")
{
  std::vector<Vector> points;
  for (int i = 0; i < 8; ++i) points.push_back({i & 1 ? 0.4 : -0.4, i & 2 ? 0.4 : -0.4, i & 4 ? 0.4 : -0.4});
  points.push_back({0, 0, 0.4 + 0.9e-6});
  CHECK(hull_triangles(points, 1e-6).size() == 12);
  CHECK(hull_triangles(points, 0).size() == 14);
  points.back().z = 0.4 + 2e-6; /* more than the root of two, since faces on the way are steeper */
  CHECK(hull_triangles(points, 1e-6).size() == 14);
}

TEST_CASE("quickhull: the order of the points changes no face", "[address]")
{
  Random random(3);
  for (int turn = 0; turn < 50; ++turn) {
    std::vector<Vector> points = random_points(random, 40, 1 << 30);
    const auto faces = faces_by_place(points, 0);
    for (size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(uint32_t(i))]);
    CHECK(faces_by_place(points, 0) == faces);
  }
}

TEST_CASE("quickhull: as many faces as Euler's formula wants, for many points on a ball")
{
  Random random(4);
  std::vector<Vector> points;
  while (points.size() < 5000) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const Vector v(x, y, z);
    if (v.norm() > 0.1 && v.norm() < 1) points.push_back(on_hull_grid(v.normalized() * 0.5));
  }
  const std::vector<Polygon> faces = hull_triangles(points, 0);
  CHECK(faces.size() == 2 * points.size() - 4);
  CHECK(is_closed_surface(faces));
}
