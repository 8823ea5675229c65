/* Islands that fall asleep and wake: who does, when, and that what sleeps neither moves nor costs anything. */
#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <tandem/world.h>

#include "host/runtime/interface/backend.h"
#include "tests/catch.h"
#include "tests/host/world/bodies.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr int half_second = 30;

/* Boxes of a metre on a floor. Shape 2 is a ball. */
Scene floor_with_boxes(const std::vector<Point> &boxes)
{
  Scene scene;
  scene.name = "boxes on a floor";
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.25f)};
  scene.bodies.resize(1);
  scene.bodies[0].type = BodyType::fixed;
  for (const Point &position : boxes) {
    Body body;
    body.shape = 1;
    body.position = position;
    scene.bodies.push_back(body);
  }
  return scene;
}

/* Columns of three boxes, so far apart that they do not touch. */
std::vector<Point> columns(int count)
{
  std::vector<Point> boxes;
  for (int column = 0; column < count; ++column)
    for (int k = 0; k < 3; ++k) boxes.push_back({3.0 * column, 0.5 + k, 0});
  return boxes;
}

/* Steps until everything sleeps. */
void wait_for_sleep(World &world, uint32_t bodies, int most = 600)
{
  for (int k = 0; k < most && world.statistics().asleep < bodies; ++k) world.step();
  REQUIRE(world.statistics().asleep == bodies);
}

std::set<uint32_t> awake_bodies(const World &world)
{
  std::set<uint32_t> awake;
  for (const BodyId &id : world.body_ids())
    if (world.scene().bodies[id.index].type == BodyType::dynamic && !world.is_asleep(id)) awake.insert(id.index);
  return awake;
}

Body ball_at(const Point &position, const Vec3 &velocity)
{
  Body ball;
  ball.shape = 2;
  ball.position = position;
  ball.linear_velocity = velocity;
  return ball;
}

} // namespace

TEST_CASE("a box at rest falls asleep after half a second, where it is, and not before", "[sanitizer]")
{
  World world(floor_with_boxes({{0, 0.5, 0}}), sleepy(), {"serial", {}});
  const BodyId box = world.id_of(1);
  for (int k = 0; k < half_second; ++k) {
    CHECK_FALSE(world.is_asleep(box));
    world.step();
  }
  for (int k = 0; k < 10 && !world.is_asleep(box); ++k) world.step(); /* it settles by a fraction of a millimetre */
  REQUIRE(world.is_asleep(box));
  REQUIRE(world.sleep_events().size() == 1);
  CHECK((world.sleep_events().front().body == box && world.sleep_events().front().asleep));
  const BodyState asleep = world.read_body(box);
  CHECK(asleep.linear_velocity == Vec3{0, 0, 0});
  CHECK(asleep.position[1] == Approx(0.5).margin(0.006));
  for (int k = 0; k < 100; ++k) world.step();
  CHECK(world.sleep_events().empty());
  CHECK(world.read_body(box).position == asleep.position);
  CHECK(world.statistics().steps > 100);
}

TEST_CASE("without the setting nobody sleeps, and no kernel of it is launched", "[sanitizer]")
{
  World world(floor_with_boxes({{0, 0.5, 0}}), {}, {"serial", {}});
  for (int k = 0; k < 60; ++k) world.step();
  CHECK(world.statistics().asleep == 0);
  for (const Kernel kernel : world.kernels()) CHECK(row_of(kernel).stage != Stage::sleeping);
  CHECK_FALSE(world.is_asleep(world.id_of(1)));
}

