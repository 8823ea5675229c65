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

/* A column that wants 8 substeps, and a pendulum that takes as many, because a rod that never ends joins them. */
Scene column_and_pendulum()
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_laden_column(scene, 0);
  scene.bodies.back().mass = 300;
  const auto ball = uint32_t(scene.bodies.size());
  add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {10, 5, 0});
  Joint rod;
  rod.type = JointType::distance;
  rod.body_a = 1;
  rod.body_b = ball;
  rod.directions[0].lower = 0;
  rod.directions[0].upper = 100;
  scene.joints.push_back(rod);
  connect(scene, JointType::ball, no_body, ball, {8, 5, 0});
  return scene;
}

/* A world that makes each step twice and goes back in between must make the steps of one that goes on. In step 20 its
 * load goes, so that it comes down to four substeps. change: what it does before the step that is gone back from. */
template <class Change> void goes_back_from_each_step(const Scene &scene, const Settings &settings, Change change)
{
  World straight(scene, settings, {}), returning(scene, settings, {});
  returning.keep_states(2);
  for (int step = 0; step < 100; ++step) {
    if (step == 20)
      for (World *world : {&straight, &returning}) world->set_mass(world->id_of(2), 1);
    straight.step();
    returning.step();
    CAPTURE(step);
    REQUIRE(returning.state_hash() == straight.state_hash());
    change(returning);
    returning.step();
    returning.go_back(1);
    REQUIRE(returning.state_hash() == straight.state_hash());
  }
  CHECK(straight.statistics().substeps == 4);
}

const auto no_change = [](World &) {};

/* Must have the same state in each step, and take as many substeps in the next. */
void go_on_alike(World &world, World &other, int steps)
{
  for (int step = 0; step < steps; ++step) {
    world.step();
    other.step();
    CAPTURE(step);
    REQUIRE(other.statistics().substeps == world.statistics().substeps);
    REQUIRE(other.state_hash() == world.state_hash());
  }
}

Scene column_and_rolling_ball()
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_laden_column(scene, 0);
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {20, 0.5, 0}).linear_velocity = {0, 0, 3};
  return scene;
}

Settings apart_and_sleeping()
{
  Settings settings = apart();
  settings.sleeping = true;
  return settings;
}

/* Of a column and a rolling ball: makes it a world of few, in which a box sleeps that wished for many. */
void leave_a_sleeper(World &world)
{
  run(world, 20);
  world.destroy_body(world.id_of(2));
  run(world, 280);
  REQUIRE(world.statistics().asleep == 1);
  REQUIRE(world.statistics().substeps == 4);
}

Body box_at(double x, double y, float mass)
{
  Body body;
  body.shape = 1;
  body.mass = mass;
  body.position = {x, y, 0};
  return body;
}

/* Far from all others. */
void create_laden_column(World &world)
{
  world.create_body(box_at(-60, 0.5, 1));
  world.create_body(box_at(-60, 1.5, 1000));
}

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
  World world(scene, apart_and_sleeping(), {});
  run(world, 200);
  CHECK(world.statistics().asleep == 3);
  world.wake_body(world.body_ids()[2]);
  run(world, 5);
  CHECK(took_more(world) == 2);
  CHECK(1.5 - world.bodies()[2].position[1] < 0.02);
}

TEST_CASE("islands of substeps: going back over a fall of their number leaves the next steps as they were", "[physics]")
{
  const auto set_rod = [](World &world) {
    Joint rod = world.scene().joints[0];
    rod.directions[0].upper = 90;
    world.set_joint(world.id_of_joint(0), rod);
  };
  goes_back_from_each_step(column_and_pendulum(), apart(), no_change);
  goes_back_from_each_step(column_and_pendulum(), apart_and_sleeping(), no_change);
  goes_back_from_each_step(column_and_pendulum(), apart(), set_rod);
}

TEST_CASE("islands of substeps: worlds of one number go back over its fall, too", "[physics]")
{
  Scene scene = column_and_pendulum();
  scene.joints.erase(scene.joints.begin());
  scene.articulations.emplace_back().joints = {0};
  goes_back_from_each_step(scene, apart_and_sleeping(), no_change);
}

TEST_CASE("islands of substeps: restored worlds that all take many fall in the same steps", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_laden_column(scene, 0);
  World world(scene, apart(), {});
  run(world, 20);
  world.set_mass(world.id_of(2), 40);
  run(world, 30);
  World restored(world.save(), Placement{});
  go_on_alike(world, restored, 60);
  CHECK(world.statistics().substeps == 8);
}

TEST_CASE("islands of substeps: chains that swing are restored in the midst of a second of calm", "[physics]")
{
  for (const char *name : {"four-bar:speed=20", "hinge-chain", "ragdolls:n=1"}) {
    CAPTURE(name);
    World world(load_scene(name), apart(), {});
    run(world, 25);
    World restored(world.save(), Placement{});
    go_on_alike(world, restored, 120);
  }
}

