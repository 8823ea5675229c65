/* Snapshots of worlds whose joints sleep: what a reader must not believe, whoever sealed it. */
#include <algorithm>
#include <cstring>

#include "host/runtime/parts.h"
#include "host/world/snapshot.h"
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;
using Catch::Matchers::ContainsSubstring;

namespace {

/* Two rows of four boxes on the ground, joined to their neighbours, all asleep. */
std::vector<std::byte> snapshot_of_sleeping_rows()
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (uint32_t i = 1; i <= 8; ++i) {
    const double x = 0.6 * i + 3 * (i > 4);
    add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), {x, 0.2, 0});
    if (i != 1 && i != 5) connect(scene, JointType::ball, i - 1, i, {x - 0.3, 0.2, 0});
  }
  Settings settings;
  settings.sleeping = true;
  World world(scene, settings, {"serial", {}});
  for (int k = 0; k < 400 && world.statistics().asleep < 8; ++k) world.step();
  REQUIRE(world.statistics().sleeping_islands == 2);
  return world.save();
}

/* With the length and the hash of what was changed. */
std::vector<std::byte> sealed_again(std::vector<std::byte> bytes)
{
  const uint64_t length = bytes.size() - seal_bytes, hash = hash_blocks(&bytes[seal_bytes], length, 0, run_parts);
  std::memcpy(&bytes[16], &length, sizeof length);
  std::memcpy(&bytes[24], &hash, sizeof hash);
  return bytes;
}

/* Where these words stand, with so many bytes 1 behind the first. */
size_t place_of_words(const std::vector<std::byte> &bytes, const std::vector<uint32_t> &words, size_t ones = 0)
{
  std::vector<std::byte> wanted(words.size() * sizeof(uint32_t));
  std::memcpy(wanted.data(), words.data(), wanted.size());
  wanted.insert(wanted.begin() + sizeof(uint32_t), ones, std::byte{1});
  const auto found = std::search(bytes.begin(), bytes.end(), wanted.begin(), wanted.end());
  REQUIRE(found != bytes.end());
  return size_t(found - bytes.begin());
}

std::string complaint_about(const std::vector<std::byte> &bytes)
{
  try {
    World world(sealed_again(bytes), {"serial", {}});
  } catch (const InputError &error) {
    return error.what();
  }
  return "none";
}

} // namespace

TEST_CASE("joints of a snapshot sleep with their bodies, whoever sealed it", "[address]")
{
  const std::vector<std::byte> asleep = snapshot_of_sleeping_rows();
  REQUIRE(complaint_about(asleep) == "none");
  std::vector<std::byte> without_order = asleep; /* six joints of three colours, by their places */
  const size_t order = place_of_words(asleep, {6, 0, 0, 2, 3, 5, 1, 4});
  const uint32_t none = 0;
  std::memcpy(&without_order[order], &none, sizeof none);
  const auto first = without_order.begin() + ptrdiff_t(order + sizeof(uint64_t));
  without_order.erase(first, first + 6 * sizeof(uint32_t));
  CHECK_THAT(complaint_about(without_order), ContainsSubstring("the joints that sleep are not those of the bodies"));

  std::vector<std::byte> joined = asleep; /* the last body of a row to one of the other row, which sleeps by itself */
  const size_t ends = place_of_words(asleep, {uint32_t(JointType::ball), 3, 4}, 1); /* it is enabled */
  const uint32_t other = 6;
  std::memcpy(&joined[ends + 2 * sizeof(uint32_t) + 1], &other, sizeof other);
  CHECK_THAT(complaint_about(joined), ContainsSubstring("the bodies of joint 2 do not sleep in one island"));
}

TEST_CASE("a world whose joint with a spring came and went is what its snapshot makes")
{
  for (const bool steps_between : {false, true}) {
    Scene scene = empty_scene();
    for (int k = 0; k < 2; ++k)
      add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.1f, 0.1f), {0.42 * k, 5, 0}).filter_mask = 0;
    connect(scene, JointType::ball, 0, 1, {0.21, 5, 0});
    World world(scene, {}, {"serial", {}});
    world.step();
    Joint hinge;
    hinge.type = JointType::hinge;
    hinge.body_a = 0, hinge.body_b = 1;
    hinge.rotations[0].stiffness = 3;
    const JointId gone = world.create_joint(hinge);
    run(world, steps_between);
    world.destroy_joint(gone);
    run(world, steps_between);
    World restored(world.save(), {"serial", {}});
    CHECK(restored.state_hash() == world.state_hash());
    for (World *each : {&world, &restored}) each->create_joint(hinge), run(*each, 2);
    CHECK(restored.state_hash() == world.state_hash());
  }
}
