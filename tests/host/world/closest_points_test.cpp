/* Closest points of two bodies: closed forms, exchange of the bodies, every part of compounds and meshes, and distances
 * in double precision. */
#include "tests/catch.h"
#include "tests/host/scene/shape_points.h"
#include "tests/host/world/convex_distance.h"

using namespace tandem;
using namespace tandem::physics_tests;
using namespace tandem::shape_points;
using namespace tandem::convex_distance;
using Catch::Matchers::ContainsSubstring;

namespace {

using IdPair = std::pair<BodyId, BodyId>;

ClosestPoints between(World &world, uint32_t first, uint32_t second)
{
  const IdPair pair{world.id_of(first), world.id_of(second)};
  return world.closest_points(std::span(&pair, 1)).front();
}

/* All pairs but those of a half-space with itself; the ground is body 0. */
std::vector<IdPair> all_pairs(const World &world, const Scene &scene)
{
  std::vector<IdPair> pairs;
  for (uint32_t i = 0; i < scene.bodies.size(); ++i)
    for (uint32_t j = 0; j < i; ++j) pairs.emplace_back(world.id_of(i), world.id_of(j));
  return pairs;
}

Shape mallet()
{
  std::vector<Child> children(3);
  children[0].shape = sphere_shape(0.4f);
  children[0].position = {0.5f, 0, 0};
  children[1].shape = box_shape(0.2f, 0.5f, 0.1f);
  children[1].position = {-0.5f, 0.1f, 0};
  children[2].shape = capsule_shape(0.1f, 0.5f);
  children[2].orientation = turn_about({1, 2, 3}, 1);
  return compound_shape(children);
}

/* Every kind of body above a half-space; what comes later is higher, so that most are apart. */
Scene bodies_of_all_kinds_apart(Random &random, int n)
{
  Scene scene = empty_scene({0, 0, 0});
  add_ground(scene);
  for (int i = 0; i < n; ++i) {
    const Point at{random.uniform(-5, 5), random.uniform(1, 8), random.uniform(-5, 5)};
    if (i % 6 == 0)
      add_body(scene, BodyType::fixed, any_height_field(random, 7, 0.5f), at).orientation = random.orientation();
    else if (i % 6 == 1) add_body(scene, BodyType::fixed, mallet(), at).orientation = random.orientation();
    else add_any(scene, random, at);
  }
  return scene;
}

bool same_bits(const ClosestPoints &a, const ClosestPoints &b)
{
  return a.distance == b.distance && a.on_first == b.on_first && a.on_second == b.on_second && a.normal == b.normal;
}

} // namespace

