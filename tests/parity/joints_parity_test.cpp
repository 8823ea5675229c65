/* Joints give the serial backend's bits on every backend, by every batching and broadphase, and from every state that
 * was kept or written down. */
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <tandem/recording.h>

#include "host/runtime/memory.h"
#include "shared/counts.h"
#include "tests/parity/joints.h"
#include "tests/parity/scripted_day.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

const std::vector<std::string> some_backends = {"serial",        "serial:order=backward", "serial:order=shuffled",
                                                "tbb:threads=2", "tbb:threads=3,lanes=1", "tbb:threads=3,lanes=4"};

uint64_t hash_after(const Scene &scene, int steps, const Settings &settings = {},
                    const Placement &placement = {"serial", {}, false})
{
  World world(scene, settings, placement);
  for (int k = 0; k < steps; ++k) world.step();
  return world.state_hash();
}

Settings with_events()
{
  Settings settings;
  settings.events = settings.pair_events = settings.check = true;
  return settings;
}

/* The pairs of bodies whose bounds overlap, as numbers of the scene. */
std::set<std::pair<uint32_t, uint32_t>> pairs_of(World &world)
{
  const uint32_t count = world.memory().read<uint32_t>(Buffer::counts, 1, COUNT_PAIRS).front();
  const auto a = world.memory().read<uint32_t>(Buffer::pair_a, count),
             b = world.memory().read<uint32_t>(Buffer::pair_b, count);
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  for (uint32_t k = 0; k < count; ++k) pairs.insert(std::minmax(world.scene_body(a[k]), world.scene_body(b[k])));
  return pairs;
}

std::set<std::pair<uint32_t, uint32_t>> joined_in(const Scene &scene)
{
  std::set<std::pair<uint32_t, uint32_t>> joined;
  for (const Joint &joint : scene.joints)
    if (!joint.collide && joint.body_a != no_body && joint.body_b != no_body)
      joined.insert(std::minmax(joint.body_a, joint.body_b));
  return joined;
}

/* Goes on equally for some steps. */
void require_equal_steps(World &one, World &other, int steps)
{
  for (int k = 0; k < steps; ++k) {
    one.step();
    other.step();
    REQUIRE(one.state_hash() == other.state_hash());
  }
}

} // namespace

TEST_CASE("parity on CPU: joints of every type, overflow joints and contacts")
{
  require_parity(joint_crowd(), cpu_backends(), 20, with_events());
}

TEST_CASE("parity on CPU: a bridge with boxes, and the built-in scenes of joints")
{
  require_parity(bridge(), cpu_backends(), 40, with_events());
  for (const char *scene : {"joint-grid:columns=12,rows=12", "hinge-chain:n=20", "pendulums:n=20"})
    require_parity(scene, cpu_backends(), 15);
  for (const char *scene : {"newton-cradle:n=4,length=0.5", "four-bar", "vehicle:n=2"})
    require_parity(scene, cpu_backends(), 30);
}

TEST_CASE("parity on CPU: limits, springs, motors and friction of joints")
{
  require_parity(joint_axes(), cpu_backends(), 40, with_events());
  require_parity("ragdolls:n=3,height=0", cpu_backends(), 30);
}

TEST_CASE("parity on CPU: joints with every batching")
{
  for (const Batching batching : choices<Batching>()) {
    Settings settings = with_events();
    settings.batching = batching;
    require_parity(joint_crowd(2), some_backends, 12, settings);
    require_parity(bridge(), some_backends, 20, settings);
  }
}

TEST_CASE("parity on OpenCL: joints")
{
  require_pocl();
  const Settings settings = build_of_all_features();
  require_parity(joint_crowd(1, 60), {"serial", "cl:pocl"}, 10, settings);
  require_parity(bridge(), {"serial", "cl:pocl"}, 20, settings);
  require_parity(joint_axes(), {"serial", "cl:pocl"}, 20); /* kernels of its own */
}

TEST_CASE("joints in their own place, and with every feature built, have the same bits")
{
  const Scene scene = joint_crowd();
  const uint64_t expected = hash_after(scene, 30);
  Settings whole;
  whole.specialise = false;
  CHECK(hash_after(scene, 30, whole) == expected);
  CHECK(hash_after(scene, 30, whole, {"tbb", {}, false}) == expected);
  const auto placed = [&](const char *on, const char *exceptions) {
    return hash_after(scene, 30, {}, Placement{on, parse_placement(exceptions), false});
  };
  CHECK(placed("tbb", "joints=serial") == expected);
  CHECK(placed("serial", "joints=tbb:threads=3") == expected);
  CHECK(placed("serial", "joints=serial:order=backward,solve=tbb") == expected);
  if (has_pocl()) CHECK(placed("tbb", "joints=cl:pocl,solve=serial") == expected);
  else ::tests::leave_out_device("no PoCL");
}

