/* The tables of hulls that kernels read: each hull is complete, closed and outward, and shapes share the hull that they
 * share. */
#include <set>

#include "host/geometry/convex_hull.h"
#include "host/scene/hull_buffers.h"
#include "shared/platform.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Three hulls; the second stands in two shapes, and a ball between them. */
Scene hulls()
{
  Random random(4);
  Scene scene = empty_scene();
  add_dynamic_body(scene, random_hull_shape(random, 30, 1), {0, 0, 0});
  const Shape shared = hull_of_box(0.5f, 1, 2);
  add_body(scene, BodyType::dynamic, shared, {10, 0, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(1), {20, 0, 0});
  add_body(scene, BodyType::dynamic, shared, {30, 0, 0});
  add_dynamic_body(scene, random_hull_shape(random, 5, 1), {40, 0, 0});
  return scene;
}

/* The contents of the buffers in a World. */
struct Tables {
  explicit Tables(World &world)
  {
    Memory &memory = world.memory();
    const auto words = [&](Buffer buffer) {
      return memory.read<uint32_t>(buffer, memory.bytes(buffer) / sizeof(uint32_t));
    };
    const auto rows = [&](Buffer buffer) { return memory.read<float4>(buffer, memory.bytes(buffer) / sizeof(float4)); };
    headers = words(Buffer::hull_header), face_starts = words(Buffer::hull_face_start),
    corners = words(Buffer::hull_corner);
    edges = words(Buffer::hull_edge), vertices = rows(Buffer::hull_vertex), planes = rows(Buffer::hull_plane);
  }
  std::vector<uint32_t> headers, face_starts, corners, edges;
  std::vector<float4> vertices, planes;
};

Vector vector_of(const float4 &r) { return {r.x, r.y, r.z}; }

} // namespace

TEST_CASE("hulls that shapes share are counted once")
{
  const Scene scene = hulls();
  const std::map<const ConvexHull *, uint32_t> numbers = hull_numbers(scene);
  std::vector<uint32_t> of_shapes;
  for (const Shape &shape : scene.shapes) of_shapes.push_back(shape.hull ? numbers.at(shape.hull.get()) : 0);
  CHECK(of_shapes == std::vector<uint32_t>{0, 1, 0, 1, 2});
  const HullSizes sizes = hull_sizes(scene, {});
  CHECK(sizes.hulls == 3);
  CHECK(sizes.vertices == 30 + 8 + 5);
  CHECK(sizes.edges == sizes.vertices + sizes.faces - 3 * 2); /* Euler, three times */
  CHECK(sizes.corners == 2 * sizes.edges);
}

TEST_CASE("the tables of hulls are closed surfaces that face outward")
{
  const Scene scene = hulls();
  World world(scene);
  const Tables t(world);
  REQUIRE(t.headers.size() == 3 * 12);
  uint32_t vertex = 0, face = 0, edge = 0, corner = 0;
  for (uint32_t h = 0; h < 3; ++h) {
    CAPTURE(h);
    const uint32_t *header = &t.headers[12 * h];
    REQUIRE((header[0] == vertex && header[2] == face && header[4] == edge && header[6] == corner));
    const uint32_t vertices = header[1], faces = header[3], edges = header[5], corners = header[7];
    REQUIRE(vertices + faces == edges + 2);
    const ConvexHull &hull = *scene.shapes[h == 0 ? 0 : h == 1 ? 1 : 4].hull;
    REQUIRE(vertices == hull.vertices.size());
    for (uint32_t k = 0; k < vertices; ++k) CHECK(vector_of(t.vertices[vertex + k]) == vector_of(hull.vertices[k]));

    std::set<std::array<uint32_t, 3>> sides; /* from, to, face */
    for (uint32_t f = 0; f < faces; ++f) {
      const Vector normal = vector_of(t.planes[face + f]);
      const double distance = t.planes[face + f].w;
      CHECK(normal.norm() == Approx(1).epsilon(1e-6));
      for (uint32_t k = 0; k < vertices; ++k) CHECK(normal.dot(vector_of(t.vertices[vertex + k])) < distance + 1e-5);
      const uint32_t begin = t.face_starts[face + f], end = t.face_starts[face + f + 1];
      REQUIRE(end >= begin + 3);
      Vector area = Vector::Zero();
      for (uint32_t c = begin; c < end; ++c) {
        const uint32_t from = t.corners[c], to = t.corners[c + 1 == end ? begin : c + 1];
        REQUIRE(from < vertices);
        const Vector p = vector_of(t.vertices[vertex + from]), q = vector_of(t.vertices[vertex + to]);
        CHECK(std::abs(normal.dot(p) - distance) < 1e-5);
        area += 0.5 * p.cross(q);
        sides.insert({from, to, f});
      }
      CHECK(area.dot(normal) == Approx(area.norm()).epsilon(1e-4)); /* counter-clockwise from outside */
    }
    CHECK(sides.size() == 2 * edges);
    for (uint32_t e = edge; e < edge + edges; ++e) {
      const uint32_t *word = &t.edges[4 * e];
      CHECK(sides.count({word[0], word[1], word[2]}) == 1);
      CHECK(sides.count({word[1], word[0], word[3]}) == 1);
    }
    vertex += vertices, face += faces, edge += edges, corner += corners;
  }
  CHECK(t.vertices.size() == vertex);
  CHECK(t.edges.size() == 4 * edge);
  CHECK(t.corners.size() == corner);
  REQUIRE(t.face_starts.size() >= face + 1);
  CHECK(t.face_starts[face] == corner);
}

TEST_CASE("a scene without hulls has none of their vertices")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, capsule_shape(0.5f, 1), {0, 0, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 3, 0});
  CHECK(hull_sizes(scene, {}).hulls == 0);
  World world(scene);
  world.step();
  CHECK(world.memory().bytes(Buffer::hull_vertex) == 0);
}

TEST_CASE("a hull has the cube maps that something reads, and no others")
{
  Settings settings;
  settings.support = GENERATE(Support::brute_force, Support::hill_climbing, Support::cube_map);
  settings.narrowphase = GENERATE(Narrowphase::sat, Narrowphase::cube_map);
  settings.support_cells = 4;
  const Scene scene = hulls();
  const uint64_t maps = (settings.support != Support::brute_force) + (settings.narrowphase == Narrowphase::cube_map);
  World world(scene, settings);
  const uint64_t links = world.memory().bytes(Buffer::hull_link) / sizeof(uint32_t);
  CHECK(links == hull_sizes(scene, {}).links + 3 * maps * 6 * 4 * 4);
}