/* A world that was restored first looks for islands in few rounds, in which a long chain falls into several. */
TEST_CASE("islands of substeps: an attempt that knows only parts of a chain leaves no trace", "[physics]")
{
  constexpr int links = 40;
  Scene scene = empty_scene();
  for (int k = 0; k < links; ++k) {
    add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {0.5 * (k + 1), 0, 0}).filter_mask = 0;
    connect(scene, JointType::ball, k == 0 ? no_body : uint32_t(k - 1), uint32_t(k), {0.5 * k, 0, 0});
  }
  scene.bodies.back().mass = 20;
  World world(scene, apart(), {});
  run(world, 18);
  for (int step = 0; step < 30; ++step) {
    World restored(world.save(), Placement{});
    go_on_alike(world, restored, 1);
  }
  CHECK(took_more(world) == links);
}

TEST_CASE("islands of substeps: going back to where fewer bodies took many leaves the second of calm", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_laden_column(scene, 0);
  add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {0.4, 5.5, 0});
  World straight(scene, apart(), {}), returning(scene, apart(), {});
  returning.keep_states(2);
  bool has_returned = false;
  for (int step = 0; step < 100; ++step) {
    if (step == 20)
      for (World *world : {&straight, &returning}) world->set_mass(world->id_of(2), 40);
    go_on_alike(straight, returning, 1);
    if (has_returned || took_more(returning) != 2) continue;
    returning.step();
    has_returned = took_more(returning) == 3;
    returning.go_back(1);
  }
  CHECK(has_returned);
  CHECK(straight.statistics().substeps == 8);
}

/* Once the column has gone nothing moves, and only the steps until the number falls are counted. */
TEST_CASE("islands of substeps: the hash of the state tells how long a world has been calm", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_laden_column(scene, 0);
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {20, 5, 0}).gravity_factor = 0;
  connect(scene, JointType::hinge, no_body, 3, {19.5, 5, 0}, Vector::UnitZ());
  scene.articulations.emplace_back().joints = {0};
  World world(scene, apart(), {});
  run(world, 5);
  world.destroy_bodies(std::vector{world.id_of(1), world.id_of(2)});
  run(world, 10);
  for (int step = 0; step < 10; ++step) {
    const uint64_t state = world.state_hash(), bodies = world.body_hash();
    world.step();
    CHECK(world.statistics().substeps == 16);
    CHECK(world.body_hash() == bodies);
    CHECK(world.state_hash() != state);
  }
}

TEST_CASE("islands of substeps: who slept after wishing for many takes few once the loads have gone", "[physics]")
{
  World world(column_and_rolling_ball(), apart_and_sleeping(), {});
  leave_a_sleeper(world);
  world.wake_body(world.id_of(1));
  World restored(world.save(), Placement{});
  go_on_alike(world, restored, 5);
  create_laden_column(world);
  create_laden_column(restored);
  go_on_alike(world, restored, 5);
  CHECK(took_more(world) == 2);
}

TEST_CASE("islands of substeps: a body in the place of one that slept after wishing takes few", "[physics]")
{
  World world(column_and_rolling_ball(), apart_and_sleeping(), {});
  leave_a_sleeper(world);
  world.destroy_body(world.id_of(1));
  world.step();
  world.create_body(box_at(5, 0.5, 1));
  world.create_body(box_at(9, 0.5, 1));
  run(world, 3);
  create_laden_column(world);
  run(world, 5);
  CHECK(took_more(world) == 2);
}

TEST_CASE("islands of substeps: a body in the place of one that was gone back from takes few", "[physics]")
{
  for (const int steps : {3, 4}) { /* the buffers of wishes change sides with each */
    CAPTURE(steps);
    Scene scene = empty_scene();
    add_ground(scene);
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.5, 0});
    World world(scene, apart(), {});
    world.create_body(box_at(-20, 0.5, 1)); /* makes room for others */
    world.keep_states(1, false);
    create_laden_column(world);
    run(world, 4);
    REQUIRE(took_more(world) == 2);
    world.go_back(0);
    run(world, 4);
    world.create_body(box_at(-40, 0.5, 1));
    run(world, steps);
    create_laden_column(world);
    run(world, 4);
    CHECK(took_more(world) == 2);
  }
}

TEST_CASE("islands of substeps: a body of a new kind in the place of one that bore a load takes few", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_laden_column(scene, 0);
  add_laden_column(scene, 20);
  World world(scene, apart(), {});
  run(world, 20);
  world.destroy_bodies(std::vector{world.id_of(1), world.id_of(2)});
  world.step();
  Body ball = box_at(-20, 0.5, 1);
  ball.shape = world.add_shape(sphere_shape(0.5f));
  REQUIRE(world.create_body(ball).index <= 2);
  run(world, 3);
  CHECK(took_more(world) == 2);
}
