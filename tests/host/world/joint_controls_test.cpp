/* Controls of a batch, beside worlds alone whose axes set_joint_axes sets to the same values. */
#include <algorithm>
#include <limits>

#include "host/base/random.h"
#include "tests/host/world/worlds.h"
#include "tests/physics/articulate.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;
using Catch::Matchers::ContainsSubstring;
using tandem::tests::BatchBesideWorlds;

namespace {

/* A cart on a rail, a pole on the cart, a wheel at the end of the pole, a flag that turns about two axes on the cart,
 * and a ball that falls beside them. */
Scene cart_and_pole()
{
  Scene scene = empty_scene();
  for (int i = 0; i < 3; ++i) add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.1f, 0.1f), {0, 1.0 - 0.5 * i, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {3, 0, 0});
  connect(scene, JointType::slider, no_body, 0, {0, 1, 0}).directions[0].damping = 0.5f;
  JointAxis &pole = connect(scene, JointType::hinge, 0, 1, {0, 1, 0}, Vector::UnitZ()).rotations[0];
  pole.stiffness = 3, pole.damping = 0.25f, pole.target_velocity = 0.5f;
  JointAxis &wheel = connect(scene, JointType::hinge, 1, 2, {0, 0, 0}, Vector::UnitZ()).rotations[0];
  wheel.motor = true, wheel.max_force = 2;
  add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {0, 1.5, 0});
  Joint &flag = connect(scene, JointType::six_dof, 0, 4, {0, 1.25, 0});
  flag.held_directions = {true, true, true};
  flag.rotations[0].friction = 0.1f;
  flag.rotations[1].damping = 0.2f, flag.rotations[2].damping = 0.3f, flag.rotations[2].stiffness = 4;
  for (Joint &joint : scene.joints) joint.collide = false;
  return scene;
}

Scene cart_and_pole(bool in_tree)
{
  Scene scene = cart_and_pole();
  if (in_tree) articulate(scene);
  return scene;
}

const std::vector<ControlledAxis> all_kinds{{0, 0, Control::force},
                                            {1, 3, Control::target_position},
                                            {2, 3, Control::target_velocity},
                                            {3, 4, Control::force},
                                            {3, 5, Control::target_position}};

/* Equally many bodies, but other drives, and one joint more. */
std::vector<Scene> scenes_of(bool in_tree)
{
  std::vector<Scene> scenes(4, cart_and_pole(in_tree));
  scenes[1].joints[0].directions[0].damping = 3;
  scenes[1].joints[1].rotations[0].target_velocity = -2;
  connect(scenes[2], JointType::hinge, no_body, 3, {3, 1, 0}, Vector::UnitZ()).rotations[0].damping = 1;
  return scenes;
}

void set_alone(World &world, const ControlledAxis &control, float value)
{
  JointAxisChange change{control.axis, {}};
  const Joint joint = world.scene().joints[control.joint];
  change.to = control.axis < 3 ? joint.directions[control.axis] : joint.rotations[control.axis - 3];
  if (control.what == Control::force) change.to.force = value;
  else if (control.what == Control::target_position) change.to.target_position = value;
  else change.to.target_velocity = value;
  world.set_joint_axis(JointId{control.joint, 1}, change.axis, change.to);
}

/* Sets random values in some worlds of the batch, and in these alone. */
void set_random(BatchBesideWorlds &both, std::span<const ControlledAxis> controls, std::span<const uint32_t> worlds,
                Random &random)
{
  std::vector<float> values;
  for (const uint32_t world : worlds)
    for (const ControlledAxis &control : controls) {
      values.push_back(float(random.uniform(-5, 5)));
      set_alone(*both.alone[world], control, values.back());
    }
  both.batch.set_controls(worlds, values);
}

