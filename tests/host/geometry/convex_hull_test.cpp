/* convex_hull_test.cpp - hulls are closed, convex and contain their points; known solids have their faces; nonsense is
 * refused. */
#include <limits>
#include <set>

#include "host/geometry/convex_hull.h"
#include "tests/catch.h"
#include "tests/host/geometry/shapes.h"

using namespace tandem;
using namespace tandem::geometry_test;
using Catch::Matchers::ContainsSubstring;

namespace {

double height_over(const HullPlane &plane, const Vec3 &p)
{
  return vector_of(plane.normal).dot(vector_of(p)) - plane.distance;
}

/* Each edge lies between the two faces it names, in the sense it names, and each side of a face is an edge. */
void check_edges(const ConvexHull &hull)
{
  std::set<std::array<uint32_t, 3>> sides;
  for (uint32_t face = 0; face < hull.faces.size(); ++face)
    for (size_t i = 0; i < hull.faces[face].size(); ++i)
      sides.insert({hull.faces[face][i], hull.faces[face][(i + 1) % hull.faces[face].size()], face});
  REQUIRE(sides.size() == 2 * hull.edges.size());
  for (size_t i = 0; i < hull.edges.size(); ++i) {
    const HullEdge &edge = hull.edges[i];
    REQUIRE(edge.v0 < edge.v1);
    REQUIRE(sides.contains({edge.v0, edge.v1, edge.face_left}));
    REQUIRE(sides.contains({edge.v1, edge.v0, edge.face_right}));
    if (i > 0) REQUIRE(std::pair(hull.edges[i - 1].v0, hull.edges[i - 1].v1) < std::pair(edge.v0, edge.v1));
  }
}

/* Returns how far a corner of the face lies behind the line of its neighbours; 0 for a convex polygon. */
double dent(const ConvexHull &hull, uint32_t face)
{
  const std::vector<uint32_t> &polygon = hull.faces[face];
  double deepest = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vector before = vector_of(hull.vertices[polygon[i]]),
                 at = vector_of(hull.vertices[polygon[(i + 1) % polygon.size()]]);
    const Vector after = vector_of(hull.vertices[polygon[(i + 2) % polygon.size()]]);
    deepest = std::max(deepest, -(at - before).cross(after - at).dot(vector_of(hull.planes[face].normal)) /
                                    (after - before).norm());
  }
  return deepest;
}

void check_faces(const ConvexHull &hull)
{
  std::vector<int> faces_at(hull.vertices.size());
  for (uint32_t face = 0; face < hull.faces.size(); ++face) {
    REQUIRE(hull.faces[face].size() >= 3);
    REQUIRE(*std::min_element(hull.faces[face].begin(), hull.faces[face].end()) == hull.faces[face][0]);
    for (uint32_t corner : hull.faces[face]) {
      ++faces_at.at(corner);
      REQUIRE(height_over(hull.planes[face], hull.vertices[corner]) >= -3 * hull.tolerance);
    }
    REQUIRE(dent(hull, face) <= hull.tolerance * 1.01);
  }
  for (int count : faces_at) REQUIRE(count >= 3);
}

void check_planes(const ConvexHull &hull, const std::vector<Vec3> &points)
{
  double largest = 0;
  for (const Vec3 &v : hull.vertices) largest = std::max(largest, vector_of(v).norm());
  for (const HullPlane &plane : hull.planes) {
    REQUIRE(std::abs(vector_of(plane.normal).norm() - 1) < 1e-14);
    double highest = -std::numeric_limits<double>::infinity();
    for (const Vec3 &v : hull.vertices) highest = std::max(highest, height_over(plane, v));
    REQUIRE(std::abs(highest) <= 4e-16 * largest); /* all vertices satisfy it to rounding, and one touches it */
    for (const Vec3 &p : points) REQUIRE(height_over(plane, p) <= 4 * hull.tolerance);
    REQUIRE(height_over(plane, {float(hull.centroid[0]), float(hull.centroid[1]), float(hull.centroid[2])}) < 0);
  }
}

