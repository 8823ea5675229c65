/* Articulations fall asleep and wake as one body does, lie still while they sleep, and do not sleep while a drive moves
 * them. */
#include <algorithm>

#include <tandem/load_scene.h>

#include "tests/catch.h"
#include "tests/physics/articulate.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Settings sleeping_settings()
{
  Settings settings;
  settings.sleeping = true;
  settings.sleep_time = 0.25f;
  return settings;
}

World sleeping_trees(const Scene &scene) { return World(scene, sleeping_settings(), {"serial", {}, false}); }

uint32_t count_asleep(const World &world, uint32_t first, uint32_t end)
{
  uint32_t count = 0;
  for (uint32_t body = first; body < end; ++body) count += world.is_asleep(world.id_of(body));
  return count;
}

/* A chain of rods on hinges with dampers along x, of which the first hangs on the world; or one that is free. */
uint32_t add_chain(Scene &scene, const Point &at, uint32_t links, bool is_free)
{
  const auto first = uint32_t(scene.bodies.size());
  Articulation tree;
  for (uint32_t k = 0; k < links; ++k) {
    add_body(scene, BodyType::dynamic, box_shape(0.22f, 0.08f, 0.1f), {at[0] + 0.5 * k, at[1], at[2]});
    if (k == 0 && is_free) continue;
    tree.joints.push_back(uint32_t(scene.joints.size()));
    connect(scene, JointType::hinge, k == 0 ? no_body : first + k - 1, first + k,
            {at[0] + 0.5 * k - 0.25, at[1], at[2]}, Vector::UnitZ())
        .rotations[0]
        .damping = 0.2f;
  }
  if (is_free) tree.root = first;
  scene.articulations.push_back(tree);
  return first;
}

std::vector<BodyState> states_of(World &world, uint32_t first, uint32_t end)
{
  const std::vector<BodyState> all = world.bodies();
  return {all.begin() + first, all.begin() + end};
}

bool are_same_places(const std::vector<BodyState> &a, const std::vector<BodyState> &b)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const BodyState &one, const BodyState &other) {
    return one.position == other.position && one.orientation == other.orientation;
  });
}

/* A hinge about z in a tree that holds a box to the world at its centre, without gravity. */
Scene turning_box(const JointAxis &axis)
{
  Scene scene = empty_scene();
  scene.gravity = {0, 0, 0};
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {0, 0, 0});
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ()).rotations[0] = axis;
  articulate(scene);
  return scene;
}

} // namespace

TEST_CASE("trees fall asleep as one each, lie still, and wake as one when a body hits them", "[articulations]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  const uint32_t first = add_chain(scene, {0, 0.1, 0}, 5, true), second = add_chain(scene, {0, 0.1, 3}, 5, true);
  const auto ball = uint32_t(scene.bodies.size());
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {1.0, 12, 0});
  World world = sleeping_trees(scene);
  for (int step = 0; step < 60; ++step) {
    world.step();
    const uint32_t asleep = count_asleep(world, first, first + 5);
    REQUIRE((asleep == 0 || asleep == 5));
  }
  REQUIRE(count_asleep(world, first, second + 5) == 10);
  const std::vector<BodyState> lying = states_of(world, first, second + 5);
  int step = 0;
  for (; step < 120 && count_asleep(world, first, first + 5) > 0; ++step) {
    CHECK(are_same_places(states_of(world, first, second + 5), lying));
    world.step();
  }
  CHECK(step < 60);
  CHECK(count_asleep(world, first, first + 5) == 0);
  CHECK(count_asleep(world, second, second + 5) == 5);
  CHECK(!are_same_places(states_of(world, first, first + 5), {lying.begin(), lying.begin() + 5}));
  CHECK(are_same_places(states_of(world, second, second + 5), {lying.begin() + 5, lying.end()}));
  run(world, 600);
  CHECK(count_asleep(world, first, second + 5) == 10);
  CHECK(world.bodies()[ball].position[1] > 0.19f);
  CHECK(open_joints(world).max_distance < 1e-5);
}

