/* Rays that report all hits, rays that report any, and boxes: against a world for each body, and boxes in double
 * precision. */
#include <limits>

#include "tests/catch.h"
#include "tests/host/scene/shape_points.h"

using namespace tandem;
using namespace tandem::physics_tests;
using namespace tandem::shape_points;
using Catch::Matchers::ContainsSubstring;

namespace {

/* Every kind of body, meshes and compounds too, some of them far apart, above a half-space. */
Scene bodies_above_ground(int n, double size, Random &random)
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int i = 0; i < n; ++i)
    add_any(scene, random, {random.uniform(-size, size), random.uniform(0.5, size), random.uniform(-size, size)});
  for (Body &body : scene.bodies) body.filter_group = 1u << random.below(2);
  return scene;
}

std::vector<Ray> rays_across(int n, double size, Random &random)
{
  std::vector<Ray> rays(static_cast<size_t>(n));
  for (Ray &ray : rays) {
    ray.origin = {random.uniform(-size, size), random.uniform(1, 2 * size), random.uniform(-size, size)};
    ray.direction =
        vec3_of(Vector(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)));
    ray.reach = random.below(4) == 0 ? std::numeric_limits<float>::infinity() : float(random.uniform(0, 3));
    ray.filter.mask = random.below(3) == 0 ? 1 : 3;
    if (random.below(20) == 0) ray.direction[random.below(3)] = 0;
    if (random.below(20) == 0) ray.direction = {0, -1e-3f, 0};
  }
  return rays;
}

/* A world of one body alone has no order of bodies; the indices in the scene stay. */
std::vector<RayHit> hits_of_body_alone(const Scene &scene, uint32_t body, const std::vector<Ray> &rays)
{
  Scene alone = scene;
  alone.bodies = {scene.bodies[body]};
  World world(alone, {}, {"serial", {}});
  std::vector<RayHit> hits = world.cast_rays(rays);
  for (RayHit &hit : hits)
    if (hit.body != no_body) hit.body = body;
  return hits;
}

bool same_hit(const RayHit &a, const RayHit &b)
{
  return a.body == b.body && a.fraction == b.fraction && a.point == b.point && a.normal == b.normal;
}

} // namespace

TEST_CASE("rays through everything hit what each body alone is hit by, nearest first")
{
  Random random(21);
  const Scene scene = bodies_above_ground(70, 6, random);
  const std::vector<Ray> rays = rays_across(2500, 7, random);
  std::vector<std::vector<RayHit>> expected(rays.size());
  for (uint32_t body = 0; body < scene.bodies.size(); ++body) {
    const std::vector<RayHit> alone = hits_of_body_alone(scene, body, rays);
    for (size_t k = 0; k < rays.size(); ++k)
      if (alone[k].body != no_body) expected[k].push_back(alone[k]);
  }
  World world(scene);
  const auto through = world.cast_rays_all(rays);
  const auto nearest = world.cast_rays(rays);
  const auto blocked = world.cast_rays_any(rays);
  size_t wrong = 0, found = 0;
  for (size_t k = 0; k < rays.size(); ++k) {
    std::sort(expected[k].begin(), expected[k].end(), [](const RayHit &a, const RayHit &b) {
      return std::pair(a.fraction, a.body) < std::pair(b.fraction, b.body);
    });
    const bool all = through[k].size() == expected[k].size() &&
                     std::equal(through[k].begin(), through[k].end(), expected[k].begin(), same_hit);
    const bool first = expected[k].empty() ? nearest[k].body == no_body : same_hit(nearest[k], expected[k].front());
    wrong += !all || !first || blocked[k] == expected[k].empty();
    found += expected[k].size();
  }
  CHECK(wrong == 0);
  CHECK(found > 1000);
}

TEST_CASE("rays among five thousand balls hit the nearest of them all")
{
  Random random(22);
  Scene scene = empty_scene({0, 0, 0});
  for (int i = 0; i < 5000; ++i)
    add_body(scene, BodyType::fixed, sphere_shape(0.25f),
             {random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(-12, 12)});
  World world(scene);
  std::vector<Ray> rays(2000);
  for (Ray &ray : rays) {
    ray.origin = point_of(20 * direction(random));
    ray.direction = vec3_of(Vector(random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-10, 10)) -
                            vector_of(ray.origin));
    ray.reach = std::numeric_limits<float>::infinity();
  }
  const std::vector<RayHit> hits = world.cast_rays(rays);
  size_t wrong = 0;
  for (size_t k = 0; k < rays.size(); ++k) {
    const Vector origin = vector_of(rays[k].origin), displacement = vector_of(rays[k].direction),
                 unit = displacement.normalized();
    double least = 1e300, grazing = 1e300;
    for (const Body &body : scene.bodies) {
      const Vector to = vector_of(body.position) - origin;
      const double along = to.dot(unit), square = 0.0625 - (to - along * unit).squaredNorm();
      grazing = std::min(grazing, std::abs(square));
      if (square >= 0 && along > 0) least = std::min(least, along - std::sqrt(square));
    }
    if (grazing < 1e-5) continue;
    const double found = hits[k].body == no_body ? 1e300 : double(hits[k].fraction) * displacement.norm();
    wrong += std::abs(found - least) > 1e-3 * (least < 1e299 ? 1 : 1e300);
  }
  CHECK(wrong == 0);
}

