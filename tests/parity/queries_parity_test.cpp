/* Rays, casts, overlap tests and closest points give the same bits on every backend, with every structure of bodies. */
#include <cstring>

#include "host/base/random.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

struct Answers {
  std::vector<RayHit> rays;
  std::vector<ShapeCastHit> casts;
  std::vector<bool> blocked;
  std::vector<std::vector<RayHit>> through;
  std::vector<std::vector<BoxHit>> boxes;
  std::vector<std::vector<uint32_t>> overlaps;
  std::vector<ClosestPoints> closest;
  size_t found = 0, overlapped = 0;
};

Answers ask(const std::string &scene, Broadphase broadphase, const std::string &backend, size_t queries, int steps)
{
  Settings settings;
  settings.broadphase = broadphase;
  settings.specialise = false; /* one build for all scenes */
  World world(load_scene(scene), settings, Placement{backend, {}, false});
  for (int k = 0; k < steps; ++k) world.step();
  Random random(5);
  const auto uniform3 = [&](double size) {
    return Point{random.uniform(-size, size), random.uniform(0, 2 * size), random.uniform(-size, size)};
  };
  std::vector<Ray> rays(queries);
  std::vector<Pose> poses(queries);
  std::vector<Vec3> paths(queries);
  for (size_t k = 0; k < queries; ++k) {
    rays[k].origin = uniform3(6);
    poses[k] = {uniform3(6), random.orientation()};
    const Point ray_to = uniform3(3), cast_to = uniform3(3);
    for (size_t axis = 0; axis < 3; ++axis) {
      rays[k].direction[axis] = float(1.5 * (ray_to[axis] - rays[k].origin[axis]));
      paths[k][axis] = float(cast_to[axis] - poses[k].position[axis]);
    }
  }
  Answers answers;
  std::vector<QueryBox> boxes(queries);
  for (size_t k = 0; k < queries; ++k)
    boxes[k] = {poses[k].position, {0.3f, 0.2f, 0.1f}, k % 2 ? paths[k] : Vec3{0, 0, 0}, {}};
  answers.rays = world.cast_rays(rays);
  answers.blocked = world.cast_rays_any(rays);
  answers.through = world.cast_rays_all(rays);
  answers.boxes = world.cast_boxes(boxes);
  for (const Shape &shape : {sphere_shape(0.1f), box_shape(0.2f, 0.1f, 0.15f), world.scene().shapes.front()}) {
    if (shape.type == ShapeType::half_space) continue;
    const std::vector<ShapeCastHit> hits = world.cast_shapes(shape, poses, paths);
    answers.casts.insert(answers.casts.end(), hits.begin(), hits.end());
    const auto bodies = world.overlap_shapes(shape, poses);
    answers.overlaps.insert(answers.overlaps.end(), bodies.begin(), bodies.end());
  }
  std::vector<std::pair<BodyId, BodyId>> pairs;
  for (uint32_t body = 1; body < world.scene().bodies.size(); ++body)
    pairs.emplace_back(world.id_of(body), world.id_of(body / 2));
  answers.closest = world.closest_points(pairs);
  for (const RayHit &hit : answers.rays) answers.found += hit.body != no_body;
  for (const ShapeCastHit &hit : answers.casts) answers.found += hit.body != no_body;
  for (const auto &bodies : answers.overlaps) answers.overlapped += bodies.size();
  return answers;
}

bool same_bits(const std::vector<QueryHit> &a, const std::vector<QueryHit> &b)
{
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const QueryHit &p, const QueryHit &q) {
           return p.body == q.body && std::memcmp(&p.fraction, &q.fraction, sizeof(float)) == 0 &&
                  std::memcmp(&p.point, &q.point, sizeof(Point)) == 0 &&
                  std::memcmp(&p.normal, &q.normal, sizeof(Vec3)) == 0;
         });
}

bool same_bits(const std::vector<ClosestPoints> &a, const std::vector<ClosestPoints> &b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ClosestPoints &p, const ClosestPoints &q) {
    return std::memcmp(&p.distance, &q.distance, sizeof(float)) == 0 &&
           std::memcmp(&p.on_first, &q.on_first, sizeof(Point)) == 0 &&
           std::memcmp(&p.on_second, &q.on_second, sizeof(Point)) == 0 &&
           std::memcmp(&p.normal, &q.normal, sizeof(Vec3)) == 0;
  });
}

bool same_bits(const std::vector<std::vector<BoxHit>> &a, const std::vector<std::vector<BoxHit>> &b)
{
  const auto same = [](const BoxHit &p, const BoxHit &q) {
    return p.body == q.body && std::memcmp(&p.fraction, &q.fraction, sizeof(float)) == 0;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const auto &p, const auto &q) {
    return std::equal(p.begin(), p.end(), q.begin(), q.end(), same);
  });
}

bool same_bits(const std::vector<std::vector<RayHit>> &a, const std::vector<std::vector<RayHit>> &b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto &p, const auto &q) { return same_bits(p, q); });
}

void require_equal_answers(const std::string &scene, const std::vector<std::string> &backends, size_t queries,
                           int steps)
{
  const Answers expected = ask(scene, Broadphase::bvh, "serial", queries, steps);
  CAPTURE(scene);
  REQUIRE(expected.found > queries / 4);
  REQUIRE(expected.overlapped > 0);
  for (const std::string &backend : backends)
    for (const Broadphase broadphase : {Broadphase::bvh, Broadphase::grid, Broadphase::brute_force}) {
      CAPTURE(backend, broadphase);
      const Answers found = ask(scene, broadphase, backend, queries, steps);
      CHECK(same_bits(found.rays, expected.rays));
      CHECK(same_bits(found.casts, expected.casts));
      CHECK(found.blocked == expected.blocked);
      CHECK(same_bits(found.through, expected.through));
      CHECK(same_bits(found.boxes, expected.boxes));
      CHECK(found.overlaps == expected.overlaps);
      CHECK(same_bits(found.closest, expected.closest));
    }
}

} // namespace

TEST_CASE("parity on CPU: queries")
{
  for (const char *scene : {"shapes:n=60", "mixed:n=60", "thin-wall:n=40", "convex-hulls:n=30"})
    require_equal_answers(scene, cpu_backends(), 300, 5);
}

TEST_CASE("parity on CPU: threads share queries", "[sanitizer]")
{
  require_equal_answers("shapes:n=30", {"tbb:threads=4"}, 500, 1);
}

TEST_CASE("parity on OpenCL: queries")
{
  require_pocl();
  for (const char *scene : {"shapes:n=60", "mixed:n=60", "thin-wall:n=40"})
    require_equal_answers(scene, {"cl:pocl"}, 300, 2);
}
