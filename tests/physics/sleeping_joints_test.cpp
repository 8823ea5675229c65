/* Joined bodies fall asleep and wake together, hang after it as before, and do not sleep while a drive moves them. */
#include <algorithm>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr int half_second = 30;

Settings sleeping_settings()
{
  Settings settings;
  settings.sleeping = true;
  return settings;
}

World sleeping_world(const Scene &scene) { return World(scene, sleeping_settings(), {"serial", {}, false}); }

/* Whose swinging ends soon. */
Body &add_damped(Scene &scene, const Shape &shape, const Point &at)
{
  Body &body = add_body(scene, BodyType::dynamic, shape, at);
  body.linear_damping = body.angular_damping = 3;
  return body;
}

/* A chain of balls that hangs from the world at (x, 0, 0). Returns the first of them. */
uint32_t hang_chain(Scene &scene, double x, uint32_t links, double lean = 0.1)
{
  const auto first = uint32_t(scene.bodies.size());
  for (uint32_t k = 0; k < links; ++k) {
    const double y = -0.25 - 0.5 * k;
    add_damped(scene, sphere_shape(0.2f), {x - lean * y, y, 0});
    connect(scene, JointType::ball, k == 0 ? no_body : first + k - 1, first + k,
            Vector(x - lean * (y + 0.25), y + 0.25, 0));
  }
  return first;
}

bool sleep_all(const World &world, uint32_t first, uint32_t end)
{
  for (uint32_t body = first; body < end; ++body)
    if (!world.is_asleep(world.id_of(body))) return false;
  return true;
}

bool are_all_awake(const World &world, uint32_t first, uint32_t end)
{
  for (uint32_t body = first; body < end; ++body)
    if (world.is_asleep(world.id_of(body))) return false;
  return true;
}

/* m/s, of a ball of a chain. */
double fastest_point(World &world)
{
  double speed = 0;
  for (const BodyState &body : world.bodies())
    speed = std::max(speed, vector_of(body.linear_velocity).norm() + 0.2 * vector_of(body.angular_velocity).norm());
  return speed;
}

std::vector<Point> places_of(World &world)
{
  std::vector<Point> places;
  for (const BodyState &body : world.bodies()) places.push_back(body.position);
  return places;
}

/* A box that a hinge about z holds to the world at its centre, without gravity. */
Scene turning_box(const JointAxis &axis)
{
  Scene scene = empty_scene();
  scene.gravity = {0, 0, 0};
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {0, 0, 0});
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ()).rotations[0] = axis;
  return scene;
}

} // namespace

TEST_CASE("a chain that hangs falls asleep as one, and wakes as one without a jolt")
{
  Scene scene = empty_scene();
  hang_chain(scene, 0, 12);
  World world = sleeping_world(scene);
  int step = 0;
  for (; step < 900 && world.statistics().asleep == 0; ++step) world.step();
  REQUIRE(step > half_second);
  REQUIRE(sleep_all(world, 0, 12));
  const std::vector<Point> hanging = places_of(world);
  run(world, 60);
  CHECK(places_of(world) == hanging);

  world.wake_bodies(std::vector<BodyId>{world.id_of(7)});
  CHECK(are_all_awake(world, 0, 12));
  double jolt = 0;
  for (int k = 0; k < half_second - 2; ++k) {
    world.step();
    jolt = std::max(jolt, fastest_point(world));
  }
  CHECK(jolt < 0.1 * double(world.settings().sleep_speed)); /* a link without its impulses gains 0.16 m/s in a step */
  run(world, 10);
  CHECK(sleep_all(world, 0, 12));

  world.add_impulse(world.id_of(11), {.impulse = {1, 0, 0}});
  world.step();
  CHECK(are_all_awake(world, 0, 12));
  CHECK(world.sleep_events().size() == 12);
  CHECK(fastest_point(world) > double(world.settings().sleep_speed));
  CHECK(open_joints(world).max_distance < 1e-2);
}

TEST_CASE("a pendulum in motion does not fall asleep at its turning points")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0.3, -0.95, 0});
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  World world = sleeping_world(scene);
  int slow_steps = 0;
  for (int k = 0; k < 600; ++k) {
    world.step();
    if (fastest_point(world) < double(world.settings().sleep_speed)) ++slow_steps;
    REQUIRE(world.statistics().asleep == 0);
  }
  CHECK(slow_steps > 4);
}

TEST_CASE("two chains sleep and wake independently, though both hang from one fixed body")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, box_shape(3, 0.1f, 0.5f), {0, 1, 0});
  hang_chain(scene, -1.5, 6);
  hang_chain(scene, 1.5, 6);
  for (Joint &joint : scene.joints)
    if (joint.body_a == no_body) {
      joint.body_a = 0;
      joint.position_a[1] -= 1;
    }
  World world = sleeping_world(scene);
  run(world, 900);
  REQUIRE(sleep_all(world, 1, 13));
  const std::vector<Point> before = places_of(world);
  world.add_impulse(world.id_of(9), {.impulse = {0, 0, 0.5f}});
  run(world, 20);
  CHECK(sleep_all(world, 1, 7));
  CHECK(are_all_awake(world, 7, 13));
  CHECK(places_of(world)[3] == before[3]);
  run(world, 900);
  CHECK(sleep_all(world, 1, 13));
}