TEST_CASE("a body that moves steadily never falls asleep, however slowly it turns or slides", "[sanitizer]")
{
  Scene scene = floor_with_boxes({{0, 5, 0}, {5, 5, 0}});
  scene.gravity = {0, 0, 0};
  scene.bodies[1].linear_velocity = {0.06f, 0, 0};
  scene.bodies[2].angular_velocity = {0, 0.07f, 0}; /* its corners move at 0.06 m/s */
  World world(scene, sleepy(), {"serial", {}});
  for (int k = 0; k < 120; ++k) world.step();
  CHECK(world.statistics().asleep == 0);
  CHECK(world.bodies()[1].position[0] == Approx(0.06 * 2).epsilon(1e-4));
  scene.bodies[1].linear_velocity = {0.04f, 0, 0};
  scene.bodies[2].angular_velocity = {0, 0.04f, 0};
  World slower(scene, sleepy(), {"serial", {}});
  for (int k = 0; k < 120; ++k) slower.step();
  CHECK(slower.statistics().asleep == 2);
}

TEST_CASE("a world in which all bodies sleep launches nothing, until a call comes", "[sanitizer]")
{
  World world(floor_with_boxes(columns(3)), sleepy(), {"serial", {}});
  wait_for_sleep(world, 9);
  size_t launches = 0;
  world.set_observer([&](const Launch &) { ++launches; });
  const uint64_t steps = world.statistics().steps, hash = world.state_hash();
  for (int k = 0; k < 50; ++k) world.step();
  CHECK(launches == 0);
  CHECK(world.statistics().steps == steps + 50);
  CHECK(world.state_hash() == hash);
  world.add_impulse(world.id_of(3), {{0, 2, 0}});
  world.step();
  CHECK(launches > 0);
  CHECK(world.statistics().asleep == 6);
}

/* The closed form of one substep is gravity and the impulse; nothing of the sleep remains in the velocity. */
TEST_CASE("an impulse wakes the island of its body alone, and acts as on a body that never slept", "[sanitizer]")
{
  World world(floor_with_boxes(columns(3)), sleepy(), {"serial", {}});
  wait_for_sleep(world, 9);
  world.add_impulse(world.id_of(6), {{0, 5, 0}}); /* the top of the second column; 5 m/s */
  CHECK(world.statistics().asleep == 6);          /* the figures apply the call */
  CHECK(world.read_body(world.id_of(6)).linear_velocity == Vec3{0, 5, 0});
  world.step();
  CHECK(awake_bodies(world) == std::set<uint32_t>{4, 5, 6});
  CHECK(world.read_body(world.id_of(6)).linear_velocity[1] == Approx(5 - 10.0 / 60).epsilon(1e-5));
  REQUIRE(world.sleep_events().size() == 3);
  for (const SleepEvent &event : world.sleep_events()) CHECK_FALSE(event.asleep);
}

TEST_CASE("forces, velocities and poses that are set wake, and reading does not", "[sanitizer]")
{
  World world(floor_with_boxes(columns(4)), sleepy(), {"serial", {}});
  wait_for_sleep(world, 12);
  world.read_body(world.id_of(1));
  world.bodies();
  world.statistics();
  world.cast_rays(std::vector<Ray>{{{0, 10, 0}, {0, -20, 0}, 1, {}}});
  CHECK(world.statistics().asleep == 12);
  world.add_force(world.id_of(1), {{0, 1, 0}});
  CHECK(world.statistics().asleep == 9);
  world.set_velocity(world.id_of(4), {});
  CHECK(world.statistics().asleep == 6);
  world.set_state(world.id_of(9), world.read_body(world.id_of(9)));
  CHECK(world.statistics().asleep == 3);
  world.wake_body(world.id_of(12));
  CHECK(world.statistics().asleep == 0);
  CHECK_THROWS_WITH(world.wake_body(BodyId{99, 1}), ContainsSubstring("wake_bodies: there is no body 99"));
  wait_for_sleep(world, 12);
}

