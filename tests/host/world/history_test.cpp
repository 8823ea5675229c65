/* The bits of a step follow from the state alone: a world goes on as one that was restored from its snapshot, whatever
 * happened to it before, and what a step was once planned with decides nothing. */
#include <limits>
#include <random>

#include <tandem/world.h>

#include "tests/catch.h"
#include "tests/host/world/bodies.h"

using namespace tandem;

namespace {

Scene on_a_floor(const std::vector<Shape> &shapes)
{
  Scene scene;
  scene.shapes = {half_space_shape()};
  scene.shapes.insert(scene.shapes.end(), shapes.begin(), shapes.end());
  scene.bodies.resize(1);
  scene.bodies[0].type = BodyType::fixed;
  return scene;
}

void require_goes_on_as_restored(World &world, int steps)
{
  World restored(world.save(), {"serial", {}});
  for (int step = 0; step < steps; ++step) {
    CAPTURE(step);
    world.step();
    restored.step();
    REQUIRE(world.state_hash() == restored.state_hash());
    REQUIRE(world.quarantined().size() == restored.quarantined().size());
  }
}

} // namespace

/* One more colour than there are is planned for the next step. Passes over the constraints beyond the last one change
 * the others' bits, so they must not run where there are none. */
TEST_CASE("a step without overflow constraints does not depend on the one before having had some")
{
  for (const int balls : {66, 68, 70, 72}) {
    CAPTURE(balls);
    Scene scene = on_a_floor({box_shape(3, 0.5f, 3), sphere_shape(0.2f)});
    scene.bodies.push_back(body_at({0, 0.5, 0}, 1));
    scene.bodies.back().mass = 50;
    for (int k = 0; k < balls; ++k)
      scene.bodies.push_back(body_at({-2.5 + 0.55 * (k % 10), 1.2, -2.5 + 0.55 * (k / 10)}, 2));
    World world(scene, {}, {"serial", {}});
    for (int k = 0; k < 30; ++k) world.step();
    REQUIRE(world.statistics().colors == 64);
    for (uint32_t k = 0; k < 10; ++k) world.destroy_body(world.id_of(2 + k));
    require_goes_on_as_restored(world, 2);
    CHECK(world.statistics().colors < 64);
  }
}

/* The step is repeated with more room, rounds or colours, and only a whole one says who is not finite. */
TEST_CASE("who is quarantined does not depend on how often a step was repeated")
{
  for (int seed = 0; seed < 120; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(static_cast<uint32_t>(seed));
    const auto between = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
    Scene scene = on_a_floor({box_shape(0.5f, 0.5f, 0.5f)});
    for (int k = 0; k < 60; ++k) {
      const double x = between(0, 5), y = 0.5 + between(0, 4), z = between(0, 5);
      scene.bodies.push_back(body_at({x, y, z}, 1));
    }
    World world(scene, {}, {"serial", {}});
    for (int k = 0; k < 20; ++k) world.step();
    const Point place = world.bodies()[7].position;
    World restored(world.save(), {"serial", {}});
    for (World *one : {&world, &restored}) {
      one->set_body_unchecked(3,
                              {{place[0], place[1] + 0.9, place[2]}, {0, 0, 0, 1}, {0, -3e38f, 0}, {0, 3e38f, 3e38f}});
      for (int k = 0; k < 3; ++k) one->step();
    }
    REQUIRE(world.state_hash() == restored.state_hash());
    REQUIRE(world.quarantined().size() == restored.quarantined().size());
  }
}

TEST_CASE("a body in quarantine that is set to what is not finite again is there once, and others go on falling")
{
  Scene scene = on_a_floor({sphere_shape(0.25f)});
  for (int k = 1; k < 3; ++k) scene.bodies.push_back(body_at({3.0 * k, 50, 0}, 1));
  World world(scene, sleepy(), {"serial", {}});
  world.step();
  for (int k = 0; k < 3; ++k) {
    world.set_body_unchecked(2, {{6, 3, 0}, {0, 0, 0, 1}, {0, std::numeric_limits<float>::quiet_NaN(), 0}, {0, 0, 0}});
    world.step();
  }
  CHECK(world.quarantined().size() == 1);
  const double height = world.bodies()[1].position[1];
  require_goes_on_as_restored(world, 5);
  CHECK(world.bodies()[1].position[1] < height);
}
