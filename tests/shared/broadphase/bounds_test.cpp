/* Bounds of bodies with shapes of every kind at any pose in their bodies: they contain the body at the start of a step
 * with the margin, and the body at its end. */
#include "host/runtime/memory.h"
#include "shared/platform.h"
#include "tests/catch.h"
#include "tests/host/scene/shape_points.h"

using namespace tandem;
using namespace tandem::shape_points;

namespace {

struct Reach {
  Vector low, high;
};

Reach bounds_of(World &world, uint32_t index)
{
  const std::vector<float4> rows = world.memory().read<float4>(Buffer::bounds, 2, 2 * index);
  return {{rows[0].x, rows[0].y, rows[0].z}, {rows[1].x, rows[1].y, rows[1].z}};
}

/* How far the points reach out of the bounds; negative: how far they stay inside. */
double outside_by(const Reach &bounds, const std::vector<Vector> &points, const BodyState &state)
{
  const physics_tests::Matrix axes = physics_tests::axes_of(state.orientation);
  const Vector place = physics_tests::vector_of(state.position);
  double worst = -1e300;
  for (const Vector &p : points) {
    const Vector at = place + axes * p;
    worst = std::max({worst, (bounds.low - at).maxCoeff(), (at - bounds.high).maxCoeff()});
  }
  return worst;
}

} // namespace

TEST_CASE("bounds hold every shape in any pose, at rest, in flight and spinning")
{
  const double speed = GENERATE(0.0, 8.0), spin = GENERATE(0.0, 10.0);
  const Bounds kind = GENERATE(Bounds::affine, Bounds::tight);
  Random random(5);
  Scene scene = physics_tests::empty_scene();
  constexpr int side = 8;
  for (int i = 0; i < side * side * side; ++i) {
    Body &body =
        add_any(scene, random, {12.0 * (i % side) - 40, 12.0 * (i / side % side) - 40, 12.0 * (i / side / side) - 40});
    body.linear_velocity = physics_tests::vec3_of(speed * direction(random));
    body.angular_velocity = physics_tests::vec3_of(spin * direction(random));
  }
  Settings settings;
  settings.bounds = kind;
  World world(scene, settings);
  world.set_observer([](const Launch &) {}); /* so that no other buffer takes the memory of the bounds */
  const std::vector<BodyState> start = world.bodies();
  world.step();
  REQUIRE(world.statistics().contacts == 0);
  const std::vector<BodyState> end = world.bodies();
  const double margin = 2 * world.settings().slop; /* half of the distance at which contacts are made */
  for (uint32_t index = 0; index < scene.bodies.size(); ++index) {
    const uint32_t i = world.scene_body(index);
    const Body &body = scene.bodies[i];
    const std::vector<Vector> points = points_of(scene, body, random);
    const Reach bounds = bounds_of(world, index);
    const double before = outside_by(bounds, points, start[i]) + margin, after = outside_by(bounds, points, end[i]);
    CAPTURE(i, kind, int(scene.shapes[body.shape].type), speed, spin, before, after);
    REQUIRE(before < 1e-6);
    REQUIRE(after < 0);
  }
}

TEST_CASE("tight bounds are the least that hold a shape, and lie within the fast ones")
{
  Random random(6);
  Scene scene = physics_tests::empty_scene({0, 0, 0});
  for (int i = 0; i < 400; ++i) add_any(scene, random, {12.0 * (i % 20), 0, 12.0 * (i / 20)});
  Settings settings;
  settings.bounds = Bounds::tight;
  World tight(scene, settings), fast(scene);
  for (World *world : {&tight, &fast}) world->set_observer([](const Launch &) {}); /* as above */
  tight.step();
  fast.step();
  const double margin = 2 * settings.slop;
  double volume = 0, fast_volume = 0, loosest = 0;
  for (uint32_t index = 0; index < scene.bodies.size(); ++index) {
    const uint32_t i = tight.scene_body(index);
    const Reach bounds = bounds_of(tight, index), around = bounds_of(fast, index);
    const physics_tests::Matrix axes = physics_tests::axes_of(scene.bodies[i].orientation);
    const Vector place = physics_tests::vector_of(scene.bodies[i].position);
    Vector low(1e300, 1e300, 1e300), high(-1e300, -1e300, -1e300);
    for (const Vector &p : points_of(scene, scene.bodies[i], random)) {
      low = low.cwiseMin(place + axes * p);
      high = high.cwiseMax(place + axes * p);
    }
    CAPTURE(i, int(scene.shapes[scene.bodies[i].shape].type));
    CHECK((bounds.low - around.low).minCoeff() > -1e-4);
    CHECK((around.high - bounds.high).minCoeff() > -1e-4);
    const ShapeType type = scene.shapes[scene.bodies[i].shape].type;
    const bool drawn =
        type == ShapeType::sphere || type == ShapeType::capsule; /* of which the farthest points are not among those */
    if (!drawn)
      loosest = std::max({loosest, (low - bounds.low).maxCoeff() - margin, (bounds.high - high).maxCoeff() - margin});
    volume += (bounds.high - bounds.low).prod();
    fast_volume += (around.high - around.low).prod();
  }
  CAPTURE(volume, fast_volume, loosest);
  CHECK(loosest < 1e-4);
  CHECK(volume < 0.6 * fast_volume);
}