const std::vector<Actuator> all_actuators{
    {.name = "push", .joint = 0, .axis = 0, .sets = Control::force, .factor = -3, .lower = -2, .upper = 1},
    {.name = "lean", .joint = 1, .axis = 3, .sets = Control::target_position, .offset = 0.1f, .factor = 0.3f},
    {.name = "spin", .joint = 2, .axis = 3, .sets = Control::target_velocity, .factor = 7, .upper = 4},
    {.name = "wave", .joint = 3, .axis = 4, .sets = Control::force, .offset = 1.7f, .factor = 0.1f, .lower = 0}};

/* What the actuator's control stands for, in float. */
float expected_number(const Actuator &actuator, float control)
{
  const float product = actuator.factor * std::min(std::max(control, actuator.lower), actuator.upper);
  return actuator.offset + product;
}

void require_equal_axes(BatchBesideWorlds &both)
{
  for (uint32_t world = 0; world < both.alone.size(); ++world) {
    const Scene one = both.batch.scene(world), other = both.alone[world]->scene();
    REQUIRE(one.joints.size() == other.joints.size());
    for (size_t joint = 0; joint < one.joints.size(); ++joint) {
      CAPTURE(world, joint);
      CHECK(one.joints[joint].directions == other.joints[joint].directions);
      CHECK(one.joints[joint].rotations == other.joints[joint].rotations);
    }
  }
}

} // namespace

TEST_CASE("controls of a batch have the bits that set_joint_axes has alone")
{
  const bool in_tree = GENERATE(false, true);
  CAPTURE(in_tree);
  BatchBesideWorlds both(scenes_of(in_tree), "serial");
  Random random(7);
  both.batch.choose_controls(all_kinds);
  const uint64_t untouched = both.batch.body_hash(0);
  for (int step = 0; step < 6; ++step) {
    set_random(both, all_kinds, std::vector<uint32_t>{0, 1, 2, 3}, random);
    both.step(1);
  }
  CHECK(both.batch.body_hash(0) != untouched);
  CHECK(both.batch.body_hash(0) != both.batch.body_hash(1));
  for (int step = 0; step < 4; ++step) {
    set_random(both, all_kinds, std::vector<uint32_t>{3, 1}, random);
    both.step(1);
  }
  CHECK(both.batch.save(3) == both.alone[3]->save());
  require_equal_axes(both);
  both.reset({0, 3});
  both.step(2);
  require_equal_axes(both);
}

TEST_CASE("controls see what set_joint_axes changes of their axes, and keep what others are")
{
  const bool in_tree = GENERATE(false, true);
  CAPTURE(in_tree);
  BatchBesideWorlds both(std::vector<Scene>(2, cart_and_pole(in_tree)), "serial");
  Random random(11);
  const std::vector<ControlledAxis> forces{{0, 0, Control::force}, {1, 3, Control::force}};
  const std::vector<uint32_t> all{0, 1};
  both.batch.choose_controls(forces);
  set_random(both, forces, all, random);
  both.step(2);
  JointAxisChange stiffer{3, both.batch.scene(1).joints[1].rotations[0]};
  stiffer.to.damping = 2, stiffer.to.target_velocity = -3, stiffer.to.lower = -1, stiffer.to.upper = 1;
  both.batch.set_joint_axes(std::vector<WorldJoint>{{1, 1}}, std::span(&stiffer, 1));
  both.alone[1]->set_joint_axis(JointId{1, 1}, 3, stiffer.to);
  both.step(2);
  set_random(both, forces, all, random);
  both.step(2);
  require_equal_axes(both);
  both.batch.choose_controls(all_kinds);
  set_random(both, all_kinds, all, random);
  both.step(2);
  require_equal_axes(both);
}

TEST_CASE("controls that were set last outlast a body of another tree that is taken out")
{
  BatchBesideWorlds both(std::vector<Scene>(3, cart_and_pole(true)), "serial");
  Random random(3);
  both.batch.choose_controls(all_kinds);
  both.step(1);
  set_random(both, all_kinds, std::vector<uint32_t>{0, 1, 2}, random);
  BodyState state = both.batch.bodies(1)[1];
  state.linear_velocity[0] = std::numeric_limits<float>::quiet_NaN();
  both.batch.set_state_unchecked({1, 1}, state);
  both.batch.step();
  CHECK(both.batch.quarantined(1).size() == 4); /* the tree */
  for (const uint32_t world : {0u, 2u}) {
    both.alone[world]->step();
    CAPTURE(world);
    CHECK(both.batch.state_hash(world) == both.alone[world]->state_hash());
  }
}

