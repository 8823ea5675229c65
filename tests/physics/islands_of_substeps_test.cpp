/* Islands that want more than the fewest substeps take them, and no others: what is far from a load has the bits of a
 * world without it. */
#include <algorithm>
#include <cmath>

#include "host/catalog/catalog.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Settings apart() { return settings_with(1.0 / 60, automatic_substeps); }

/* Islands of one contact or of one chain of joints each, whose bits no colour of others decides: a box that slides and
 * turns, one on a platform that moves and turns, a ball that bounces, and a double pendulum that swings against a limit
 * which bounces, with a motor. */
Scene light_islands()
{
  Scene scene = empty_scene();
  add_ground(scene).material = add_material(scene, 0.3f);
  const uint32_t bouncy = add_material(scene, 0.2f, 0.6f);
  Body &slider = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.4f), {0, 0.3, 0});
  slider.linear_velocity = {4, 0, 1};
  slider.angular_velocity = {0, 2, 0};
  Body &platform = add_body(scene, BodyType::kinematic, box_shape(3, 0.2f, 3), {-20, 2, 0});
  platform.linear_velocity = {0.5, 0, 0.25};
  platform.angular_velocity = {0, 0.3f, 0};
  add_body(scene, BodyType::dynamic, box_shape(0.4f, 0.4f, 0.4f), {-19, 2.6, 0.5});
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 3, -20}).material = bouncy;
  const auto first = uint32_t(scene.bodies.size());
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.2f), {20.5, 5, 0}).max_angular_speed = 8;
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {21.5, 5, 0}).linear_damping = 0.1f;
  Joint &upper = connect(scene, JointType::hinge, no_body, first, {20, 5, 0}, Vector::UnitZ());
  upper.rotations[0].lower = -2;
  upper.rotations[0].upper = 0.5f;
  upper.rotations[0].restitution = 0.5f;
  Joint &lower = connect(scene, JointType::hinge, first, first + 1, {21, 5, 0}, Vector::UnitZ());
  lower.rotations[0].motor = true;
  lower.rotations[0].target_velocity = 1;
  lower.rotations[0].max_force = 2;
  return scene;
}

/* A column of 1 kg below 1,000 kg, which wants 16 substeps, from body `first` on. */
void add_laden_column(Scene &scene, double x)
{
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {x, 0.5, 0}).mass = 1;
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {x, 1.5, 0}).mass = 1000;
}

/* A bar of 1 kg on a ball joint carries a ball of 250 kg, which wants 16 substeps. */
void add_laden_bar(Scene &scene, double x)
{
  const auto first = uint32_t(scene.bodies.size());
  add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.5f, 0.1f), {x, 9.5, 0}).mass = 1;
  add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {x, 8.7, 0}).mass = 250;
  scene.bodies.back().filter_mask = 0;
  connect(scene, JointType::ball, no_body, first, {x, 10, 0});
  connect(scene, JointType::ball, first, first + 1, {x, 9, 0});
}

bool are_equal(const BodyState &a, const BodyState &b)
{
  return a.position == b.position && a.orientation == b.orientation && a.linear_velocity == b.linear_velocity &&
         a.angular_velocity == b.angular_velocity;
}

/* J, of motion and of height. */
double energy_of(World &world, const Scene &scene)
{
  double energy = world.statistics().kinetic_energy;
  const std::vector<BodyState> bodies = world.bodies();
  for (size_t i = 1; i < bodies.size(); ++i) energy += double{scene.bodies[i].mass} * gravity * bodies[i].position[1];
  return energy;
}

uint32_t took_more(World &world) { return world.statistics().bodies_with_more_substeps; }

} // namespace

TEST_CASE("islands of substeps: what is far from loads has the bits of a world without them", "[physics]")
{
  Scene laden_scene = light_islands();
  const size_t light = laden_scene.bodies.size();
  add_laden_column(laden_scene, 60);
  add_laden_bar(laden_scene, 80);
  World laden(laden_scene, apart(), {}), without(light_islands(), apart(), {});
  for (int step = 0; step < 120; ++step) {
    laden.step();
    without.step();
    const std::vector<BodyState> here = laden.bodies(), there = without.bodies();
    for (size_t i = 0; i < light; ++i) {
      CAPTURE(step, i);
      REQUIRE(are_equal(here[i], there[i]));
    }
  }
  CHECK(without.statistics().substeps == 4);
  CHECK(took_more(without) == 0);
  CHECK(laden.statistics().substeps == 16);
  CHECK(took_more(laden) == 4);
}

TEST_CASE("islands of substeps: loads beside light islands have the bits of loads alone", "[physics]")
{
  Scene beside_scene = light_islands(), alone_scene = empty_scene();
  add_ground(alone_scene).material = add_material(alone_scene, 0.3f);
  const size_t first = beside_scene.bodies.size();
  for (Scene *scene : {&beside_scene, &alone_scene}) add_laden_column(*scene, 60);
  World beside(beside_scene, apart(), {}), alone(alone_scene, apart(), {});
  for (int step = 0; step < 120; ++step) {
    beside.step();
    alone.step();
    for (size_t i = 0; i < 2; ++i) REQUIRE(are_equal(beside.bodies()[first + i], alone.bodies()[1 + i]));
  }
  CHECK(took_more(beside) == 2);
  CHECK(took_more(alone) == 2);
  CHECK(1.5 - beside.bodies().back().position[1] < 0.02);
}

