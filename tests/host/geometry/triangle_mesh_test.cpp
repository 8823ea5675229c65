/* triangle_mesh_test.cpp - welding, adjacency, kinds of edges, and the messages about bad meshes. */
#include <limits>

#include "host/geometry/triangle_mesh.h"
#include "tests/catch.h"
#include "tests/host/geometry/shapes.h"

using namespace tandem;
using namespace tandem::geometry_test;
using Catch::Matchers::ContainsSubstring;

namespace {

/* Each neighbour names the triangle back, over the same edge run the other way, and `edges` agrees. */
void check_adjacency(const TriangleMesh &mesh)
{
  REQUIRE(mesh.neighbours.size() == mesh.triangles.size());
  REQUIRE(mesh.triangle_edges.size() == mesh.triangles.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (size_t corner = 0; corner < 3; ++corner) {
      const uint32_t from = mesh.triangles[t][corner], to = mesh.triangles[t][(corner + 1) % 3],
                     other = mesh.neighbours[t][corner];
      const MeshEdge &edge = mesh.edges.at(mesh.triangle_edges[t][corner]);
      REQUIRE(edge.v0 == std::min(from, to));
      REQUIRE(edge.v1 == std::max(from, to));
      REQUIRE((from < to ? edge.left : edge.right) == t);
      REQUIRE((from < to ? edge.right : edge.left) == other);
      REQUIRE((edge.kind == EdgeKind::boundary) == (other == no_triangle));
      if (other == no_triangle) continue;
      bool named_back = false;
      for (size_t k = 0; k < 3; ++k)
        named_back = named_back || (mesh.neighbours[other][k] == t && mesh.triangles[other][k] == to &&
                                    mesh.triangles[other][(k + 1) % 3] == from);
      REQUIRE(named_back);
    }
}

TriangleMesh checked_mesh(const std::vector<Vec3> &vertices, const std::vector<Triangle> &triangles)
{
  const TriangleMesh mesh = triangle_mesh(vertices, triangles, "test");
  check_adjacency(mesh);
  return mesh;
}

size_t count(const TriangleMesh &mesh, EdgeKind kind)
{
  return size_t(
      std::count_if(mesh.edges.begin(), mesh.edges.end(), [kind](const MeshEdge &edge) { return edge.kind == kind; }));
}

std::string refusal_of_mesh(const std::vector<Vec3> &vertices, const std::vector<Triangle> &triangles)
{
  return complaint([&] { triangle_mesh(vertices, triangles, "hall.glb"); });
}

const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};

/* Two triangles over the edge from 0 to 1 along x, the far corner of the second at this angle above (negative: below)
 * the plane of the first, whose normal is +y. */
TriangleMesh hinge(double angle)
{
  return checked_mesh({{0, 0, 0}, {1, 0, 0}, {0.5f, 0, 1}, {0.5f, float(std::sin(angle)), float(-std::cos(angle))}},
                      {{1, 0, 2}, {0, 1, 3}});
}

} // namespace

TEST_CASE("triangle mesh: a box has twelve convex right angles and six flat diagonals", "[sanitizer]")
{
  const TriangleMesh mesh = checked_mesh(box_corners(1, 2, 3), box_triangles());
  CHECK(mesh.edges.size() == 18);
  CHECK(count(mesh, EdgeKind::convex) == 12);
  CHECK(count(mesh, EdgeKind::flat) == 6);
  for (const MeshEdge &edge : mesh.edges)
    CHECK(edge.cosine == Approx(edge.kind == EdgeKind::flat ? 1 : 0).margin(1e-15));
  CHECK_FALSE(mesh.flat);
  CHECK(volume_warning(mesh).empty());
  CHECK(cleaning_note(mesh).empty());
}