TEST_CASE("a chain on a held root hangs asleep, and swings on from a push as one that never slept", "[articulations]")
{
  Scene scene = empty_scene();
  add_chain(scene, {0, 0, 0}, 4, false);
  for (Joint &joint : scene.joints) joint.rotations[0].damping = 3;
  World world = sleeping_trees(scene);
  run(world, 1500);
  REQUIRE(count_asleep(world, 0, 4) == 4);
  World awake(scene, {}, {"serial", {}, false});
  awake.set_states(awake.body_ids(), world.bodies());
  for (World *one : {&world, &awake}) one->add_impulse(one->id_of(3), {.impulse = {0.5f, 0, 0}});
  for (int step = 0; step < 30; ++step) {
    world.step();
    awake.step();
  }
  CHECK(count_asleep(world, 0, 4) == 0);
  for (uint32_t body = 0; body < 4; ++body)
    for (int axis = 0; axis < 3; ++axis)
      CHECK(world.bodies()[body].position[axis] == Approx(awake.bodies()[body].position[axis]).margin(1e-6));
}

TEST_CASE("a drive keeps its tree awake while it moves it, however slowly, and not while it holds it",
          "[articulations]")
{
  World slow = sleeping_trees(turning_box({.target_velocity = 0.02f, .motor = true, .max_force = 10}));
  World creeping = sleeping_trees(turning_box({.target_position = 0.5f, .stiffness = 5, .damping = 100}));
  for (int step = 0; step < 300; ++step) {
    slow.step();
    creeping.step();
    REQUIRE(slow.statistics().asleep == 0);
    REQUIRE(creeping.statistics().asleep == 0);
  }
  CHECK(2 * std::asin(double(slow.bodies()[0].orientation[2])) == Approx(300 * 0.02 / 60).epsilon(0.02));
  World holding = sleeping_trees(turning_box({.motor = true, .max_force = 10}));
  World stopped = sleeping_trees(
      turning_box({.lower = -0.1f, .upper = 0.1f, .target_velocity = 1, .motor = true, .max_force = 10}));
  run(holding, 120);
  run(stopped, 120);
  CHECK(holding.statistics().asleep == 1);
  CHECK(stopped.statistics().asleep == 1);
  const JointId joint = holding.id_of_joint(0);
  holding.set_joint_axis(joint, 3, {.target_velocity = 1, .motor = true, .max_force = 10});
  run(holding, 2);
  CHECK(holding.statistics().asleep == 0);
}

TEST_CASE("a ragdoll in a tree settles and sleeps, with its joints closed", "[articulations]")
{
  Scene scene = load_scene("ragdolls:n=1,height=1", OutsideFiles::refused, Coordinates::reduced);
  World world = sleeping_trees(scene);
  const auto bodies = uint32_t(scene.bodies.size());
  int step = 0;
  for (; step < 1800 && world.statistics().asleep + 1 < bodies; ++step) world.step();
  CAPTURE(step, world.statistics().asleep, bodies);
  CHECK(world.statistics().asleep + 1 == bodies);
  CHECK(open_joints(world).max_distance < 2e-6);
}

TEST_CASE("sleeping trees go on from a snapshot and from kept states with the same bits", "[articulations]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int k = 0; k < 3; ++k) add_chain(scene, {0, 0.1 + 0.4 * k, 2.0 * k}, 4, true);
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0.5, 9, 0});
  World world = sleeping_trees(scene), lanes(scene, sleeping_settings(), {"tbb:threads=2,lanes=8", {}, false});
  world.keep_states(40);
  std::vector<uint64_t> hashes;
  std::vector<uint32_t> asleep;
  bool woke = false;
  for (int step = 0; step < 200; ++step) {
    world.step();
    lanes.step();
    hashes.push_back(world.state_hash());
    asleep.push_back(world.statistics().asleep);
    REQUIRE(hashes.back() == lanes.state_hash());
    woke = woke || (step > 0 && asleep.back() < asleep[size_t(step) - 1]);
    if (step % 20 != 19) continue;
    lanes.restore(world.save());
    const uint32_t back = uint32_t(std::min(step, 35));
    world.go_back(back);
    for (int again = step - int(back) + 1; again <= step; ++again) {
      world.step();
      CAPTURE(step, again);
      REQUIRE(world.state_hash() == hashes[size_t(again)]);
      REQUIRE(world.statistics().asleep == asleep[size_t(again)]);
    }
  }
  CHECK(*std::max_element(asleep.begin(), asleep.end()) > 7);
  CHECK(woke);
}