TEST_CASE("boxes find the bodies whose boxes they touch, where they stand and on their way")
{
  Random random(23);
  Scene scene = empty_scene();
  add_ground(scene);
  for (int i = 0; i < 400; ++i) {
    Body &body = add_body(scene, BodyType::fixed,
                          i % 2 ? sphere_shape(float(random.uniform(0.1, 0.6))) : box_shape(0.5f, 0.2f, 0.3f),
                          {random.uniform(-8, 8), random.uniform(1, 12), random.uniform(-8, 8)});
    body.orientation = random.orientation();
  }
  std::vector<QueryBox> boxes(1200);
  for (QueryBox &box : boxes) {
    box.center = {random.uniform(-9, 9), random.uniform(0, 13), random.uniform(-9, 9)};
    box.half_extents = {float(random.uniform(0, 2)), float(random.uniform(0, 0.5)), float(random.below(2))};
    if (random.below(2))
      box.displacement = {float(random.uniform(-9, 9)), float(random.uniform(-9, 9)), random.below(2) ? 0.0f : 3.0f};
  }
  World world(scene);
  const auto found = world.cast_boxes(boxes);
  size_t wrong = 0, hits = 0;
  for (size_t k = 0; k < boxes.size(); ++k) {
    std::vector<std::pair<double, uint32_t>> expected{{0.0, 0u}}; /* the half-space */
    bool doubtful = false;
    for (uint32_t i = 1; i < scene.bodies.size(); ++i) {
      const Body &body = scene.bodies[i];
      const Shape &shape = scene.shapes[body.shape];
      const Vector size = vector_of(shape.size), half = shape.type == ShapeType::sphere
                                                            ? Vector(size.x(), size.x(), size.x())
                                                            : Vector(axes_of(body.orientation).cwiseAbs() * size);
      double enter = 0, leave = 1;
      for (int axis = 0; axis < 3; ++axis) {
        const double reach = half[axis] + double(boxes[k].half_extents[size_t(axis)]),
                     displacement = double(boxes[k].displacement[size_t(axis)]);
        const double offset = body.position[size_t(axis)] - boxes[k].center[size_t(axis)];
        if (displacement == 0) {
          if (std::abs(offset) > reach) leave = -1;
          doubtful = doubtful || std::abs(std::abs(offset) - reach) < 1e-5;
        } else {
          enter = std::max(enter, std::min((offset - reach) / displacement, (offset + reach) / displacement));
          leave = std::min(leave, std::max((offset - reach) / displacement, (offset + reach) / displacement));
        }
      }
      doubtful = doubtful || std::abs(leave - enter) < 1e-5;
      if (enter <= leave) expected.emplace_back(enter, i);
    }
    if (doubtful) continue;
    std::sort(expected.begin(), expected.end());
    bool right = found[k].size() == expected.size();
    for (size_t j = 0; right && j < expected.size(); ++j) {
      const auto same_body =
          std::find_if(expected.begin(), expected.end(), [&](const auto &e) { return e.second == found[k][j].body; });
      right = same_body != expected.end() && std::abs(same_body->first - double(found[k][j].fraction)) < 1e-5;
      if (j > 0)
        right = right && std::pair(found[k][j - 1].fraction, found[k][j - 1].body) <
                             std::pair(found[k][j].fraction, found[k][j].body);
    }
    wrong += !right;
    hits += expected.size();
  }
  CHECK(wrong == 0);
  CHECK(hits > 3000);
}

TEST_CASE("queries between steps see the new places, under every broadphase, and change nothing")
{
  for (const Broadphase broadphase : choices<Broadphase>()) {
    Settings settings;
    settings.broadphase = broadphase;
    Random random(24);
    const Scene scene = bodies_above_ground(30, 4, random);
    World world(scene, settings), other(scene, settings);
    const std::vector<Ray> rays = rays_across(200, 5, random);
    for (int k = 0; k < 4; ++k) {
      world.step();
      other.step();
      CHECK(world.state_hash() == other.state_hash());
      Scene now = scene;
      const std::vector<PreciseBodyState> bodies = world.precise_bodies();
      for (size_t i = 0; i < now.bodies.size(); ++i)
        now.bodies[i].position = bodies[i].position, now.bodies[i].orientation = world.bodies()[i].orientation;
      World still(now, settings);
      const auto found = world.cast_rays(rays), expected = still.cast_rays(rays);
      for (size_t r = 0; r < rays.size(); ++r)
        CHECK((found[r].body == expected[r].body && std::abs(found[r].fraction - expected[r].fraction) < 1e-5));
      CHECK(world.cast_rays_all(rays).size() == rays.size());
    }
  }
}

TEST_CASE("boxes that mean nothing are refused, by their number")
{
  Scene scene = empty_scene();
  add_ground(scene);
  World world(scene, {}, {"serial", {}});
  CHECK(world.cast_boxes({}).empty());
  CHECK(world.cast_rays_all({}).empty());
  CHECK(world.cast_rays_any({}).empty());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<QueryBox> boxes(3);
  boxes[2].half_extents[1] = -1;
  CHECK_THROWS_WITH(world.cast_boxes(boxes), ContainsSubstring("box 2") && ContainsSubstring("half extents"));
  boxes[2] = {};
  boxes[1].displacement[0] = nan;
  CHECK_THROWS_WITH(world.cast_boxes(boxes), ContainsSubstring("box 1") && ContainsSubstring("displacement"));
  std::vector<Ray> rays(2);
  rays[0].direction = {1, 0, 0};
  CHECK_THROWS_WITH(world.cast_rays_all(rays), ContainsSubstring("ray 1") && ContainsSubstring("direction"));
  CHECK_THROWS_WITH(world.cast_rays_any(rays), ContainsSubstring("ray 1") && ContainsSubstring("direction"));
}