TEST_CASE("closest points follow closed forms")
{
  const double half = std::sqrt(0.5);
  struct Near {
    Shape first, second;
    Vector to; /* where the second one is */
    Quat turn; /* of the second one */
    double distance;
    Vector on_first, on_second;
  };
  const Quat none{0, 0, 0, 1}, about_z = turn_about({0, 0, 1}, pi / 4), about_x = turn_about({1, 0, 0}, pi / 4);
  const Near cases[] = {
      {sphere_shape(1), sphere_shape(0.5f), {3, 4, 0}, none, 3.5, {0.6, 0.8, 0}, {2.7, 3.6, 0}},
      {sphere_shape(0.5f), box_shape(1, 2, 3), {4, 1, 2}, none, 2.5, {0.5, 0, 0}, {3, 0, 0}},
      {sphere_shape(0.5f),
       box_shape(1, 1, 1),
       {2, 2, 5},
       none,
       std::sqrt(18.0) - 0.5,
       0.5 * Vector(1, 1, 4) / std::sqrt(18.0),
       {1, 1, 4}},
      {capsule_shape(0.25f, 1),
       sphere_shape(0.5f),
       {2, 3, 0},
       none,
       std::sqrt(8.0) - 0.75,
       Vector(0, 1, 0) + 0.25 * Vector(half, half, 0),
       Vector(2, 3, 0) - 0.5 * Vector(half, half, 0)},
      {box_shape(1, 1, 1), box_shape(2, 1, 1), {0, 0, 0}, none, 0, {0, 0, 0}, {0, 0, 0}},
      {half_space_shape(), sphere_shape(0.5f), {2, 3, -1}, none, 2.5, {2, 0, -1}, {2, 2.5, -1}},
      {half_space_shape(), box_shape(1, 1, 0.5f), {0, 3, 0}, turn_about({1, 2, 1}, 0), 2, {9, 0, 9}, {9, 2, 9}},
      {sphere_shape(1), sphere_shape(0.5f), {1.4, 0, 0}, none, 0, {0, 0, 0}, {0, 0, 0}},
      {cylinder_shape(1, 0.5f),
       sphere_shape(0.25f),
       {4, 4.5, 0},
       none,
       4.75,
       {1, 0.5, 0},
       Vector(4, 4.5, 0) - 0.25 * Vector(0.6, 0.8, 0)},
  };
  for (const Near &near : cases)
    for (const Vector &origin : {Vector(0, 0, 0), Vector(2e5, -3e5, 1e5)}) {
      Scene scene = empty_scene({0, 0, 0});
      add_body(scene, BodyType::fixed, near.first, point_of(origin));
      add_body(scene, BodyType::fixed, near.second, point_of(origin + near.to)).orientation = near.turn;
      World world(scene, {}, {"serial", {}});
      const ClosestPoints found = between(world, 0, 1);
      CAPTURE(int(near.first.type), int(near.second.type), near.to.transpose(), origin.transpose(), found.distance);
      CHECK(found.distance == Approx(near.distance).margin(5e-6));
      if (near.distance == 0) {
        CHECK(same_bits(found, ClosestPoints{}));
        continue;
      }
      const Vector parts = vector_of(found.on_second) - vector_of(found.on_first);
      CHECK((parts - near.distance * vector_of(found.normal)).norm() < 2e-5);
      CHECK(vector_of(found.normal).norm() == Approx(1).epsilon(1e-6));
      if (near.on_first.x() == 9) continue; /* a whole face is near */
      CHECK((vector_of(found.on_first) - origin - near.on_first).norm() < 2e-5);
      CHECK((vector_of(found.on_second) - origin - near.on_second).norm() < 2e-5);
    }
  /* Two boxes, edge against edge: along z at the top of the first one, along x at the bottom of the second. */
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::fixed, box_shape(1, 1, 1), {0, 0, 0}).orientation = about_z;
  add_body(scene, BodyType::fixed, box_shape(1, 1, 1), {0.25, 5, -0.5}).orientation = about_x;
  World world(scene, {}, {"serial", {}});
  const ClosestPoints found = between(world, 0, 1);
  CHECK(found.distance == Approx(5 - 2 * std::sqrt(2.0)).margin(5e-6));
  CHECK((vector_of(found.on_first) - Vector(0, std::sqrt(2.0), -0.5)).norm() < 2e-5);
  CHECK((vector_of(found.on_second) - Vector(0, 5 - std::sqrt(2.0), -0.5)).norm() < 2e-5);
  CHECK((vector_of(found.normal) - Vector(0, 1, 0)).norm() < 1e-6);
}