TEST_CASE("of a world given twice, the last controls count")
{
  Worlds worlds(cart_and_pole(), 2, {}, {"serial", {}});
  worlds.choose_controls(std::vector<ControlledAxis>{{0, 0, Control::force}});
  worlds.set_controls(std::vector<uint32_t>{1, 1}, std::vector<float>{3, 4});
  CHECK(worlds.scene(1).joints[0].directions[0].force == 4);
  CHECK(worlds.scene(0).joints[0].directions[0].force == 0);
}

TEST_CASE(
    "controls of many worlds are set in parts, with the first of what is wrong named, and the last of a world kept")
{
  constexpr uint32_t count = 700;
  Worlds worlds(cart_and_pole(), count, {}, {"tbb:threads=2", {}});
  worlds.choose_controls(std::vector<ControlledAxis>{{0, 0, Control::force}});
  const auto force_of = [&](uint32_t world) { return worlds.scene(world).joints[0].directions[0].force; };
  std::vector<float> values(count);
  for (uint32_t world = 0; world < count; ++world) values[world] = float(world);
  worlds.set_controls(values);
  for (const uint32_t world : {0u, 255u, 256u, 511u, 699u}) CHECK(force_of(world) == float(world));
  std::vector<float> wrong(count, 1);
  wrong[690] = wrong[300] = wrong[600] = std::numeric_limits<float>::infinity();
  CHECK_THROWS_WITH(worlds.set_controls(wrong), ContainsSubstring("control 0 of world 300 is inf"));
  CHECK(force_of(5) == 5);
  std::vector<uint32_t> order(count);
  for (uint32_t i = 0; i < count; ++i) order[i] = i < count - 1 ? count - 1 - i : 650;
  worlds.set_controls(order, values);
  CHECK(force_of(650) == 699);
  CHECK(force_of(10) == 689);
}

TEST_CASE("controls are refused once their axis has no damping for a force, or a force too large for it")
{
  const bool in_tree = GENERATE(false, true);
  CAPTURE(in_tree);
  Worlds worlds(cart_and_pole(in_tree), 2, {}, {"serial", {}});
  const ControlledAxis force{1, 3, Control::force};
  worlds.choose_controls(std::span(&force, 1));
  const auto become = [&](float damping, float pushed) {
    JointAxisChange change{3, worlds.scene(1).joints[1].rotations[0]};
    change.to.damping = damping, change.to.force = pushed;
    worlds.set_joint_axes(std::vector<WorldJoint>{{1, 1}}, std::span(&change, 1));
  };
  become(0, 0);
  CHECK_THROWS_WITH(worlds.set_controls(std::vector<float>{0, 0}),
                    ContainsSubstring("set_controls: control 0 of world 1: axis 3 has no damping"));
  become(1e-6f, 1e8f);
  CHECK_THROWS_WITH(worlds.set_controls(std::vector<float>{0, 0}),
                    ContainsSubstring("control 0 of world 1: axis 3 has a force too large for its damping"));
  CHECK_THROWS_WITH(worlds.choose_controls(std::span(&force, 1)),
                    ContainsSubstring("world 1: joint 1: axis 3 has a force"));
  become(0.5f, 0);
  worlds.set_controls(std::vector<float>{1, 2});
  worlds.step();
  CHECK(worlds.quarantined(1).empty());
}