TEST_CASE("triangle mesh: turned round, what was convex is concave")
{
  const TriangleMesh mesh = checked_mesh(box_corners(1, 2, 3), turned_round(box_triangles()));
  CHECK(count(mesh, EdgeKind::concave) == 12);
  CHECK(count(mesh, EdgeKind::flat) == 6);
  const std::vector<Vec3> mirrored = scaled(box_corners(1, 2, 3), {1, -1, 1}, "test");
  CHECK(count(checked_mesh(mirrored, turned_round(box_triangles())), EdgeKind::convex) == 12);
}

TEST_CASE("triangle mesh: the angle of an edge decides its kind and its cosine")
{
  for (double angle : {-3.0, -2.0, -1.0, -0.01, -0.0005, 0.0, 0.0005, 0.01, 1.0, 2.0, 3.0}) {
    const TriangleMesh mesh = hinge(angle);
    const auto shared = std::find_if(mesh.edges.begin(), mesh.edges.end(),
                                     [](const MeshEdge &edge) { return edge.kind != EdgeKind::boundary; });
    REQUIRE(shared != mesh.edges.end());
    INFO(angle);
    CHECK(shared->kind == (std::abs(angle) < flat_edge_sine ? EdgeKind::flat
                           : angle < 0                      ? EdgeKind::convex
                                                            : EdgeKind::concave));
    CHECK(shared->cosine == Approx(std::cos(angle)).margin(1e-6));
  }
}

TEST_CASE("triangle mesh: repeated vertices are welded, unused ones left out, the order stays", "[sanitizer]")
{
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (const Triangle &t : box_triangles()) {
    triangles.push_back({uint32_t(vertices.size()), uint32_t(vertices.size()) + 1, uint32_t(vertices.size()) + 2});
    for (uint32_t corner : t) vertices.push_back(box_corners(1, 1, 1)[corner]);
  }
  vertices.push_back({9, 9, 9});
  const TriangleMesh mesh = checked_mesh(vertices, triangles);
  CHECK(mesh.vertices.size() == 8);
  CHECK(mesh.findings.welded_vertices == 28);
  CHECK(mesh.findings.unused_vertices == 1);
  CHECK(mesh.vertices[0] == vertices[0]);
  CHECK(count(mesh, EdgeKind::boundary) == 0);
  CHECK_THAT(cleaning_note(mesh), ContainsSubstring("28 repeated and 1 unused vertices"));
}

TEST_CASE("triangle mesh: zeros of either sign are one coordinate")
{
  std::vector<Vec3> vertices = square;
  vertices.push_back({-0.0f, 0, -0.0f});
  const TriangleMesh mesh = checked_mesh(vertices, {{0, 2, 1}, {4, 3, 2}});
  CHECK(mesh.vertices.size() == 4);
  CHECK(count(mesh, EdgeKind::flat) == 1);
}

TEST_CASE("triangle mesh: repeated triangles count once, opposite ones stay")
{
  const TriangleMesh repeated = checked_mesh(square, {{0, 2, 1}, {2, 1, 0}, {0, 3, 2}});
  CHECK(repeated.triangles == std::vector<Triangle>{{0, 2, 1}, {0, 3, 2}});
  CHECK(repeated.findings.duplicate_triangles == 1);
  const TriangleMesh two_sided = checked_mesh(square, {{0, 2, 1}, {0, 1, 2}});
  CHECK(two_sided.triangles.size() == 2);
  CHECK(count(two_sided, EdgeKind::convex) == 3);
  for (const MeshEdge &edge : two_sided.edges) CHECK(edge.cosine == Approx(-1));
}