/* All that is promised of any hull. */
ConvexHull checked_hull(const std::vector<Vec3> &points)
{
  const ConvexHull hull = convex_hull(points, "test");
  REQUIRE(hull.planes.size() == hull.faces.size());
  REQUIRE(hull.vertices.size() + hull.faces.size() == hull.edges.size() + 2);
  size_t from = 0; /* vertices are given points, in their order */
  for (const Vec3 &v : hull.vertices) {
    const auto found = std::find(points.begin() + ptrdiff_t(from), points.end(), v);
    REQUIRE(found != points.end());
    from = size_t(found - points.begin());
  }
  check_edges(hull);
  check_faces(hull);
  check_planes(hull, points);
  return hull;
}

std::array<size_t, 3> sizes(const ConvexHull &hull)
{
  return {hull.vertices.size(), hull.edges.size(), hull.faces.size()};
}

using Sizes = std::array<size_t, 3>;

std::string refusal_of_points(const std::vector<Vec3> &points)
{
  return complaint([&] { convex_hull(points, "rock.obj"); });
}

} // namespace

TEST_CASE("convex hull: regular solids have their vertices, edges and faces", "[address]")
{
  CHECK(sizes(checked_hull(box_corners(1, 2, 3))) == Sizes{8, 12, 6});
  CHECK(sizes(checked_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})) == Sizes{4, 6, 4});
  CHECK(sizes(checked_hull(icosahedron_points())) == Sizes{12, 30, 20});
}

