/* Worlds of a batch that have joints have the bits of these worlds alone, whatever joints the others have. */
#include <limits>

#include "tests/host/world/worlds.h"
#include "tests/parity/joints.h"

namespace tandem::parity {
namespace {

using namespace physics_tests;
using tests::BatchBesideWorlds;

constexpr uint32_t crowd = 80; /* dynamic bodies of a world, enough for one with more joints than colours */

bool is_to_body(const Joint &joint, uint32_t body) { return joint.body_a == body || joint.body_b == body; }

/* A ball with more joints than there are colours, to balls that hang in space without touching anything. */
Scene star(uint32_t bodies)
{
  Scene scene = empty_scene();
  scene.name = "star";
  scene.gravity = {0, 0, 0};
  for (uint32_t i = 0; i < bodies; ++i)
    add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {3.0 * (i % 10), 3.0 * (i / 10), 0}).linear_velocity = {
        0.1f * float(i % 7), 0, 0.2f * float(i % 3)};
  for (uint32_t i = 1; i < bodies; ++i) {
    const auto at = [&](uint32_t body) { return vector_of(scene.bodies[body].position); };
    connect(scene, i % 2 ? JointType::ball : JointType::hinge, 0, i, Vector(0.5 * (at(0) + at(i))));
  }
  return scene;
}

/* Equally many bodies; with overflow joints and contacts in some worlds, and with none of them, with ball joints alone,
 * and without joints in others. */
std::vector<Scene> crowds()
{
  std::vector<Scene> scenes;
  for (uint64_t seed = 1; seed <= 5; ++seed) scenes.push_back(joint_crowd(seed, crowd));
  for (Joint &joint : scenes[0].joints)
    if (is_to_body(joint, 2)) joint.collide = true; /* no colour is left for its contacts */
  std::erase_if(scenes[1].joints, [](const Joint &joint) { return is_to_body(joint, 2); });
  std::erase_if(scenes[2].joints, [](const Joint &joint) { return joint.type != JointType::ball; });
  scenes[3].joints.clear();
  /* several with overflow joints of two types, of which those of one world must stand together */
  for (int copy = 0; copy < 2; ++copy) scenes.push_back(star(uint32_t(scenes[0].bodies.size())));
  return scenes;
}

/* Each kind of axis, the first joint's alone, and none. */
std::vector<Scene> worlds_of_axes()
{
  std::vector<Scene> scenes = tests::varied_scenes(joint_axes(), 4);
  for (const size_t world : {1, 2})
    for (Joint &joint : scenes[world].joints)
      if (world == 2 || &joint != &scenes[world].joints.front()) joint.directions = joint.rotations = {};
  return scenes;
}

/* What the kernels of a batch do otherwise than those of a world: overflow joints by world, axes, joined pairs. */
void require_what_batches_have_apart(const std::string &backend, uint32_t steps, const Settings &settings = {})
{
  BatchBesideWorlds(crowds(), backend, settings).step(steps);
  BatchBesideWorlds(worlds_of_axes(), backend, settings).step(steps);
}

void require_joints_alone(const std::string &backend, uint32_t steps, const Settings &settings = {})
{
  CAPTURE(backend);
  require_what_batches_have_apart(backend, steps, settings);
  for (const char *scene : {"ragdolls:n=2,height=0", "newton-cradle:n=4,length=0.5", "four-bar", "vehicle"})
    BatchBesideWorlds(tests::varied_scenes(scene, 3), backend, settings).step(steps);
  BatchBesideWorlds(std::vector<Scene>(3, bridge()), backend, settings).step(steps);
}

} // namespace

TEST_CASE("parity on CPU: worlds of a batch with joints have the bits of worlds alone")
{
  require_joints_alone("serial", 20);
  require_joints_alone("serial:order=backward", 8);
  require_joints_alone("tbb:threads=4", 12);
  require_joints_alone("tbb:threads=3,lanes=1", 6);
  Settings settings;
  settings.events = settings.pair_events = true;
  settings.specialise = false;
  require_joints_alone("tbb:threads=2,lanes=8", 6, settings);
}

TEST_CASE("parity with PoCL: worlds of a batch with joints have the bits of worlds alone")
{
  require_pocl();
  require_what_batches_have_apart("cl:pocl", 6, build_of_all_features());
}