/* The bounds of the error are those that <tandem/world.h> states. */
TEST_CASE("closest points have the distance that double precision finds over all parts, to the stated error")
{
  Random random(71);
  const Scene scene = bodies_of_all_kinds_apart(random, 22);
  World world(scene);
  const std::vector<IdPair> pairs = all_pairs(world, scene);
  const std::vector<ClosestPoints> found = world.closest_points(pairs);
  std::vector<std::vector<Solid>> bodies;
  for (const Body &body : scene.bodies) bodies.push_back(solids_of(scene, body));
  size_t wrong = 0, apart = 0, together = 0;
  double large = 0, small = 0, points = 0, normals = 0;
  for (size_t k = 0; k < pairs.size(); ++k) {
    const auto &a = bodies[pairs[k].first.index], &b = bodies[pairs[k].second.index];
    const DistanceBounds exact = distance_between(a, b);
    double size = std::max(exact.upper, 0.0);
    for (const auto *body : {&a, &b})
      if (body->front().type != ShapeType::half_space) {
        double reach = 0;
        for (const Solid &part : *body)
          reach = std::max(reach, part.reach() + (part.middle - body->front().middle).norm());
        size += reach;
      }
    const double distance = double{found[k].distance};
    if (exact.upper <= 0) {
      ++together;
      wrong += distance > 2e-6 * size || (distance == 0 && !same_bits(found[k], ClosestPoints{}));
      continue;
    }
    if (exact.lower < 1e-4 * size) continue;
    ++apart;
    wrong += distance == 0;
    large = std::max(large, (distance - exact.upper) / size);
    small = std::max(small, (exact.lower - distance) / size);
    const Vector between_points = vector_of(found[k].on_second) - vector_of(found[k].on_first);
    points = std::max(points, (between_points - distance * vector_of(found[k].normal)).norm() / size);
    normals = std::max(normals, std::abs(vector_of(found[k].normal).norm() - 1));
  }
  CAPTURE(apart, together, wrong, large, small, points, normals);
  CHECK(wrong == 0);
  CHECK(large < 2e-6);
  CHECK(small < 1e-5);
  CHECK(points < 1e-3);
  CHECK(normals < 1e-6);
  CHECK(apart > 100);
  CHECK(together > 0);
}

TEST_CASE("closest points are exchanged with the bodies, and the same on every backend")
{
  Random random(72);
  const Scene scene = bodies_of_all_kinds_apart(random, 30);
  World world(scene, {}, {"serial", {}});
  const std::vector<IdPair> pairs = all_pairs(world, scene);
  std::vector<IdPair> exchanged;
  for (const auto &[first, second] : pairs) exchanged.emplace_back(second, first);
  const std::vector<ClosestPoints> found = world.closest_points(pairs), other = world.closest_points(exchanged);
  size_t wrong = 0;
  for (size_t k = 0; k < pairs.size(); ++k) {
    const Vec3 &n = other[k].normal;
    wrong += !same_bits(found[k], {other[k].distance, other[k].on_second, other[k].on_first, {-n[0], -n[1], -n[2]}});
  }
  CHECK(wrong == 0);
  for (const char *backend : {"tbb", "tbb:threads=2,lanes=4", "serial:order=backward"}) {
    World same(scene, {}, {backend, {}});
    const std::vector<ClosestPoints> again = same.closest_points(pairs);
    CAPTURE(backend);
    CHECK(std::equal(again.begin(), again.end(), found.begin(), found.end(), same_bits));
  }
}

TEST_CASE("closest points of pairs that mean nothing are refused, by their entry")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_ground(scene);
  for (int k = 0; k < 3; ++k) add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {3.0 * k, 2, 0});
  World world(scene, {}, {"serial", {}});
  const BodyId ball = world.id_of(2), other = world.id_of(3), gone = world.id_of(4);
  world.destroy_body(gone);
  const auto ask = [&](const IdPair &bad) { return world.closest_points(std::vector<IdPair>{{ball, other}, bad}); };
  CHECK(world.closest_points({}).empty());
  CHECK(ask({other, ball}).at(1).distance == Approx(2).margin(1e-6));
  CHECK_THROWS_WITH(ask({ball, gone}), ContainsSubstring("closest_points: entry 1") && ContainsSubstring("destroyed"));
  CHECK_THROWS_WITH(ask({ball, ball}), ContainsSubstring("entry 1") && ContainsSubstring("itself"));
  CHECK_THROWS_WITH(ask({world.id_of(0), world.id_of(1)}),
                    ContainsSubstring("entry 1") && ContainsSubstring("half-spaces"));
  CHECK_THROWS_AS(ask({BodyId{}, ball}), InputError);
}