TEST_CASE("a ball that falls on one of several sleeping heaps wakes that heap alone", "[sanitizer]")
{
  Scene scene = floor_with_boxes(columns(4));
  World world(scene, sleepy(), {"serial", {}});
  wait_for_sleep(world, 12);
  const BodyId ball = world.create_body(ball_at({6, 5, 0}, {0, -5, 0}));
  std::set<uint32_t> woken;
  for (int k = 0; k < 40; ++k) {
    world.step();
    for (const SleepEvent &event : world.sleep_events())
      if (!event.asleep) woken.insert(event.body.index);
  }
  CHECK(woken == std::set<uint32_t>{7, 8, 9});
  CHECK(world.read_body(ball).position[1] > 2.9); /* it came to lie on the column */
}

TEST_CASE("a ball that passes a sleeping box by a centimetre does not wake it, and one that grazes it does",
          "[sanitizer]")
{
  for (const bool touches : {false, true}) {
    Scene scene = floor_with_boxes({{0, 0.5, 0}});
    World world(scene, sleepy(), {"serial", {}});
    wait_for_sleep(world, 1);
    Body ball = ball_at({-3, 0.6, touches ? 0.74 : 0.76}, {6, 0, 0});
    ball.gravity_factor = 0;
    world.create_body(ball);
    bool woke = false;
    for (int k = 0; k < 60; ++k) {
      world.step();
      woke = woke || !world.is_asleep(world.id_of(1));
    }
    CAPTURE(touches);
    CHECK(woke == touches);
    CHECK(world.bodies()[2].position[0] > 1.5); /* it passed */
  }
}

TEST_CASE("what loses its support wakes and falls", "[sanitizer]")
{
  World world(floor_with_boxes(columns(2)), sleepy(), {"serial", {}});
  wait_for_sleep(world, 6);
  world.destroy_body(world.id_of(1));
  world.step();
  CHECK(awake_bodies(world) == std::set<uint32_t>{2, 3});
  for (int k = 0; k < 60; ++k) world.step();
  CHECK(world.bodies()[2].position[1] == Approx(0.5).margin(0.02));

  World without_floor(floor_with_boxes(columns(2)), sleepy(), {"serial", {}});
  wait_for_sleep(without_floor, 6);
  without_floor.destroy_body(without_floor.id_of(0));
  for (int k = 0; k < 60; ++k) without_floor.step();
  for (uint32_t body = 1; body < 7; ++body)
    CHECK(without_floor.bodies()[body].position[1] == Approx(0.5 + (body - 1) % 3 - 5.0).margin(0.03)); /* 10 / 2 */
}

/* On the moon a body falls for a while before it is faster than what counts as rest. */
TEST_CASE("what loses its support in the step before it would sleep falls all the same", "[address]")
{
  for (int last = half_second - 3; last < half_second + 12; ++last) {
    Scene scene = floor_with_boxes({{0, 0.5, 0}, {0, 1.5, 0}});
    scene.gravity = {0, -1.62f, 0};
    World world(scene, sleepy(), {"serial", {}});
    for (int k = 0; k < last; ++k) world.step();
    world.destroy_body(world.id_of(1));
    for (int k = 0; k < 120; ++k) world.step();
    CAPTURE(last);
    CHECK(world.bodies()[2].position[1] == Approx(0.5).margin(0.02));
  }
}

TEST_CASE("a kinematic platform wakes what it carries when it starts to move, and a resting one lets it sleep",
          "[sanitizer]")
{
  Scene scene = floor_with_boxes({{0, 2.5, 0}, {8, 0.5, 0}});
  Body platform;
  platform.type = BodyType::kinematic;
  platform.shape = 1;
  platform.position = {0, 1.5, 0};
  scene.bodies.push_back(platform);
  World world(scene, sleepy(), {"serial", {}});
  wait_for_sleep(world, 2);
  world.set_velocity(world.id_of(3), {{0, 1, 0}, {0, 0, 0}});
  for (int k = 0; k < 60; ++k) world.step();
  CHECK(awake_bodies(world) == std::set<uint32_t>{1});
  CHECK(world.bodies()[1].position[1] == Approx(3.5).margin(0.02)); /* carried for a second */
  world.set_velocity(world.id_of(3), {});
  wait_for_sleep(world, 2);
  world.set_state(world.id_of(3), {{20, 1.5, 0}, {0, 0, 0, 1}, {0, 0, 0}, {0, 0, 0}}); /* taken away from below it */
  for (int k = 0; k < 90; ++k) world.step();
  CHECK(world.bodies()[1].position[1] == Approx(0.5).margin(0.02));
}

