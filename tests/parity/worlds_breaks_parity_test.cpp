/* Joints of a batch that break: each world's by themselves, with the bits of the world alone, and whole again after a
 * reset. */
#include <ranges>

#include "tests/host/runtime/opencl/pocl.h"
#include "tests/host/world/worlds.h"
#include "tests/parity/articulations.h"

namespace tandem::parity {
namespace {

using namespace physics_tests;
using tests::BatchBesideWorlds;

/* A net of balls that hangs on posts over a heap, with joints of different strength, which boxes fall through. */
Scene weak_net(float strength, float speed)
{
  Scene scene = empty_scene();
  add_ground(scene);
  constexpr uint32_t side = 5;
  const auto number = [](uint32_t i, uint32_t k) { return 1 + i * side + k; };
  for (uint32_t i = 0; i < side; ++i)
    for (uint32_t k = 0; k < side; ++k)
      add_body(scene, i == 0 && k % 2 == 0 ? BodyType::fixed : BodyType::dynamic, sphere_shape(0.3f),
               {0.62 * i, 2, 0.62 * k});
  for (uint32_t i = 1; i < side; ++i)
    for (uint32_t k = 0; k < side; ++k) {
      const Vector at(0.62 * i, 2, 0.62 * k);
      Joint &along = connect(scene, k % 2 ? JointType::ball : JointType::hinge, number(i - 1, k), number(i, k),
                             at - Vector(0.31, 0, 0), Vector::UnitZ());
      along.break_force = strength * float(30 + 7 * ((i * 5 + k) % 11));
      along.collide = k % 3 == 0;
      if (k % 2 == 0) along.rotations[0] = {.target_velocity = 1, .motor = true, .max_force = 1};
      if (k > 0)
        connect(scene, JointType::ball, number(i, k - 1), number(i, k), at - Vector(0, 0, 0.31)).break_force =
            strength * 60;
    }
  for (uint32_t k = 0; k < 6; ++k) {
    Body &box = add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.3f, 0.3f), {0.6 + 0.4 * k, 3 + 0.7 * k, 1.2});
    box.mass = 4;
    box.linear_velocity = {0.1f * speed, -speed, 0};
  }
  return scene;
}

/* The last one does not break. */
std::vector<Scene> weak_nets()
{
  return {weak_net(1, 1), weak_net(0.5f, 2), weak_net(2, 3), weak_net(JointAxis::unlimited, 1)};
}

uint32_t broken_joints(const Scene &scene)
{
  return uint32_t(std::ranges::count_if(scene.joints, [](const Joint &joint) { return !joint.enabled; }));
}

void require_equal_breaks(BatchBesideWorlds &both)
{
  const WorldEvents<JointBreak> breaks = both.batch.joint_breaks();
  for (uint32_t world = 0; world < both.alone.size(); ++world)
    REQUIRE(std::ranges::equal(breaks.of(world), both.alone[world]->joint_breaks(), [](const auto &a, const auto &b) {
      return a.joint == b.joint && a.force == b.force && a.torque == b.torque;
    }));
}

void step_with_breaks(BatchBesideWorlds &both, int steps)
{
  for (int k = 0; k < steps; ++k) {
    both.step(1);
    require_equal_breaks(both);
  }
}

} // namespace

TEST_CASE("parity on CPU: joints of worlds of a batch break as they do alone")
{
  for (const std::string backend : {"serial", "tbb:threads=2,lanes=8"}) {
    CAPTURE(backend);
    BatchBesideWorlds both(weak_nets(), backend);
    step_with_breaks(both, 50);
    CHECK(broken_joints(both.batch.scene(0)) > 3);
    CHECK(broken_joints(both.batch.scene(0)) != broken_joints(both.batch.scene(1)));
    CHECK(broken_joints(both.batch.scene(3)) == 0);
    both.reset({1, 3});
    CHECK(broken_joints(both.batch.scene(1)) == 0);
    CHECK(both.batch.joint_breaks().of(1).empty());
    CHECK(broken_joints(both.batch.scene(0)) > 3);
    step_with_breaks(both, 30);
    CHECK(broken_joints(both.batch.scene(1)) > 0);
  }
}

