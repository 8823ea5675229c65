/* Calls of joints between steps, and joints that break, give the same bits on every backend, after snapshots, after
 * going back, and in recordings. */
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <tandem/recording.h>

#include "tests/parity/joints.h"

using namespace tandem;
using namespace tandem::parity;
using namespace tandem::physics_tests;

namespace {

/* A net of balls and a heap of boxes, to which joints come and from which they go. */
Scene breaking_net(uint32_t side = 8)
{
  Scene scene = empty_scene();
  scene.name = "breaking net";
  add_ground(scene);
  const auto number = [&](uint32_t i, uint32_t k) { return 1 + i * side + k; };
  for (uint32_t i = 0; i < side; ++i)
    for (uint32_t k = 0; k < side; ++k)
      add_body(scene, i == 0 && k % 3 == 0 ? BodyType::fixed : BodyType::dynamic, box_shape(0.3f, 0.2f, 0.25f),
               {0.7 * i, 3, 0.7 * k})
          .linear_velocity = {0, float(i % 3), 0};
  for (uint32_t i = 0; i < side; ++i)
    for (uint32_t k = 0; k < side; ++k) {
      const Vector at(0.7 * i, 3, 0.7 * k);
      if (i > 0)
        connect(scene, k % 2 ? JointType::ball : JointType::hinge, number(i - 1, k), number(i, k),
                at - Vector(0.35, 0, 0), Vector::UnitZ())
            .break_force = 25 + float(7 * ((i * 5 + k) % 11));
      if (k > 0 && i > 0)
        connect(scene, JointType::ball, number(i, k - 1), number(i, k), at - Vector(0, 0, 0.35)).break_force = 60;
    }
  for (uint32_t k = 0; k < side; ++k)
    add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.3f, 0.3f), {0.5 + 0.6 * k, 4.5, 1 + 0.3 * k}).mass = 4;
  return scene;
}

/* What a program does before a step follows from the world and the step alone. */
void make_calls(World &world, int step)
{
  Random random(uint64_t(step) + 11);
  const std::vector<JointId> ids = world.joint_ids();
  const std::vector<BodyId> bodies = world.body_ids();
  const auto any = [&](const auto &list) { return list[random.below(uint32_t(list.size()))]; };
  const uint32_t choice = random.below(8);
  if (choice == 0 && ids.size() > 20) world.destroy_joints(std::vector<JointId>{any(ids)});
  if (choice == 1 || choice == 2) {
    Joint joint;
    joint.type = choice == 1 ? JointType::ball : JointType::hinge;
    joint.body_a = bodies[1 + random.below(uint32_t(bodies.size() - 1))].index;
    joint.body_b = bodies[1 + random.below(uint32_t(bodies.size() - 1))].index;
    const auto moves = [&](uint32_t body) { return world.scene().bodies[body].type == BodyType::dynamic; };
    if (joint.body_a != joint.body_b && (moves(joint.body_a) || moves(joint.body_b))) {
      joint.position_a = {0.4, 0, 0};
      joint.position_b = {-0.4, 0, 0};
      joint.break_force = 80;
      world.create_joint(joint);
    }
  }
  if (choice == 3) {
    const JointId id = any(ids);
    Joint joint = world.scene().joints[id.index];
    joint.enabled = !joint.enabled;
    world.set_joint(id, joint);
  }
  if (choice == 4)
    for (const JointId &id : ids)
      if (world.scene().joints[id.index].type == JointType::hinge && random.below(4) == 0) {
        JointAxis axis;
        axis.stiffness = float(random.uniform(1, 30));
        axis.damping = 1;
        world.set_joint_axis(id, 3, axis);
      }
  if (choice == 5 && bodies.size() > 40) world.destroy_body(bodies[1 + random.below(uint32_t(bodies.size() - 1))]);
}