TEST_CASE("a chain wakes in the step in which debris touches it, and lies still again with it")
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (uint32_t k = 0; k < 8; ++k) {
    add_damped(scene, box_shape(0.24f, 0.1f, 0.2f), {0.5 * k, 0.1, 0});
    if (k > 0) connect(scene, JointType::hinge, k, k + 1, Vector(0.5 * k - 0.25, 0.1, 0), Vector::UnitZ());
  }
  add_damped(scene, box_shape(0.2f, 0.2f, 0.2f), {1.6, 4, 0});
  World world = sleeping_world(scene);
  run(world, 55);
  REQUIRE(sleep_all(world, 1, 9));
  int step = 0;
  for (; step < 100 && world.is_asleep(world.id_of(8)); ++step) world.step();
  CHECK(step < 60);
  CHECK(are_all_awake(world, 1, 9));
  CHECK(world.sleep_events().size() == 8);
  run(world, 400);
  CHECK(world.statistics().asleep == 9);
  CHECK(open_joints(world).max_distance < 2e-3);
}

TEST_CASE("a motor keeps its body awake while it turns, however slowly, and not while it is held")
{
  World slow = sleeping_world(turning_box({.target_velocity = 0.02f, .motor = true, .max_force = 10}));
  REQUIRE(0.6 * 0.02 < double(slow.settings().sleep_speed)); /* at rest, but for the drive */
  for (int k = 0; k < 300; ++k) {
    slow.step();
    REQUIRE(slow.statistics().asleep == 0);
  }
  CHECK(2 * std::asin(double(slow.bodies()[0].orientation[2])) == Approx(300 * 0.02 / 60).epsilon(0.02));

  World stopped = sleeping_world(
      turning_box({.lower = -0.1f, .upper = 0.1f, .target_velocity = 1, .motor = true, .max_force = 10}));
  run(stopped, 120);
  CHECK(stopped.statistics().asleep == 1);
  World holding = sleeping_world(turning_box({.motor = true, .max_force = 10}));
  run(holding, 60);
  CHECK(holding.statistics().asleep == 1);
}

TEST_CASE("a spring keeps its body awake while it moves it, however slowly, and not at its rest or under a load")
{
  /* an overdamped one: the angle goes as exp(-t stiffness / damping) */
  World creeping = sleeping_world(turning_box({.target_position = 0.5f, .stiffness = 5, .damping = 100}));
  REQUIRE(0.6 * 0.5 * 0.05 < double(creeping.settings().sleep_speed));
  for (int k = 0; k < 900; ++k) {
    creeping.step();
    REQUIRE(creeping.statistics().asleep == 0);
  }
  CHECK(2 * std::asin(double(creeping.bodies()[0].orientation[2])) ==
        Approx(0.5 * (1 - std::exp(-0.75))).epsilon(0.05));

  Scene loaded = empty_scene();
  add_body(loaded, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), {0, 0, 0});
  connect(loaded, JointType::slider, no_body, 0, Vector::Zero(), Vector::UnitY()).directions[0] = {.stiffness = 100,
                                                                                                   .damping = 20};
  World hanging = sleeping_world(loaded);
  run(hanging, 300);
  CHECK(hanging.statistics().asleep == 1);
  CHECK(hanging.bodies()[0].position[1] == Approx(-0.01 * gravity).epsilon(0.02));
}

TEST_CASE("what is joined to a kinematic body is awake while that moves, and wakes when it begins to")
{
  Scene scene = empty_scene();
  scene.gravity = {0, 0, 0};
  add_body(scene, BodyType::kinematic, box_shape(0.2f, 0.2f, 0.2f), {0, 0, 0}).linear_velocity = {0.01f, 0, 0};
  add_damped(scene, box_shape(0.2f, 0.2f, 0.2f), {1, 0, 0});
  connect(scene, JointType::fixed, 0, 1, Vector(0.5, 0, 0));
  World world = sleeping_world(scene);
  run(world, 200);
  CHECK(world.statistics().asleep == 0);
  world.set_velocity(world.id_of(0), {});
  run(world, 200);
  CHECK(world.statistics().asleep == 1);
  world.set_velocity(world.id_of(0), {{0.5f, 0, 0}, {}});
  world.step();
  CHECK(world.statistics().asleep == 0);
  run(world, 60);
  CHECK(open_joints(world).max_distance < 5e-3);
}

/* Whose places in the buffers change as others sleep and wake. */
TEST_CASE("joined bodies that overlap do not collide after others, and they themselves, have slept")
{
  Scene scene = empty_scene({0, 0, 0});
  constexpr uint32_t pairs = 8;
  for (uint32_t k = 0; k < pairs; ++k) {
    for (const double x : {0.0, 0.3}) add_damped(scene, box_shape(0.25f, 0.25f, 0.25f), {x, 2.0 * k, 0});
    connect(scene, k % 2 ? JointType::fixed : JointType::ball, 2 * k, 2 * k + 1, {0.15, 2.0 * k, 0});
    if (k % 3) scene.bodies[2 * k].angular_velocity = {0.3f * float(k), 0, 0}; /* some are awake for longer */
  }
  World world = sleeping_world(scene);
  uint32_t most_asleep = 0, wakings = 0;
  for (uint32_t step = 0; step < 600; ++step) {
    if (step % 60 == 50) {
      const BodyId id = world.id_of(2 * (step / 60 * 3 % pairs));
      if (world.is_asleep(id)) ++wakings;
      world.add_impulse(id, {.impulse = {}, .angular_impulse = {0, 0, 0.002f}});
    }
    world.step();
    CAPTURE(step);
    REQUIRE(world.statistics().contacts == 0);
    most_asleep = std::max(most_asleep, world.statistics().asleep);
  }
  CHECK(most_asleep == 2 * pairs);
  CHECK(wakings > 3);
  CHECK(open_joints(world).max_distance < 1e-3);
}