TEST_CASE("a change of gravity wakes all, and bodies fall as it says", "[sanitizer]")
{
  World world(floor_with_boxes(columns(2)), sleepy(), {"serial", {}});
  wait_for_sleep(world, 6);
  world.set_gravity({0, 2, 0});
  CHECK(world.statistics().asleep == 0);
  const double start = world.bodies()[3].position[1];
  for (int k = 0; k < 60; ++k) world.step();
  /* half of 2 m/s^2, for a second; penetrations that the weight had made push a little */
  CHECK(world.bodies()[3].position[1] - start == Approx(1).margin(0.03));
  const float infinite = std::numeric_limits<float>::infinity();
  CHECK_THROWS_WITH(world.set_gravity({0, infinite, 0}), ContainsSubstring("set_gravity: gravity is"));
}

/* Contacts are remembered while a stack sleeps, so that it wakes as it was. */
TEST_CASE("a column wakes warm: it neither sinks nor jumps, and its contacts go on", "[sanitizer]")
{
  std::vector<Point> column;
  for (int k = 0; k < 10; ++k) column.push_back({0, 0.5 + k, 0});
  Settings settings = sleepy();
  settings.events = true;
  settings.pair_events = true;
  World world(floor_with_boxes(column), settings, {"serial", {}});
  wait_for_sleep(world, 10);
  const std::vector<BodyState> before = world.bodies();
  CHECK_FALSE(world.contact_events().empty()); /* of the step in which they fell asleep */
  world.step();
  CHECK(world.contact_events().empty());
  world.wake_body(world.id_of(1));
  for (int k = 0; k < 20; ++k) {
    world.step();
    for (const ContactEvent &event : world.contact_events()) REQUIRE(event.kind == ContactEvent::Kind::persist);
    for (const PairEvent &event : world.pair_events()) REQUIRE(event.kind == ContactEvent::Kind::persist);
    CHECK(world.contact_events().size() == 10);
    for (uint32_t body = 1; body < 11; ++body)
      REQUIRE(world.bodies()[body].position[1] == Approx(before[body].position[1]).margin(2e-4));
  }
}

TEST_CASE("poses agree with those of a world that never sleeps where nothing would have moved", "[sanitizer]")
{
  Settings awake;
  World without(floor_with_boxes(columns(5)), awake, {"serial", {}}),
      with(floor_with_boxes(columns(5)), sleepy(), {"serial", {}});
  for (int k = 0; k < 600; ++k) without.step(), with.step();
  CHECK(with.statistics().asleep == 15);
  for (uint32_t body = 0; body < 16; ++body)
    for (int axis = 0; axis < 3; ++axis)
      CHECK(with.bodies()[body].position[axis] == Approx(without.bodies()[body].position[axis]).margin(awake.slop));
}

TEST_CASE("queries find sleeping bodies as if they were awake, with every structure", "[sanitizer]")
{
  std::vector<Ray> rays;
  for (int k = 0; k < 40; ++k) rays.push_back({{0.37 * k - 2, 10, 0.1}, {0.3f, -12, 0.1f}, 1, {}});
  for (const Broadphase broadphase : {Broadphase::grid, Broadphase::bvh, Broadphase::brute_force}) {
    Settings settings = sleepy();
    settings.broadphase = broadphase;
    Scene scene = floor_with_boxes(columns(4));
    World world(scene, settings, {"serial", {}});
    wait_for_sleep(world, 12);
    world.wake_body(world.id_of(4));
    world.step();
    const std::vector<BodyState> states = world.bodies();
    for (size_t body = 0; body < scene.bodies.size(); ++body) {
      scene.bodies[body].position = states[body].position;
      scene.bodies[body].orientation = states[body].orientation;
    }
    World same(scene, {}, {"serial", {}});
    const std::vector<RayHit> hits = world.cast_rays(rays), expected = same.cast_rays(rays);
    for (size_t k = 0; k < rays.size(); ++k) {
      CAPTURE(broadphase, k);
      CHECK(hits[k].body == expected[k].body);
      CHECK(hits[k].fraction == expected[k].fraction);
    }
    for (int k = 0; k < 60; ++k) world.step(); /* queries leave the step's own structures usable */
    CHECK(world.statistics().asleep == 12);
  }
}