/* The crowds must do what they are for. */
TEST_CASE("worlds with overflow joints, with overflow contacts, and with neither are in one batch")
{
  const std::vector<Scene> scenes = crowds();
  const auto most_joints_of_a_body = [](const Scene &scene) {
    std::vector<uint32_t> joints(scene.bodies.size());
    for (const Joint &joint : scene.joints)
      for (const uint32_t body : {joint.body_a, joint.body_b})
        if (body != no_body && scene.bodies[body].type == BodyType::dynamic) ++joints[body];
    return *std::max_element(joints.begin(), joints.end());
  };
  const auto colors_after = [](const Scene &scene) {
    World world(scene, {}, {"serial", {}, false});
    for (int k = 0; k < 15; ++k) world.step();
    return world.statistics().colors;
  };
  CHECK(most_joints_of_a_body(scenes[0]) > 63);
  CHECK(colors_after(scenes[0]) > 63);
  CHECK(most_joints_of_a_body(scenes[4]) > 63);
  CHECK(colors_after(scenes[4]) < 63);
  CHECK(most_joints_of_a_body(scenes[1]) < 20);
  CHECK(colors_after(scenes[1]) < 63);
  CHECK(most_joints_of_a_body(scenes[5]) > 63);
  CHECK(colors_after(scenes[5]) == 0);
}

TEST_CASE("worlds with joints are reset, saved and loaded in a batch, and forget or keep their impulses")
{
  std::vector<Scene> scenes = crowds();
  scenes.push_back(scenes[0]);
  scenes.back().gravity = {1, -4, 0};
  const auto copy = uint32_t(scenes.size() - 1);
  std::vector<std::string> backends = {"serial", "tbb:threads=2"};
  add_pocl(backends);
  for (const std::string &backend : backends) {
    BatchBesideWorlds both(scenes, backend);
    both.step(6);
    both.reset({0, 4});
    both.step(3);
    const std::vector<std::byte> bytes = both.batch.save(0);
    CHECK(bytes == both.alone[0]->save());
    both.step(2);
    for (const uint32_t world : {copy, 0u}) {
      both.batch.load(world, bytes);
      both.alone[world]->restore(bytes);
    }
    both.require_equal();
    both.step(4);
    World restored(both.batch.save(5), {"serial", {}, false});
    const std::unique_ptr<World> taken = both.batch.alone(1, {"tbb:threads=2", {}, false});
    both.step(2);
    for (World *world : {&restored, taken.get()})
      for (int k = 0; k < 2; ++k) world->step();
    CHECK(restored.state_hash() == both.batch.state_hash(5));
    CHECK(taken->state_hash() == both.batch.state_hash(1));
    both.reset({0, 1, 2, 3, 4, 5, copy});
    both.step(2);
  }
}

TEST_CASE("worlds of a batch with axes in some of them are reset and loaded with the impulses of their axes")
{
  const std::vector<Scene> scenes = worlds_of_axes();
  BatchBesideWorlds both(scenes, "tbb:threads=2");
  both.step(8);
  for (uint32_t world = 0; world < scenes.size(); ++world) {
    const std::vector<std::byte> bytes = both.batch.save(world);
    CHECK(bytes == both.alone[world]->save());
    both.reset({world});
    both.step(1);
    both.batch.load(world, bytes);
    both.alone[world]->restore(bytes);
    both.require_equal();
  }
  both.step(4);
}

TEST_CASE("the scene of a world of a batch has its joints, with the bodies of that world")
{
  const std::vector<Scene> scenes = crowds();
  const Worlds batch(scenes, {}, {"serial", {}, false});
  for (uint32_t world = 0; world < scenes.size(); ++world) {
    CAPTURE(world);
    const Scene scene = batch.scene(world);
    REQUIRE(scene.joints.size() == scenes[world].joints.size());
    for (size_t k = 0; k < scene.joints.size(); ++k) {
      CHECK(scene.joints[k].body_a == scenes[world].joints[k].body_a);
      CHECK(scene.joints[k].body_b == scenes[world].joints[k].body_b);
      CHECK(scene.joints[k].type == scenes[world].joints[k].type);
    }
  }
}

TEST_CASE("a joined body that stops being finite is taken out of its world of the batch alone")
{
  BatchBesideWorlds both(crowds(), "tbb:threads=2");
  both.step(4);
  for (const auto &[world, body] : std::vector<WorldBody>{{0, 2}, {1, 9}, {5, 0}}) {
    BodyState bad = both.alone[world]->bodies()[body];
    bad.linear_velocity[1] = std::numeric_limits<float>::quiet_NaN();
    both.batch.set_state_unchecked({world, body}, bad);
    both.alone[world]->set_body_unchecked(body, bad);
  }
  both.step(6);
  CHECK(both.batch.quarantined(1).size() == 1);
  CHECK(both.batch.quarantined(2).empty());
  both.reset({1, 5});
  both.step(4);
}

} // namespace tandem::parity