TEST_CASE("a controlled force moves a body as Newton says")
{
  Scene scene = empty_scene();
  scene.gravity = {0, 0, 0};
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0, 0}).mass = 4;
  connect(scene, JointType::slider, no_body, 0, {0, 0, 0}).directions[0].damping = 1e-6f;
  if (GENERATE(false, true)) articulate(scene);
  Worlds worlds(scene, 3, {}, {"serial", {}});
  worlds.choose_controls(std::vector<ControlledAxis>{{0, 0, Control::force}});
  worlds.set_controls(std::vector<float>{0, 6, -12});
  for (int step = 0; step < 60; ++step) worlds.step();
  for (const uint32_t world : {0u, 1u, 2u}) {
    const double force = std::array<double, 3>{0, 6, -12}[world];
    CHECK(worlds.bodies(world)[0].linear_velocity[0] == Approx(force / 4).epsilon(1e-4).margin(1e-9));
  }
}

TEST_CASE("controls that cannot be are refused, and change nothing")
{
  Scene scene = cart_and_pole(true);
  add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {5, 0, 0});
  Joint &ball = connect(scene, JointType::ball, no_body, 5, {5, 0, 1});
  for (JointAxis &axis : ball.rotations) axis.stiffness = axis.damping = 1;
  scene.articulations.push_back({});
  scene.articulations.back().joints = {4};
  Worlds worlds(scene, 2, {}, {"serial", {}});
  const auto refuses = [&](const ControlledAxis &control, const char *why) {
    CHECK_THROWS_WITH(worlds.choose_controls(std::span(&control, 1)), ContainsSubstring(why));
  };
  refuses({5, 3, Control::force}, "entry 0: world 0: joint 5: it does not exist; the world has 5 joints");
  refuses({0, 6, Control::force}, "axis 6 does not exist; 0 to 2 are directions, 3 to 5 rotations");
  refuses({0, 3, Control::force}, "axis 3 is not free");
  refuses({0, 0, Control::target_position}, "axis 0 has no stiffness to pull it to a position");
  refuses({2, 3, Control::force}, "axis 3 is a motor, which has no force; control its target_velocity");
  refuses({4, 3, Control::target_position}, "axis 3 is one of a ball of an articulation");
  const std::vector<ControlledAxis> twice{all_kinds[0], all_kinds[1], {0, 0, Control::force}};
  CHECK_THROWS_WITH(worlds.choose_controls(twice), "choose_controls: entries 0 and 2 set the same of one axis; one of "
                                                   "them is needed");
  CHECK_THROWS_WITH(worlds.set_controls(std::vector<float>{1}),
                    ContainsSubstring("1 values for 2 worlds of 0 controls"));
  worlds.choose_controls(all_kinds);
  const std::vector<uint64_t> before = worlds.state_hashes();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(worlds.set_controls(std::vector<float>{1, 1, 1, 1, 1, 1, nan, 1, 1, 1}),
                    ContainsSubstring("set_controls: control 1 of world 1 is nan"));
  CHECK_THROWS_WITH(
      worlds.set_controls(std::vector<float>{1e12f, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
      ContainsSubstring("control 0 of world 0 is 1e+12; at most 5e+11, of its damping 0.5, in size is needed"));
  CHECK_THROWS_WITH(worlds.set_controls(std::vector<uint32_t>{2}, std::vector<float>{1, 1, 1, 1, 1}),
                    ContainsSubstring("set_controls: world 2 does not exist"));
  CHECK(worlds.scene(0).joints[0].directions[0].force == 0);
  CHECK(worlds.state_hashes() == before);
}

TEST_CASE("controls of actuators have the bits of the numbers that they stand for, and end at their ranges")
{
  const bool in_tree = GENERATE(false, true);
  CAPTURE(in_tree);
  std::vector<Scene> scenes = scenes_of(in_tree);
  for (Scene &scene : scenes) scene.actuators = all_actuators;
  BatchBesideWorlds both(scenes, "serial");
  Random random(23);
  both.batch.choose_controls(all_actuators);
  for (int step = 0; step < 6; ++step) {
    std::vector<float> values;
    for (const std::unique_ptr<World> &world : both.alone)
      for (const Actuator &actuator : all_actuators) {
        values.push_back(float(random.uniform(-5, 5)));
        set_alone(*world, {actuator.joint, actuator.axis, actuator.sets}, expected_number(actuator, values.back()));
      }
    both.batch.set_controls(values);
    both.step(1);
  }
  require_equal_axes(both);
  both.batch.set_controls(std::vector<uint32_t>{2}, std::vector<float>{-100, 0, 100, -100});
  const Scene scene = both.batch.scene(2);
  CHECK(scene.joints[0].directions[0].force == 6);
  CHECK(scene.joints[2].rotations[0].target_velocity == 28);
  CHECK(scene.joints[3].rotations[1].force == 1.7f);
}

TEST_CASE("actuators of a batch are those of its scenes, in snapshots, too")
{
  std::vector<Scene> scenes = scenes_of(false);
  for (Scene &scene : scenes) scene.actuators = all_actuators;
  scenes[1].actuators.pop_back();
  BatchBesideWorlds both(scenes, "serial");
  for (uint32_t world = 0; world < scenes.size(); ++world) {
    CAPTURE(world);
    CHECK(both.batch.scene(world).actuators == scenes[world].actuators);
    const std::vector<std::byte> saved = both.batch.save(world);
    CHECK(saved == both.alone[world]->save());
    CHECK(World(saved, Placement{"serial", {}, false}).scene().actuators == scenes[world].actuators);
  }
}

TEST_CASE("a force and both targets of one axis are controls of their own")
{
  const bool in_tree = GENERATE(false, true);
  CAPTURE(in_tree);
  BatchBesideWorlds both(scenes_of(in_tree), "serial");
  Random random(5);
  std::vector<ControlledAxis> controls{
      {1, 3, Control::force}, {1, 3, Control::target_velocity}, {1, 3, Control::target_position}};
  if (GENERATE(false, true)) std::reverse(controls.begin(), controls.end());
  both.batch.choose_controls(controls);
  for (int step = 0; step < 4; ++step) {
    set_random(both, controls, std::vector<uint32_t>{0, 1, 2, 3}, random);
    both.step(1);
  }
  set_random(both, controls, std::vector<uint32_t>{2}, random);
  both.step(1);
  require_equal_axes(both);
}

TEST_CASE("a world takes the controls of its scene's actuators")
{
  Scene scene = cart_and_pole(GENERATE(false, true));
  scene.actuators = all_actuators;
  scene.actuators.push_back({.name = "hurry", .joint = 1, .axis = 3, .sets = Control::target_velocity, .factor = 2});
  World driven(scene, {}, {"serial", {}}), by_axes(scene, {}, {"serial", {}});
  Random random(2);
  for (int step = 0; step < 5; ++step) {
    std::vector<float> controls;
    for (const Actuator &actuator : scene.actuators) {
      controls.push_back(float(random.uniform(-5, 5)));
      set_alone(by_axes, {actuator.joint, actuator.axis, actuator.sets}, expected_number(actuator, controls.back()));
    }
    driven.set_controls(controls);
    driven.step();
    by_axes.step();
    REQUIRE(driven.state_hash() == by_axes.state_hash());
  }
  CHECK_THROWS_WITH(driven.set_controls(std::vector<float>(4)),
                    "set_controls: 4 controls for 5 actuators; one for each is needed");
  const float infinity = std::numeric_limits<float>::infinity();
  CHECK_THROWS_WITH(driven.set_controls(std::vector<float>{0, 0, 0, infinity, 0}),
                    ContainsSubstring("set_controls: control 3 is inf; a finite number is needed"));
}

TEST_CASE("controls of actuators that cannot be are refused in the units of the actuator")
{
  Worlds worlds(cart_and_pole(), 2, {}, {"serial", {}});
  const auto refuses = [&](Actuator actuator, const char *why) {
    CHECK_THROWS_WITH(worlds.choose_controls(std::span<const Actuator>(&actuator, 1)), ContainsSubstring(why));
  };
  refuses({.name = "", .joint = 1, .axis = 5}, "entry 0: world 0: joint 1: axis 5 is not free");
  refuses({.name = "", .joint = 0, .axis = 0, .sets = Control::target_position}, "axis 0 has no stiffness");
  refuses({.name = "", .joint = 0, .axis = 0, .lower = 1, .upper = -1},
          "entry 0: offset 0, factor 1, controls from 1 to -1");
  refuses({.name = "", .joint = 0, .axis = 0, .factor = std::numeric_limits<float>::infinity()}, "factor inf");
  worlds.choose_controls(all_actuators);
  const float infinity = std::numeric_limits<float>::infinity();
  CHECK_THROWS_WITH(worlds.set_controls(std::vector<float>{0, 0, 0, 0, -infinity, 0, 0, 0}),
                    ContainsSubstring("control 0 of world 1 is -inf; at most 5e+11"));
  CHECK_THROWS_WITH(worlds.set_controls(std::vector<float>{0, 0, 0, 1e13f, 0, 0, 0, 0}),
                    ContainsSubstring("control 3 of world 0 is 1e+13, of which its axis gets 1e+12; at most 2e+11"));
}

TEST_CASE("a joint that an actuator drives stays, and its axis stays free")
{
  Scene scene = cart_and_pole();
  scene.actuators = {all_actuators[1]};
  World world(scene, {}, {"serial", {}});
  CHECK_THROWS_WITH(world.destroy_joint(world.id_of_joint(1)),
                    ContainsSubstring("destroy_joints: joint 1: it cannot be destroyed, because actuator 0 drives it"));
  CHECK_THROWS_WITH(world.destroy_body(world.id_of(1)), ContainsSubstring("because actuator 0 drives it"));
  Joint held = scene.joints[1];
  held.type = JointType::fixed;
  held.rotations[0] = {};
  CHECK_THROWS_WITH(world.set_joint(world.id_of_joint(1), held),
                    ContainsSubstring("its type and what it holds cannot change, because actuator 0 drives it"));
  held = scene.joints[1];
  held.rotations[0].stiffness = 9;
  world.set_joint(world.id_of_joint(1), held);
  world.destroy_joint(world.id_of_joint(0));
  CHECK(world.scene().actuators == scene.actuators);
  Worlds worlds(world.scene(), 2, {}, {"serial", {}}); /* whose scenes lack the joint */
  const std::vector<Actuator> there = worlds.scene(0).actuators;
  REQUIRE(there.at(0).joint == 0);
  worlds.choose_controls(there);
  worlds.set_controls(std::vector<float>{0, 0.25f});
  CHECK(worlds.scene(1).joints[0].rotations[0].target_position == number_at(scene.actuators[0], 0.25f));
  CHECK(worlds.scene(1).joints[0].rotations[0].stiffness == 9);
}

namespace {

/* Buffers are laid out anew by the first force, and by a feature that properties bring. */
void lay_out_anew(Worlds &worlds, bool by_force)
{
  const std::vector<WorldBody> body{{1, 3}};
  if (by_force) worlds.add_forces(body, std::vector<Force>{{{1, 0, 0}, {}, {}}});
  else worlds.set_properties(body, std::vector<BodyProperties>{{.linear_damping = 0.1f}});
}

} // namespace

TEST_CASE("controls of all worlds are what they were set to, whatever lays the buffers out anew")
{
  const bool by_force = GENERATE(true, false), in_tree = GENERATE(true, false);
  CAPTURE(by_force, in_tree);
  const std::vector<ControlledAxis> axes{{0, 0, Control::force}};
  Worlds worlds(cart_and_pole(in_tree), 3, {}, {"serial", {}}), told(cart_and_pole(in_tree), 3, {}, {"serial", {}});
  for (Worlds *one : {&worlds, &told}) {
    one->choose_controls(axes);
    one->set_controls(std::vector<float>(3, 3.0f));
    if (one == &told) one->scene(0); /* the scene has them from here on */
    lay_out_anew(*one, by_force);
    one->step();
  }
  CHECK(worlds.state_hashes() == told.state_hashes());
  worlds.set_controls(std::vector<float>(3, -7.0f));
  told.choose_controls(axes);
  told.set_controls(std::vector<float>(3, -7.0f));
  for (Worlds *one : {&worlds, &told}) one->step();
  CHECK(worlds.state_hashes() == told.state_hashes());
}