/* A reference by union-find over the contacts that the step reported. */
TEST_CASE("islands are what union-find makes of the contacts", "[sanitizer]")
{
  std::vector<Point> boxes;
  for (int x = 0; x < 12; ++x)
    for (int z = 0; z < 12; ++z)
      if ((x * 7 + z * 5) % 3 != 0) boxes.push_back({1.0 * x, 0.5, 1.0 * z}); /* side by side where both are there */
  Settings settings = sleepy();
  settings.events = true;
  World world(floor_with_boxes(boxes), settings, {"serial", {}});
  std::vector<ContactEvent> contacts;
  for (int k = 0; k < 300 && world.statistics().asleep < boxes.size(); ++k) {
    world.step();
    if (!world.contact_events().empty()) contacts = world.contact_events();
  }
  REQUIRE(world.statistics().asleep == boxes.size());
  std::vector<uint32_t> parent(boxes.size() + 1);
  for (uint32_t body = 0; body < parent.size(); ++body) parent[body] = body;
  const auto root = [&](uint32_t body) {
    while (parent[body] != body) body = parent[body];
    return body;
  };
  for (const ContactEvent &contact : contacts)
    if (contact.a != 0) parent[root(contact.b)] = root(contact.a);
  std::set<uint32_t> roots;
  for (uint32_t body = 1; body < parent.size(); ++body) roots.insert(root(body));
  CHECK(roots.size() > 1);
  /* contacts ahead of touching join too, and rows that are a metre apart do not */
  CHECK(world.statistics().sleeping_islands <= roots.size());
  CHECK(world.statistics().sleeping_islands > 1);
  const uint32_t first = *roots.begin();
  world.wake_body(world.id_of(first));
  for (uint32_t body = 1; body < parent.size(); ++body)
    if (root(body) == first) CHECK_FALSE(world.is_asleep(world.id_of(body)));
  CHECK(world.statistics().asleep > 0);
}

TEST_CASE("bodies that come while others sleep leave them asleep, also if the buffers grow", "[sanitizer]")
{
  World world(floor_with_boxes(columns(3)), sleepy(), {"serial", {}});
  wait_for_sleep(world, 9);
  const std::vector<BodyState> before = world.bodies();
  world.create_body(ball_at({0, 0.25, 20}, {0, 0, 0}));
  for (int k = 0; k < 10; ++k) world.step();
  CHECK(world.bodies()[10].position[1] == Approx(0.25).margin(0.006));
  for (int k = 0; k < 200; ++k) world.create_body(ball_at({2.0 * k, 0.25, 30}, {0, 0, 0}));
  for (int k = 0; k < 120; ++k) world.step();
  CHECK(world.statistics().asleep == 210);
  for (uint32_t body = 1; body < 10; ++body)
    CHECK(world.bodies()[body].position[1] == Approx(before[body].position[1]).margin(1e-3));
}

TEST_CASE("settings of sleep that make no sense are refused")
{
  Settings settings = sleepy();
  settings.sleep_time = 0;
  CHECK_THROWS_WITH(validate(settings), ContainsSubstring("sleep time"));
  settings = sleepy();
  settings.sleep_speed = -1;
  CHECK_THROWS_WITH(validate(settings), ContainsSubstring("sleep speed"));
}
