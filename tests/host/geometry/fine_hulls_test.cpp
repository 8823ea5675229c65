/* Hulls of tens of thousands of points, bit for bit. */
#include <cmath>

#include <tandem/round_to_float.h>
#include <tandem/scene.h>

#include "host/base/hash.h"
#include "host/base/random.h"
#include "host/geometry/convex_hull.h"
#include "tests/catch.h"

namespace tandem::fine_hulls {
namespace {

std::vector<Vec3> bowl(int side, double curvature)
{
  std::vector<Vec3> points;
  for (int i = 0; i <= side; ++i)
    for (int k = 0; k <= side; ++k) {
      const double x = 2.0 * i / side - 1, y = 2.0 * k / side - 1;
      points.push_back({round_to_float(x), round_to_float(y), round_to_float(curvature * (x * x + y * y))});
    }
  return points;
}

std::vector<Vec3> any_on_sphere(int count)
{
  Random random(5);
  std::vector<Vec3> points;
  while (points.size() < size_t(count)) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const double length = std::sqrt(x * x + y * y + z * z);
    if (length > 0.1 && length < 1)
      points.push_back({round_to_float(x / length), round_to_float(y / length), round_to_float(z / length)});
  }
  return points;
}

uint64_t hash_of(const ConvexHull &hull)
{
  uint64_t hash = hash_bytes(hull.vertices.data(), hull.vertices.size() * sizeof(Vec3));
  for (const auto &face : hull.faces) {
    const size_t corners = face.size();
    hash = hash_bytes(face.data(), corners * sizeof(uint32_t), hash_bytes(&corners, sizeof corners, hash));
  }
  for (const HullEdge &edge : hull.edges)
    for (const uint32_t number : {edge.v0, edge.v1}) hash = hash_bytes(&number, sizeof number, hash);
  for (const auto &plane : hull.planes) {
    hash = hash_bytes(plane.normal.data(), sizeof plane.normal, hash);
    hash = hash_bytes(&plane.distance, sizeof plane.distance, hash);
  }
  return hash;
}

} // namespace

/* Of the hulls as they were before anything was left out that gives the same. */
TEST_CASE("fine hulls: their faces and planes are known, bit for bit")
{
  CHECK(hash_of(*hull_shape(bowl(60, 1), "bowl").hull) == 0xe101367f06eaf1ff);
  CHECK(hash_of(*hull_shape(bowl(60, 0.001), "shallow bowl").hull) == 0x4c7e8f09c90922e);
  CHECK(hash_of(*hull_shape(any_on_sphere(5000), "sphere").hull) == 0x1f88ba46b75a6b99);
  CHECK(hash_of(*hull_shape(any_on_sphere(40000), "rough sphere").hull) == 0x9210f578eb4cb9d2);
}

} // namespace tandem::fine_hulls