TEST_CASE("parity with PoCL: joints of worlds of a batch break as they do alone")
{
  require_pocl();
  Settings all_features;
  all_features.specialise = false;
  BatchBesideWorlds both(weak_nets(), "cl:pocl", all_features);
  step_with_breaks(both, 25);
  both.reset({0});
  step_with_breaks(both, 5);
}

TEST_CASE("a world of a batch whose joints broke goes on alone and is loaded in any place that breaks alike")
{
  std::vector<Scene> scenes = weak_nets();
  scenes[2] = scenes[1];
  BatchBesideWorlds both(scenes, "serial");
  step_with_breaks(both, 30);
  const uint32_t broken = broken_joints(both.batch.scene(1));
  REQUIRE(broken > 3);
  const std::unique_ptr<World> goes_on = both.batch.alone(1, {"serial", {}, false});
  both.step(10);
  run(*goes_on, 10);
  CHECK(goes_on->state_hash() == both.alone[1]->state_hash());
  const std::vector<std::byte> saved = both.batch.save(1);
  both.batch.reset({2});
  both.batch.step();
  both.batch.load(2, saved);
  CHECK(broken_joints(both.batch.scene(2)) >= broken);
  both.alone[2] = std::make_unique<World>(saved, Placement{"serial", {}, false});
  for (const uint32_t world : {0u, 1u, 3u}) both.alone[world]->step();
  both.require_equal();
  step_with_breaks(both, 10);
}

TEST_CASE("controls of a batch stay what they are while joints beside them break")
{
  const std::vector<Scene> scenes = weak_nets();
  BatchBesideWorlds both(scenes, "serial");
  uint32_t driven = 0;
  while (!scenes[0].joints[driven].rotations[0].motor) ++driven;
  both.batch.choose_controls(std::vector{ControlledAxis{driven, 3, Control::target_velocity}});
  for (int k = 0; k < 30; ++k) {
    std::vector<float> values;
    for (uint32_t world = 0; world < 4; ++world) {
      values.push_back(float(k % 5) - float(world));
      JointAxis axis = both.alone[world]->scene().joints[driven].rotations[0];
      axis.target_velocity = values.back();
      both.alone[world]->set_joint_axis(both.alone[world]->id_of_joint(driven), 3, axis);
    }
    if (k % 3 == 0) both.batch.set_controls(values);
    else
      for (uint32_t world = 0; world < 4; ++world) {
        JointAxis axis = both.batch.scene(world).joints[driven].rotations[0];
        axis.target_velocity = values[world];
        both.batch.set_joint_axes(std::vector<WorldJoint>{{world, driven}}, std::vector<JointAxisChange>{{3, axis}});
      }
    step_with_breaks(both, 1);
  }
  CHECK(broken_joints(both.batch.scene(0)) > 0);
}

TEST_CASE("parity on CPU: joints of worlds of a batch that hold links break as they do alone")
{
  std::vector<Scene> scenes;
  for (const float speed : {0.1f, 2.0f, 4.0f}) {
    scenes.push_back(joined_trees(5, 6));
    for (Body &body : scenes.back().bodies) body.linear_velocity = {speed, 0, 0};
    for (size_t k = 0; k < scenes.back().joints.size(); k += 2)
      if (scenes.back().joints[k].break_force == 200) scenes.back().joints[k].break_force = 20;
  }
  BatchBesideWorlds both(scenes, "tbb:threads=2");
  step_with_breaks(both, 40);
  CHECK(broken_joints(both.batch.scene(0)) + broken_joints(both.batch.scene(1)) + broken_joints(both.batch.scene(2)) >
        0);
  both.reset({0, 1, 2});
  step_with_breaks(both, 5);
}

} // namespace tandem::parity