TEST_CASE("islands of substeps: impulses and forces are those of the step, whoever took how many", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {-10, 0.5, 0}).mass = 3;
  add_laden_column(scene, 0);
  const auto hanging = uint32_t(scene.bodies.size());
  add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {20, 4, 0}).mass = 3;
  connect(scene, JointType::ball, no_body, hanging, {20, 5, 0});
  add_laden_bar(scene, 40);
  Settings settings = apart();
  settings.events = true;
  World world(scene, settings, {});
  run(world, 400);
  REQUIRE(took_more(world) == 4);
  const std::vector<ContactEvent> events = world.contact_events();
  REQUIRE(events.size() == 3);
  const auto impulse_on = [&](uint32_t a, uint32_t b) {
    const auto found =
        std::find_if(events.begin(), events.end(), [&](const ContactEvent &e) { return e.a == a && e.b == b; });
    REQUIRE(found != events.end());
    return double{found->impulse};
  };
  CHECK(std::abs(impulse_on(0, 1) / (3 * gravity / 60) - 1) < 1e-3);
  CHECK(std::abs(impulse_on(0, 2) / (1001 * gravity / 60) - 1) < 1e-3);
  CHECK(std::abs(impulse_on(2, 3) / (1000 * gravity / 60) - 1) < 1e-3);
  const std::vector<JointReading> joints = world.read_joints(world.joint_ids());
  for (const auto &[joint, mass] : {std::pair{0, 3.0}, {1, 251.0}, {2, 250.0}}) {
    CAPTURE(joint);
    CHECK(std::abs(std::abs(joints[size_t(joint)].force[1]) / (mass * gravity) - 1) < 1e-3);
  }
}

TEST_CASE("islands of substeps: a body that falls on a laden island joins it, and leaves it again", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene).material = add_material(scene, 0.5f);
  add_laden_column(scene, 0);
  Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.25f), {-0.6, 4, 0});
  ball.mass = 2;
  ball.linear_velocity = {0.8f, 0, 0};
  World world(scene, apart(), {});
  const double most = energy_of(world, scene);
  uint32_t fewest = UINT32_MAX, highest = 0;
  for (int step = 0; step < 300; ++step) {
    world.step();
    if (step == 0) continue;
    CAPTURE(step);
    fewest = std::min(fewest, took_more(world));
    highest = std::max(highest, took_more(world));
    CHECK(energy_of(world, scene) < most * (1 + 1e-4));
  }
  CHECK(fewest == 2); /* while it flies, and after it has rolled off */
  CHECK(highest == 3);
  CHECK(took_more(world) == 2);
  CHECK(world.bodies()[3].position[1] < 0.3);
  CHECK(1.5 - world.bodies()[2].position[1] < 0.02);
}

TEST_CASE("islands of substeps: an island whose load has gone is back at the fewest after as many seconds as halvings",
          "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_laden_column(scene, 0);
  add_laden_column(scene, 10);
  World world(scene, apart(), {});
  run(world, 5);
  REQUIRE(took_more(world) == 4);
  world.destroy_body(world.body_ids().back());
  run(world, 120);
  CHECK(took_more(world) == 3);
  run(world, 2);
  CHECK(took_more(world) == 2);
  CHECK(world.statistics().substeps == 16);
}

TEST_CASE("islands of substeps: a world with both goes on with the same bits when restored or gone back", "[physics]")
{
  Scene scene = light_islands();
  add_laden_column(scene, 60);
  add_laden_bar(scene, 80);
  World world(scene, apart(), {});
  world.keep_states(2);
  run(world, 10);
  World restored(world.save(), Placement{});
  run(world, 30);
  run(restored, 30);
  CHECK(took_more(world) == 4);
  CHECK(restored.state_hash() == world.state_hash());
  world.go_back(1);
  world.step();
  CHECK(restored.state_hash() == world.state_hash());
}

TEST_CASE("islands of substeps: after the loads have gone, worlds go on with the same bits when restored", "[physics]")
{
  Scene scene = light_islands();
  add_laden_column(scene, 60);
  World world(scene, apart(), {});
  run(world, 5);
  world.destroy_body(world.body_ids().back());
  run(world, 119);
  for (int step = 0; step < 6; ++step) {
    World restored(world.save(), Placement{});
    world.step();
    restored.step();
    CAPTURE(step);
    CHECK(restored.state_hash() == world.state_hash());
  }
  CHECK(world.statistics().substeps == 4);
}

TEST_CASE("islands of substeps: a load on more bodies than there are colours stands beside a light crowd", "[physics]")
{
  /* A slab on 9 x 9 cubes, which bear it past the last colour; 2 t on 1 kg cubes, and as light as these. */
  Scene scene = empty_scene();
  add_ground(scene);
  for (const double x : {0.0, 30.0}) {
    for (int column = 0; column < 9; ++column)
      for (int row = 0; row < 9; ++row)
        add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {x + 1.5 * column, 0.5, 1.5 * row}).mass = 1;
    add_body(scene, BodyType::dynamic, box_shape(7, 0.5f, 7), {x + 6, 1.5, 6}).mass = x > 0 ? 81 : 200000;
  }
  World world(scene, apart(), {});
  run(world, 120);
  CHECK(world.statistics().colors > 63);
  CHECK(took_more(world) == 82);
  CHECK(fastest(world) < 0.05);
  CHECK(1.5 - world.bodies()[82].position[1] < 0.02);
  CHECK(1.5 - world.bodies()[164].position[1] < 0.02);
}

TEST_CASE("islands of substeps: a world with them may sleep and wake", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_laden_column(scene, 0);
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {10, 0.5, 0});
  Settings settings = apart();
  settings.sleeping = true;
  World world(scene, settings, {});
  run(world, 200);
  CHECK(world.statistics().asleep == 3);
  world.wake_body(world.body_ids()[2]);
  run(world, 5);
  CHECK(took_more(world) == 2);
  CHECK(1.5 - world.bodies()[2].position[1] < 0.02);
}