TEST_CASE("a snapshot has trees that sleep beside what a joint keeps from colliding with them, or has let go",
          "[articulations]")
{
  const bool holds_nothing = GENERATE(true, false);
  Scene scene = empty_scene();
  add_ground(scene);
  add_chain(scene, {0, 0.1, 0}, 3, true);
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0, 30, 0});
  Joint joint;
  joint.type = holds_nothing ? JointType::six_dof : JointType::ball;
  joint.enabled = holds_nothing;
  joint.body_a = 2;
  joint.body_b = 4;
  scene.joints.push_back(joint);
  World world = sleeping_trees(scene);
  run(world, 60);
  REQUIRE(world.statistics().asleep == 3);
  World other(world.save(), {"serial", {}, false});
  run(world, 60);
  run(other, 60);
  CHECK(other.state_hash() == world.state_hash());
}

/* Sleepers make room for it in the buffers. The first body that comes lays them out anew, the second does not. A
 * contact that ends gives its colour back. */
TEST_CASE("a body that comes while a tree sleeps has colours of its own, and the bits of a world that was saved",
          "[articulations]")
{
  Scene scene = empty_scene({0, 0, 0});
  for (const double x : {-1.0, 1.0}) add_body(scene, BodyType::fixed, box_shape(0.5f, 0.5f, 0.5f), {x, 0, 0});
  add_chain(scene, {0, 5, 0}, 3, true);
  Settings settings = sleeping_settings();
  settings.check = true;
  World world(scene, settings, {"serial", {}, false});
  run(world, 60);
  REQUIRE(world.statistics().asleep == 3);
  Body box;
  box.shape = scene.bodies[2].shape;
  for (const double z : {9.0, 0.0}) {
    box.position = {0, 0, z};
    world.create_body(box);
  }
  REQUIRE(world.statistics().asleep == 3);
  World other(world.save(), {"serial", {}, false});
  const BodyId id = world.body_ids().back();
  for (int step = 0; step < 30; ++step) {
    for (World *one : {&world, &other}) {
      if (step % 4 == 0) one->set_velocity(id, {.linear = {step % 8 == 0 ? 12.0f : -12.0f, 0, 0}, .angular = {}});
      one->step();
    }
    CAPTURE(step);
    REQUIRE(other.state_hash() == world.state_hash());
    REQUIRE(world.statistics().colors <= 1);
  }
}

TEST_CASE("a tree that has gone into quarantine is back with the state from before", "[articulations]")
{
  const bool sleeping = GENERATE(false, true);
  Scene scene = empty_scene();
  add_chain(scene, {0, 3, 0}, 3, true);
  Settings settings = sleeping_settings();
  settings.sleeping = sleeping;
  World world(scene, settings, {"serial", {}, false}), other(scene, settings, {"serial", {}, false});
  world.keep_states(10);
  run(world, 3);
  world.set_velocity(world.id_of(0), {.linear = {3e38f, 0, 0}, .angular = {0, 3e38f, 0}});
  run(world, 3);
  REQUIRE(world.quarantined().size() == 3);
  world.go_back(4);
  run(world, 30);
  run(other, 32);
  CHECK(world.state_hash() == other.state_hash());
  CHECK(open_joints(world).max_distance < 1e-5);
}

namespace {

/* A base holds a tree of one box, which sleeps, and another box by a joint that breaks at 100 N and is kept awake until
 * then; a third box is pushed in step 30. */
constexpr uint32_t box_of_tree = 1, box_that_breaks_off = 2, pushed_box = 3;

Scene tree_beside_a_breaking_joint()
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::fixed, box_shape(0.1f, 0.1f, 0.1f), {0, 0, 0});
  for (const Point &at : {Point{1, 0, 0}, Point{-1, 0, 0}, Point{0, 5, 0}, Point{0, 9, 0}})
    add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), at);
  connect(scene, JointType::hinge, 0, box_of_tree, {0.5, 0, 0}, Vector::UnitZ());
  scene.articulations.push_back({"", {0}, no_body, {}});
  connect(scene, JointType::fixed, 0, box_that_breaks_off, {-0.5, 0, 0}).break_force = 100;
  return scene;
}

void push(World &world, uint32_t body, float impulse)
{
  world.add_impulse(world.id_of(body), {.impulse = {0, impulse, 0}, .angular_impulse = {}});
}

/* Returns the step in which the pushed box falls asleep, or 0. */
uint32_t step_with_pushes(World &world, uint32_t from, uint32_t end)
{
  for (uint32_t step = from; step < end; ++step) {
    if (step % 5 == 0) push(world, box_that_breaks_off, 1e-3f);
    if (step == 30) push(world, pushed_box, 1e-3f);
    world.step();
    const auto events = world.sleep_events();
    if (step > 30 && std::any_of(events.begin(), events.end(), [](const SleepEvent &event) {
          return event.asleep && event.body.index == pushed_box;
        }))
      return step;
  }
  return 0;
}

} // namespace