TEST_CASE(
    "convex hull: faces of a box are counter-clockwise from outside, start at their smallest vertex, and are sorted")
{
  const ConvexHull hull = checked_hull(box_corners(1, 2, 3));
  const std::vector<std::vector<uint32_t>> expected{{0, 1, 5, 4}, {0, 2, 3, 1}, {0, 4, 6, 2},
                                                    {1, 3, 7, 5}, {2, 6, 7, 3}, {4, 5, 7, 6}};
  CHECK(hull.faces == expected);
  const std::vector<Double3> normals{{0, -1, 0}, {0, 0, -1}, {-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double distances[] = {2, 3, 1, 1, 2, 3};
  for (size_t face = 0; face < 6; ++face) {
    CHECK(hull.planes[face].normal == normals[face]);
    CHECK(hull.planes[face].distance == distances[face]);
  }
  CHECK(hull.edges.front() == HullEdge{0, 1, 0, 1});
  CHECK(vector_of(hull.centroid).norm() < 1e-15);
  CHECK(radius_about(hull, {1, 2, 3}) == Approx(2 * std::sqrt(14.0)));
}

TEST_CASE("convex hull: a round prism has one face a cap, however it is turned", "[address]")
{
  const std::vector<Vec3> prism = prism_points(64);
  Random random(3);
  for (int turn = 0; turn < 20; ++turn) {
    const Eigen::Quaterniond rotation = turn == 0 ? Eigen::Quaterniond::Identity() : random_rotation(random);
    const ConvexHull hull = checked_hull(moved(prism, rotation, {0, 0, 0}));
    CHECK(sizes(hull) == Sizes{128, 192, 66});
    CHECK(std::count_if(hull.faces.begin(), hull.faces.end(), [](const auto &face) { return face.size() == 64; }) == 2);
  }
}

TEST_CASE("convex hull: points on a sphere are all vertices, and nearly all faces are triangles")
{
  const ConvexHull hull = checked_hull(sphere_points(1000, 1));
  CHECK(hull.vertices.size() == 1000);
  CHECK(hull.faces.size() > 1950);
  CHECK(hull.faces.size() <= 2 * 1000 - 4);
}

TEST_CASE("convex hull: points inside, on faces and on edges are no vertices, although roundings put some outside",
          "[address]")
{
  std::vector<Vec3> grid;
  for (int x = -5; x <= 5; ++x)
    for (int y = -5; y <= 5; ++y)
      for (int z = -5; z <= 5; ++z) grid.push_back({float(x) / 5, float(y) / 5, float(z) / 5});
  CHECK(sizes(checked_hull(grid)) == Sizes{8, 12, 6});
  Random random(5);
  for (int turn = 0; turn < 20; ++turn)
    CHECK(sizes(checked_hull(moved(grid, random_rotation(random), {0.1, 0.2, 0.3}))) == Sizes{8, 12, 6});
}

TEST_CASE("convex hull: repeated points and zeros of either sign are one vertex")
{
  std::vector<Vec3> points{{0, 0, 0}, {-0.0f, 0, -0.0f}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, -0.0f, 1}};
  CHECK(sizes(checked_hull(points)) == Sizes{4, 6, 4});
}

TEST_CASE("convex hull: flat and long hulls keep their thickness")
{
  CHECK(sizes(checked_hull(box_corners(1, 1e-4f, 1))) == Sizes{8, 12, 6});
  CHECK(sizes(checked_hull(box_corners(1e-4f, 1, 1e-4f))) == Sizes{8, 12, 6});
  std::vector<Vec3> lens = sphere_points(300, 9);
  for (Vec3 &p : lens) p[1] *= 1e-4f;
  const ConvexHull hull = checked_hull(lens);
  CHECK(hull.faces.size() > 100);
  Random random(6);
  for (int turn = 0; turn < 20; ++turn)
    CHECK(sizes(checked_hull(moved(box_corners(1, 1e-4f, 1), random_rotation(random), {0, 0, 0}))) == Sizes{8, 12, 6});
}

TEST_CASE("convex hull: hulls hardly thicker than the tolerance lose no point by more than is promised")
{
  Random random(13);
  for (int turn = 0; turn < 60; ++turn) {
    const double thickness = std::pow(10.0, random.uniform(-5.5, -4));
    std::vector<Vec3> points;
    for (int i = 0; i < 150; ++i)
      points.push_back(
          {float(random.uniform(-1, 1)), float(random.uniform(-thickness, thickness)), float(random.uniform(-1, 1))});
    INFO(turn);
    checked_hull(points);
  }
}

TEST_CASE("convex hull: where a round surface is flat within the tolerance, joined faces stay convex and flat",
          "[address]")
{
  for (double distance : {1000.0, 3000.0, 10000.0, 30000.0}) {
    const ConvexHull hull =
        checked_hull(moved(sphere_points(1000, 6), Eigen::Quaterniond::Identity(), {distance, 0, 0}));
    CHECK(hull.faces.size() < 1950);
  }
}

TEST_CASE("convex hull: far from the origin, roundings of the coordinates make no faces")
{
  Random random(7);
  for (double distance : {1e2, 1e4, 1e5})
    for (int turn = 0; turn < 10; ++turn)
      CHECK(sizes(checked_hull(moved(box_corners(1, 1, 1), random_rotation(random),
                                     Vector(1, -0.7, 0.3) * distance))) == Sizes{8, 12, 6});
}

TEST_CASE("convex hull: the same at every size, to the bit for powers of two", "[address]")
{
  const std::vector<Vec3> points = sphere_points(200, 2);
  const ConvexHull hull = checked_hull(points);
  for (float factor : {0x1p-40f, 0x1p-10f, 0x1p20f, 0x1p60f}) {
    const ConvexHull other = convex_hull(scaled(points, {factor, factor, factor}, "test"), "test");
    CHECK(other.faces == hull.faces);
    for (size_t i = 0; i < hull.planes.size(); ++i)
      CHECK(other.planes[i].distance == hull.planes[i].distance * double(factor));
  }
  for (float factor : {1e-3f, 1e6f})
    CHECK(sizes(checked_hull(scaled(prism_points(64), {factor, factor, factor}, "test"))) == Sizes{128, 192, 66});
}

TEST_CASE("convex hull: mirrored points give the mirrored hull, still seen from outside")
{
  const std::vector<Vec3> points = sphere_points(100, 4);
  const ConvexHull hull = checked_hull(points), mirror = checked_hull(scaled(points, {-1, 1, 1}, "test"));
  CHECK(sizes(mirror) == sizes(hull));
  CHECK(mirror.centroid[0] == Approx(-hull.centroid[0]));
  CHECK(mirror.centroid[1] == Approx(hull.centroid[1]));
  CHECK_THAT(complaint([&] { scaled(points, {1, 0, 1}, "a.json"); }), ContainsSubstring("a.json: scale is [1, 0, 1]"));
}

TEST_CASE("convex hull: the order of the points changes nothing but the names of the vertices")
{
  std::vector<Vec3> points = sphere_points(300, 11);
  const ConvexHull hull = checked_hull(points);
  std::reverse(points.begin(), points.end());
  const ConvexHull other = checked_hull(points);
  const auto named = [](const ConvexHull &h) {
    std::set<std::set<Vec3>> faces;
    for (const auto &face : h.faces) {
      std::set<Vec3> corners;
      for (uint32_t corner : face) corners.insert(h.vertices[corner]);
      faces.insert(corners);
    }
    return faces;
  };
  CHECK(named(hull) == named(other));
}

TEST_CASE("convex hull: moved to its centroid, planes follow the rounded vertices")
{
  const ConvexHull hull =
      checked_hull(moved(prism_points(24), Eigen::Quaterniond(1, 2, 3, 4).normalized(), {20, 30, 40}));
  const Double3 &c = hull.centroid;
  const ConvexHull centered = translated(hull, {-c[0], -c[1], -c[2]});
  CHECK(centered.faces == hull.faces);
  CHECK(vector_of(centered.centroid).norm() < 1e-6);
  check_planes(centered, centered.vertices);
}

TEST_CASE("convex hull: any cloud of points gives a closed convex surface", "[address]")
{
  Random random(8);
  for (int turn = 0; turn < 300; ++turn) {
    std::vector<Vec3> points;
    const uint32_t count = 4 + random.below(60), grain = 1 + random.below(30);
    for (uint32_t i = 0; i < count; ++i) {
      Vec3 p;
      for (float &x : p)
        x = turn % 2 ? float(random.uniform(-1, 1))
                     : float(int(random.below(2 * grain + 1)) - int(grain)) / float(grain);
      points.push_back(p);
    }
    points.insert(points.end(), {{-2, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}); /* never flat */
    const std::vector<Vec3> placed = turn % 3 ? moved(points, random_rotation(random), {0, 0, 0}) : points;
    INFO(turn);
    checked_hull(placed);
  }
}

TEST_CASE("convex hull: what has no hull is refused by name")
{
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  CHECK_THAT(refusal_of_points({}), ContainsSubstring("rock.obj: a hull needs four different points, not 0"));
  CHECK_THAT(refusal_of_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), ContainsSubstring("not 3"));
  CHECK_THAT(refusal_of_points({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), ContainsSubstring("not 1"));
  CHECK_THAT(refusal_of_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, nan, 1}}),
             ContainsSubstring("rock.obj: point 3 is [0, nan, 1]"));
  CHECK_THAT(refusal_of_points({{0, 0, 0}, {1, 0, infinity}, {0, 1, 0}, {0, 0, 1}}), ContainsSubstring("point 1"));
  CHECK_THAT(refusal_of_points({{1, 1, 1}, {1, 1, 1 + 0x1p-23f}, {1, 1 + 0x1p-23f, 1}, {1 + 0x1p-23f, 1, 1}}),
             ContainsSubstring("4 points lie in one place"));
  std::vector<Vec3> line, plane;
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    const float t = float(random.uniform()), s = float(random.uniform());
    line.push_back({t, 2 * t, -t});
    plane.push_back({t, s, 0.3f * t - 0.7f * s});
  }
  CHECK_THAT(refusal_of_points(line), ContainsSubstring("all 40 points lie in a line"));
  CHECK_THAT(refusal_of_points(plane), ContainsSubstring("all 40 points lie in a plane"));
}