std::vector<uint64_t> hashes_of_day(World &world, int first, int end)
{
  std::vector<uint64_t> hashes;
  for (int step = first; step < end; ++step) {
    make_calls(world, step);
    world.step();
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

Settings checked(bool sleeping)
{
  Settings settings;
  settings.check = settings.events = true;
  settings.sleeping = sleeping;
  settings.sleep_time = 0.2f;
  return settings;
}

constexpr int day = 90;

} // namespace

TEST_CASE("parity on CPU: joints that break in every step's comparison")
{
  require_parity(breaking_net(4), {"serial", "serial:order=backward", "tbb:threads=2,lanes=4"}, 20, checked(false));
}

TEST_CASE("parity on CPU: a day of calls of joints, with sleep and without")
{
  for (const bool sleeping : {false, true}) {
    CAPTURE(sleeping);
    World serial(breaking_net(), checked(sleeping), {"serial", {}, false});
    size_t broken = 0;
    std::vector<uint64_t> hashes;
    for (int step = 0; step < day; ++step) {
      make_calls(serial, step);
      serial.step();
      hashes.push_back(serial.state_hash());
      broken += serial.joint_breaks().size();
    }
    CHECK(broken > 5);
    CHECK_FALSE(serial.batch_fault());
    for (const char *backend : {"serial:order=shuffled", "tbb:threads=3,lanes=1", "tbb:threads=2,lanes=8"}) {
      CAPTURE(backend);
      World other(breaking_net(), checked(sleeping), {backend, {}, false});
      REQUIRE(hashes_of_day(other, 0, day) == hashes);
    }
  }
}

TEST_CASE("parity on PoCL: a day of calls of joints")
{
  require_pocl();
  World serial(breaking_net(5), checked(true), {"serial", {}, false}),
      pocl(breaking_net(5), checked(true), {"cl:pocl", {}, false});
  REQUIRE(hashes_of_day(pocl, 0, 40) == hashes_of_day(serial, 0, 40));
}

TEST_CASE("calls of joints: a world of a snapshot goes on with the same bits and handles")
{
  for (const bool sleeping : {false, true}) {
    World world(breaking_net(), checked(sleeping), {"serial", {}, false});
    hashes_of_day(world, 0, 50);
    const std::vector<std::byte> snapshot = world.save();
    World other(snapshot, {"tbb:threads=2", {}, false});
    CHECK(other.joint_ids() == world.joint_ids());
    CHECK(hashes_of_day(other, 50, day) == hashes_of_day(world, 50, day));
    CHECK(other.joint_ids() == world.joint_ids());
  }
}

TEST_CASE("calls of joints: going back undoes breaks and changes of axes")
{
  World world(breaking_net(), checked(false), {"serial", {}, false});
  run(world, 3);
  world.keep_states(40);
  size_t broken = 0;
  std::vector<uint64_t> hashes;
  const auto go_on = [&] {
    std::vector<uint64_t> found;
    for (int k = 0; k < 25; ++k) {
      JointAxis axis;
      axis.stiffness = float(k % 5) + 1;
      for (const JointId &id : world.joint_ids())
        if (world.scene().joints[id.index].type == JointType::hinge && id.index % 3 == 0 && k > 0)
          world.set_joint_axis(id, 3, axis);
      world.step();
      broken += world.joint_breaks().size();
      found.push_back(world.state_hash());
    }
    return found;
  };
  JointAxis begin;
  begin.stiffness = 1;
  for (const JointId &id : world.joint_ids())
    if (world.scene().joints[id.index].type == JointType::hinge && id.index % 3 == 0)
      world.set_joint_axis(id, 3, begin);
  world.keep_states(40);
  hashes = go_on();
  REQUIRE(broken > 0);
  world.go_back(25);
  CHECK(go_on() == hashes);
}

TEST_CASE("calls of joints: a recording makes them again")
{
  const std::string path = (std::filesystem::temp_directory_path() / "joint_calls.tandemr").string();
  World world(breaking_net(5), checked(true), {"serial", {}, false});
  run(world, 2);
  world.start_recording(path, {});
  hashes_of_day(world, 2, 60);
  world.stop_recording();
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> text{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  const WorldRecording recording(bytes, path);
  World again(recording.snapshot(0), {"tbb:threads=2", {}, false});
  ReplayRequest request;
  request.verify = true;
  const auto difference = replay(recording, again, request);
  CHECK_FALSE(difference);
  CHECK(again.state_hash() == world.state_hash());
  std::filesystem::remove(path);
}