TEST_CASE("triangle mesh: triangles without area are left out, and those that closed a gap leave the mesh closed")
{
  std::vector<Vec3> vertices = box_corners(1, 1, 1);
  vertices.push_back({0, -1, -1}); /* in the middle of the edge 0-1 */
  std::vector<Triangle> triangles = box_triangles();
  triangles[0] = {0, 2, 8}; /* 0 2 1 cut in two; its neighbour over 0-1 is not, a sliver fills the gap */
  triangles.push_back({8, 2, 1});
  triangles.push_back({0, 8, 1});
  const TriangleMesh mesh = checked_mesh(vertices, triangles);
  CHECK(mesh.findings.degenerate_triangles == 1);
  CHECK(mesh.findings.boundary_edges == 0);
  CHECK(volume_warning(mesh).empty());
  CHECK(count(mesh, EdgeKind::boundary) == 3);
  const TriangleMesh collapsed = checked_mesh(square, {{0, 2, 1}, {1, 1, 2}, {0, 0, 0}});
  CHECK(collapsed.findings.degenerate_triangles == 2);
  CHECK(collapsed.findings.boundary_edges == 3);
}

TEST_CASE("triangle mesh: thin triangles stay as long as floats give them a normal")
{
  CHECK(checked_mesh({{0, 0, 0}, {1, 0, 0}, {0.5f, 2e-6f, 0}}, {{0, 1, 2}}).triangles.size() == 1);
  CHECK_THAT(refusal_of_mesh({{0, 0, 0}, {1, 0, 0}, {0.5f, 5e-7f, 0}}, {{0, 1, 2}}),
             ContainsSubstring("hall.glb: all 1 triangles of the mesh have no area"));
  CHECK_THAT(refusal_of_mesh({{0, 0, 0}, {1e-12f, 0, 0}, {0, 1e-12f, 0}}, {{0, 1, 2}}),
             ContainsSubstring("have no area")); /* squared it is no float */
}

TEST_CASE("triangle mesh: a strip stays however narrow it is, and floats find its normal")
{
  for (const float width : {1.0f, 1e-2f, 1e-4f, 1e-8f})
    for (size_t turn = 0; turn < 3; ++turn) {
      const std::vector<Vec3> vertices{{-1e4f, 0, 0}, {-1e4f, 0, width}, {1e4f, 0, width}, {1e4f, 0, 0}};
      std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
      for (Triangle &t : triangles) std::rotate(t.begin(), t.begin() + ptrdiff_t(turn), t.end());
      const TriangleMesh mesh = checked_mesh(vertices, triangles);
      INFO("width " << width << ", turned " << turn);
      REQUIRE(mesh.triangles.size() == 2);
      CHECK(count(mesh, EdgeKind::flat) == 1);
      for (const Triangle &t : mesh.triangles) { /* as the kernels do it: at the first corner, in floats */
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        const float up = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
        CHECK(up == Approx(2e4f * width));
      }
    }
}

TEST_CASE("triangle mesh: a vertex out of range is refused, whether a triangle that stays names it or not")
{
  for (const float far : {1.1e9f, -3e38f})
    for (size_t axis = 0; axis < 3; ++axis) {
      std::vector<Vec3> vertices = square;
      vertices.push_back({0, 0, 0});
      vertices.back()[axis] = far;
      for (const std::vector<Triangle> &triangles :
           {std::vector<Triangle>{{0, 2, 1}}, {{0, 2, 1}, {0, 0, 4}}, {{0, 2, 1}, {0, 2, 4}}})
        CHECK_THAT(refusal_of_mesh(vertices, triangles), ContainsSubstring("hall.glb: vertex 4 is ["));
    }
  std::vector<Vec3> vertices = square;
  vertices.push_back({1e9f, -1e9f, 1e9f});
  CHECK(checked_mesh(vertices, {{0, 2, 1}}).findings.unused_vertices == 2);
}