TEST_CASE("joined bodies are in no list of pairs, and every broadphase finds the same pairs beside them")
{
  for (const Scene &scene : {joint_crowd(3), bridge()}) {
    const auto joined = joined_in(scene);
    Scene unjoined = scene; /* has the pairs that joints would keep apart */
    for (Joint &joint : unjoined.joints) joint.collide = true;
    Settings settings = with_events();
    settings.broadphase = Broadphase::brute_force;
    World oracle(scene, settings, {"serial", {}, false}), all(unjoined, settings, {"serial", {}, false});
    oracle.step();
    all.step();
    auto expected = pairs_of(all);
    size_t kept_apart = 0;
    for (const auto &pair : joined) kept_apart += expected.erase(pair);
    REQUIRE(kept_apart > 5);
    REQUIRE(pairs_of(oracle) == expected);
    for (int k = 1; k < 20; ++k) oracle.step();
    for (const Broadphase broadphase : choices<Broadphase>()) {
      CAPTURE(scene.name, broadphase);
      settings.broadphase = broadphase;
      World world(scene, settings, {"tbb", {}, false});
      world.step();
      CHECK(pairs_of(world) == expected);
      for (int k = 1; k < 20; ++k) world.step();
      CHECK(world.state_hash() == oracle.state_hash());
      CHECK(world.contact_events().size() == oracle.contact_events().size());
      for (const auto &[a, b] : pairs_of(world)) REQUIRE(!joined.contains({a, b}));
    }
  }
}

TEST_CASE("a world with joints goes on from its snapshot with the same bits, anywhere")
{
  for (const Scene &scene : {joint_crowd(4), bridge()}) {
    World original(scene, with_events(), {"serial", {}, false});
    for (int k = 0; k < 15; ++k) original.step();
    const std::vector<std::byte> snapshot = original.save();
    for (const char *on : {"serial:order=backward", "tbb:threads=3,lanes=8"}) {
      World world(snapshot, {on, {}, false}), same(snapshot, {"serial", {}, false});
      CHECK(world.save() == snapshot);
      CHECK(world.scene().joints.size() == scene.joints.size());
      require_equal_steps(world, same, 15);
    }
    World restored(bridge(3, 1), {}, {"tbb", {}, false}); /* becomes another world */
    restored.step();
    restored.restore(snapshot);
    require_equal_steps(original, restored, 15);
  }
}

TEST_CASE("a world with joints goes back to states that it kept with the same bits")
{
  World world(joint_crowd(5), {}, {"tbb", {}, false});
  for (int k = 0; k < 5; ++k) world.step();
  world.keep_states(8);
  std::vector<uint64_t> hashes{world.state_hash()};
  for (int k = 0; k < 6; ++k) {
    world.step();
    hashes.push_back(world.state_hash());
  }
  world.go_back(4);
  CHECK(world.state_hash() == hashes[2]);
  for (int k = 3; k < 7; ++k) {
    world.step();
    CHECK(world.state_hash() == hashes[size_t(k)]);
  }
}

TEST_CASE("a recording of a world with joints is made again with the same bits")
{
  const std::string path = (std::filesystem::temp_directory_path() / "tandem-joints-recording.tandem").string();
  {
    World world(bridge(), with_events(), {"serial", {}, false});
    world.start_recording(path);
    for (int k = 0; k < 20; ++k) {
      if (k == 5) world.add_impulse(world.id_of(5), {.impulse = {0, 3, 1}});
      if (k == 8) world.set_gravity({1, -9, 0});
      world.step();
    }
    world.stop_recording();
  }
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto *bytes = reinterpret_cast<const std::byte *>(text.data());
  const WorldRecording recording(std::vector<std::byte>(bytes, bytes + text.size()), path);
  World again(recording.snapshot(0), {"tbb", {}, false});
  ReplayRequest request;
  request.first = recording.snapshot_step(0);
  request.verify_from = 0;
  const auto difference = replay(recording, again, request);
  CHECK(!difference);
  CHECK(again.statistics().steps == 20);
  std::filesystem::remove(path);
}

/* Bodies that come and go change the order and the number of rows, where joints and joined pairs stand. */
TEST_CASE("bodies, shapes and properties that come beside joints leave these as they are")
{
  const Scene scene = bridge();
  Settings settings = with_events();
  settings.broadphase = Broadphase::grid;
  World world(scene, settings, {"serial", {}, false}), other(scene, settings, {"tbb:threads=3", {}, false});
  const auto joined = joined_in(scene);
  std::vector<BodyId> made;
  for (int k = 0; k < 60; ++k) {
    CAPTURE(k);
    for (World *one : {&world, &other}) {
      if (k % 7 == 3) {
        Body body = scene.bodies.back();
        body.position = {1.0 + k % 5, 5, 0};
        const std::vector<Body> several(size_t(k + 1), body);
        const auto ids = one->create_bodies(several);
        if (one == &world) made.push_back(ids.front());
      }
      if (k % 7 == 5) one->destroy_body(made.back());
      if (k == 10) one->set_filter(one->id_of(3), 2, ~0u);
      if (k == 20) one->add_shape_to(one->id_of(12), child_at(sphere_shape(0.2f), {0.3f, 0, 0}));
      if (k == 30) one->set_locks(one->id_of(4), {false, false, true}, {});
      if (k == 40)
        REQUIRE_THROWS_AS(one->add_shape_to(one->id_of(4), child_at(sphere_shape(0.1f), {0, 0, 0.2f})), InputError);
    }
    REQUIRE_NOTHROW(world.step());
    REQUIRE_NOTHROW(other.step());
    REQUIRE(world.state_hash() == other.state_hash());
    for (const auto &pair : pairs_of(world)) REQUIRE(!joined.contains(pair));
    REQUIRE(summary_of(joint_errors(world.scene(), world.precise_bodies())).max_distance < 0.1);
  }
  World restored(world.save(), {"serial", {}, false});
  require_equal_steps(world, restored, 5);
}