TEST_CASE("a joint that breaks in the step in which another body falls asleep wakes the tree at its base",
          "[articulations]")
{
  const Scene scene = tree_beside_a_breaking_joint();
  World quiet = sleeping_trees(scene), world = sleeping_trees(scene);
  const uint32_t falls = step_with_pushes(quiet, 0, 120);
  REQUIRE(falls > 30);
  REQUIRE(quiet.is_asleep(quiet.id_of(box_of_tree)));
  step_with_pushes(world, 0, falls);
  push(world, box_that_breaks_off, 100);
  world.step();
  REQUIRE(world.joint_breaks().size() == 1);
  CHECK(world.is_asleep(world.id_of(pushed_box)));
  CHECK(!world.is_asleep(world.id_of(box_of_tree)));
  World other(world.save(), {"serial", {}, false});
  run(world, 60);
  run(other, 60);
  CHECK(world.state_hash() == other.state_hash());
  CHECK(world.statistics().asleep == 3);
  CHECK(std::abs(world.bodies()[box_that_breaks_off].position[1]) > 1);
}

TEST_CASE("a ball and a slider of a tree stay awake while a spring moves them, and wake for new numbers alone",
          "[articulations]")
{
  const bool is_ball = GENERATE(true, false);
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {0, 0, 0});
  Joint &joint = connect(scene, is_ball ? JointType::ball : JointType::slider, no_body, 0, Vector::Zero());
  const JointAxis creeps{.target_position = 0.5f, .stiffness = 5, .damping = 100};
  (is_ball ? joint.rotations[1] : joint.directions[0]) = creeps;
  articulate(scene);
  World world = sleeping_trees(scene);
  for (int step = 0; step < 300; ++step) {
    world.step();
    REQUIRE(world.statistics().asleep == 0);
  }
  const uint32_t axis = is_ball ? 4 : 0;
  const JointId id = world.id_of_joint(0);
  JointAxis rests = creeps;
  rests.stiffness = 0;
  world.set_joint_axis(id, axis, rests);
  run(world, 60);
  REQUIRE(world.statistics().asleep == 1);
  world.set_joint_axis(id, axis, rests);
  CHECK(world.statistics().asleep == 1);
  world.step();
  CHECK(world.is_asleep(world.id_of(0)));
  world.set_joint_axis(id, axis, creeps);
  world.step();
  CHECK(!world.is_asleep(world.id_of(0)));
}

/* Whose places in the buffers change as others sleep and wake. */
TEST_CASE("joined links that overlap do not collide after other trees, and their own, have slept", "[articulations]")
{
  Scene scene = empty_scene({0, 0, 0});
  constexpr uint32_t trees = 8;
  for (uint32_t k = 0; k < trees; ++k) {
    for (const double x : {0.0, 0.3})
      add_body(scene, BodyType::dynamic, box_shape(0.25f, 0.25f, 0.25f), {x, 2.0 * k, 0});
    connect(scene, JointType::hinge, 2 * k, 2 * k + 1, {0.15, 2.0 * k, 0}, Vector::UnitZ()).rotations[0].damping = 1;
    scene.joints.back().collide = false;
    scene.articulations.push_back({"", {k}, 2 * k, {}});
    if (k % 3 == 1) scene.bodies[2 * k].angular_velocity = scene.bodies[2 * k + 1].angular_velocity = {0.3f, 0, 0};
  }
  World world = sleeping_trees(scene);
  uint32_t most_asleep = 0, wakings = 0;
  for (uint32_t step = 0; step < 300; ++step) {
    if (step % 40 == 30) {
      const BodyId id = world.id_of(2 * (step / 40 * 3 % trees));
      if (world.is_asleep(id)) ++wakings;
      world.add_impulse(id, {.impulse = {}, .angular_impulse = {0, 0, 0.002f}});
    }
    world.step();
    CAPTURE(step);
    REQUIRE(world.statistics().contacts == 0);
    most_asleep = std::max(most_asleep, world.statistics().asleep);
  }
  CHECK(most_asleep >= 6);
  CHECK(wakings > 2);
  CHECK(open_joints(world).max_distance < 1e-5);
}
