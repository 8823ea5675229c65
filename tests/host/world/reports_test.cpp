/* What a step reports besides contacts: hits above a speed, and the bodies that it moved. */
#include <limits>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/parity/parity.h"

using namespace tandem;

namespace {

Scene balls_over_ground(bool half_space)
{
  Scene scene;
  scene.name = "balls over ground";
  scene.shapes = {sphere_shape(0.5f), half_space ? half_space_shape() : box_shape(50, 1, 50)};
  Body ground;
  ground.type = BodyType::fixed;
  ground.shape = 1;
  if (!half_space) ground.position = {0, -1, 0};
  scene.bodies = {ground};
  for (const double height : {0.52, 5.5}) {
    Body ball;
    ball.position = {4 * height, height, 0};
    scene.bodies.push_back(ball);
  }
  return scene;
}

Settings with_reports()
{
  Settings settings;
  settings.events = settings.moved_bodies = true;
  return settings;
}

} // namespace

TEST_CASE("a fall is a hit of the speed of its closed form, and a touch is none", "[sanitizer]")
{
  const bool half_space = GENERATE(true, false);
  World world(balls_over_ground(half_space), with_reports(), {"serial", {}});
  std::vector<HitEvent> hits;
  for (int k = 0; k < 90; ++k) {
    world.step();
    for (const HitEvent &hit : world.hit_events()) hits.push_back(hit);
  }
  REQUIRE(hits.size() == 1);
  CHECK(hits[0].a == 0);
  CHECK(hits[0].b == 2);
  const double speed = std::sqrt(2 * 10 * 5.0); /* the speed at the start of the step: up to g h less */
  CHECK(hits[0].approach_speed <= speed + 1e-3);
  CHECK(hits[0].approach_speed >= speed - 10.0 / 60 - 1e-3);
  CHECK(hits[0].normal[1] == Approx(1).margin(1e-5));
  CHECK(hits[0].point[0] == Approx(22).margin(1e-3));
  CHECK(hits[0].point[1] == Approx(0).margin(0.2));
  Settings fast = with_reports();
  fast.hit_speed = 11;
  World other(balls_over_ground(half_space), fast, {"serial", {}});
  for (int k = 0; k < 90; ++k) {
    other.step();
    REQUIRE(other.hit_events().empty());
  }
}

TEST_CASE("the approach at a contact counts the spin of both bodies", "[sanitizer]")
{
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.shapes = {box_shape(2, 0.2f, 0.2f), sphere_shape(0.3f)};
  scene.bodies.resize(2);
  scene.bodies[0].angular_velocity = {0, 0, 2};
  scene.bodies[1].shape = 1;
  scene.bodies[1].position = {1.5, 0.51, 0};
  scene.bodies[1].linear_velocity = {0, -1, 0};
  World world(scene, with_reports(), {"serial", {}});
  world.step();
  REQUIRE(world.hit_events().size() == 1);
  const HitEvent hit = world.hit_events().front();
  CHECK(hit.approach_speed == Approx(1 + 2 * 1.5).epsilon(0.01));
  CHECK(hit.normal[1] == Approx(1).margin(0.01));
}

TEST_CASE("hits and moves are refused without their settings", "[sanitizer]")
{
  World world(balls_over_ground(true), {}, {"serial", {}});
  CHECK_THROWS_WITH(world.hit_events(), "hit_events: there are none without Settings::events");
  CHECK_THROWS_WITH(world.moved_bodies(), "moved_bodies: there are none without Settings::moved_bodies");
  Settings settings;
  settings.hit_speed = -1;
  CHECK_THROWS_AS(World(balls_over_ground(true), settings, {"serial", {}}), InputError);
}

TEST_CASE("the bodies that a step has moved are those whose pose differs", "[sanitizer]")
{
  Scene scene = load_scene("mixed:n=60");
  Body still;
  still.shape = scene.bodies.back().shape;
  still.gravity_factor = 0;
  still.position = {500, 500, 500};
  scene.bodies.push_back(still);
  Body turning = still;
  turning.position = {600, 500, 500};
  turning.angular_velocity = {0, 1, 0};
  scene.bodies.push_back(turning);
  World world(scene, with_reports(), {"serial", {}});
  CHECK(world.moved_bodies().empty());
  size_t unmoved = 0;
  for (int k = 0; k < 60; ++k) {
    const std::vector<BodyState> before = world.bodies();
    world.step();
    const std::vector<BodyState> after = world.bodies();
    std::vector<uint32_t> expected;
    for (uint32_t body = 0; body < before.size(); ++body)
      if (before[body].position != after[body].position || before[body].orientation != after[body].orientation)
        expected.push_back(body);
    unmoved += after.size() - expected.size();
    CAPTURE(k);
    REQUIRE(world.moved_bodies() == expected);
  }
  CHECK(unmoved > 60); /* the ground and one body in the air stay in each step */
  const std::vector<uint32_t> listed = world.moved_bodies();
  CHECK(listed.back() == scene.bodies.size() - 1);
  world.create_bodies(std::vector<Body>(300, still)); /* needs room: the list survives */
  CHECK(world.moved_bodies() == listed);
  world.set_state(world.id_of(1), {{9, 9, 9}, {0, 0, 0, 1}, {}, {}});
  CHECK(world.moved_bodies() == listed); /* calls count in no step */
}

TEST_CASE("parity on CPU: moved bodies and hits", "[sanitizer]")
{
  parity::require_parity("mixed:n=60", {"serial", "serial:order=backward", "tbb:threads=4", "tbb:threads=2,lanes=1"},
                         40, with_reports());
}

TEST_CASE("parity on OpenCL: moved bodies and hits")
{
  parity::require_pocl();
  Settings settings = with_reports();
  settings.specialise = false;
  parity::require_parity("mixed:n=40", {"serial", "cl:pocl"}, 40, settings);
}