TEST_CASE("triangle mesh: open, badly wound and branching meshes say so")
{
  std::vector<Triangle> open = box_triangles();
  open.pop_back();
  const TriangleMesh box = checked_mesh(box_corners(1, 1, 1), open);
  CHECK(box.findings.boundary_edges == 3);
  CHECK_THAT(volume_warning(box), ContainsSubstring("open mesh: 3 boundary edges;"));

  std::vector<Triangle> flipped = box_triangles();
  std::swap(flipped[3][0], flipped[3][1]);
  const TriangleMesh bad = checked_mesh(box_corners(1, 1, 1), flipped);
  CHECK(bad.findings.misoriented_edges == 3);
  CHECK(bad.neighbours[3] == Triangle{no_triangle, no_triangle, no_triangle});
  CHECK_THAT(volume_warning(bad), ContainsSubstring("badly wound mesh: 3 edges"));

  std::vector<Vec3> fin_vertices = box_corners(1, 1, 1);
  fin_vertices.push_back({-3, -3, 0});
  std::vector<Triangle> fin = box_triangles();
  fin.push_back({0, 4, 8}); /* a fin, back to back, on the edge 0-4 */
  fin.push_back({4, 0, 8});
  const TriangleMesh branching = checked_mesh(fin_vertices, fin);
  CHECK(branching.findings.non_manifold_edges == 1);
  CHECK_THAT(volume_warning(branching), ContainsSubstring("branching mesh: 1 edges"));
  CHECK(count(branching, EdgeKind::boundary) == 4);
}

TEST_CASE("triangle mesh: flat ones are known as flat, single triangles and turned planes among them")
{
  CHECK(checked_mesh(square, {{0, 2, 1}}).flat);
  Random random(3);
  std::vector<Vec3> plane;
  std::vector<Triangle> triangles;
  for (uint32_t z = 0; z < 6; ++z)
    for (uint32_t x = 0; x < 6; ++x) plane.push_back({float(x), 0, float(z)});
  for (uint32_t z = 0; z < 5; ++z)
    for (uint32_t x = 0; x < 5; ++x) {
      const uint32_t at = 6 * z + x;
      triangles.insert(triangles.end(), {{at, at + 6, at + 7}, {at, at + 7, at + 1}});
    }
  for (int turn = 0; turn < 20; ++turn) {
    const TriangleMesh mesh = checked_mesh(moved(plane, random_rotation(random), {5, 6, 7}), triangles);
    CHECK(mesh.flat);
    CHECK(count(mesh, EdgeKind::flat) == mesh.edges.size() - 20);
    CHECK(count(mesh, EdgeKind::boundary) == 20);
  }
  plane[14][1] = 0.01f;
  CHECK_FALSE(checked_mesh(plane, triangles).flat);
}

TEST_CASE("triangle mesh: an icosphere is convex at every edge")
{
  const Soup soup = icosphere(3);
  const TriangleMesh mesh = checked_mesh(soup.vertices, soup.triangles);
  CHECK(mesh.vertices.size() == 642);
  CHECK(mesh.edges.size() == 1920);
  CHECK(count(mesh, EdgeKind::convex) == 1920);
  CHECK(triangle_bounds(mesh).size() == 1280);
}

TEST_CASE("triangle mesh: what is no mesh is refused by name")
{
  CHECK_THAT(refusal_of_mesh(square, {}), ContainsSubstring("hall.glb: a mesh needs at least one triangle"));
  CHECK_THAT(refusal_of_mesh(square, {{0, 1, 2}, {0, 4, 1}}),
             ContainsSubstring("hall.glb: triangle 1 names vertex 4, but there are 4"));
  CHECK_THAT(refusal_of_mesh({{0, 0, 0}, {1, std::numeric_limits<float>::quiet_NaN(), 0}, {0, 1, 0}}, {{0, 1, 2}}),
             ContainsSubstring("hall.glb: vertex 1 is [1, nan, 0]"));
  CHECK_THAT(refusal_of_mesh(square, {{0, 0, 1}, {2, 2, 2}}), ContainsSubstring("all 2 triangles"));
  const std::vector<uint32_t> indices{0, 2, 1, 3};
  CHECK_THAT(complaint([&] { triangle_mesh(square, indices, "hall.glb"); }),
             ContainsSubstring("hall.glb: 4 indices are no whole number of triangles"));
}
