/* A world that takes its first steps on the CPU while a device's kernels are built: whenever these are ready, each step
 * has the hash that it has on `serial`. A gate decides how far a build comes, so that the tests do not depend on how
 * long a compiler takes. */
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <thread>

#include <tandem/recording.h>
#include <tandem/worlds.h>

#include "host/runtime/interface/faults.h"
#include "host/runtime/memory.h"
#include "tests/parity/full_day.h"
#include "tests/parity/parity.h"

namespace tandem::start_on_cpu {
namespace {

using namespace parity;
using Catch::Matchers::ContainsSubstring;

constexpr int all_builds = 1 << 30;
std::atomic<int> builds_let_through{all_builds};
std::atomic<bool> builds_fail{false}, sharing_fails{false};
std::thread::id thread_of_test;

/* Holds up threads that build, and none else. */
bool gate(faults::Site site)
{
  if (site == faults::Site::transfer) return sharing_fails.exchange(false);
  if (site != faults::Site::build || std::this_thread::get_id() == thread_of_test) return false;
  while (builds_let_through <= 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  --builds_let_through;
  return builds_fail;
}

/* Closed at first. A world whose builds it holds up must end before it. */
class Gate {
public:
  Gate()
  {
    thread_of_test = std::this_thread::get_id();
    builds_let_through = 0;
    faults::hook = gate;
  }
  ~Gate()
  {
    faults::hook = nullptr;
    builds_fail = false;
    open();
  }
  static void open() { builds_let_through = all_builds; }
};

/* The end of a world waits for its builds. */
struct OpenAtLast {
  ~OpenAtLast() { Gate::open(); }
};

Placement on_cpu_at_first(const std::string &device = "cl:pocl")
{
  Placement placement{device, {}};
  placement.start = Start::on_cpu;
  return placement;
}

std::set<std::string> backends_of(World &world)
{
  std::set<std::string> names;
  for (const Kernel kernel : world.kernels()) names.insert(world.backend_of(kernel).name().substr(0, 3));
  return names;
}

const std::set<std::string> on_tbb = {"tbb"}, on_device = {"cl:"};

const char *const scene_text = "mixed:n=40";

std::vector<uint64_t> serial_hashes(int steps)
{
  World world(load_scene(scene_text), {}, {"serial", {}});
  std::vector<uint64_t> hashes;
  for (int step = 0; step < steps; ++step) {
    world.step();
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

} // namespace

TEST_CASE("start on the CPU: each step has the hash of serial, whenever the device takes over")
{
  require_pocl();
  constexpr int steps = 14;
  const std::vector<uint64_t> hashes = serial_hashes(steps);
  for (const int move_after : {0, 1, 5, 13}) {
    const Gate gate;
    World world(load_scene(scene_text), {}, on_cpu_at_first());
    const OpenAtLast opened;
    for (int step = 0; step < steps; ++step) {
      CAPTURE(move_after, step);
      if (step == move_after) {
        CHECK_FALSE(world.wait_until_placed(0));
        CHECK(world.placement_report().on == "tbb");
        CHECK_FALSE(world.placement_report().settled);
        Gate::open();
        CHECK(world.wait_until_placed());
      }
      CHECK(world.is_placed() == (step >= move_after));
      CHECK(backends_of(world) == (step >= move_after ? on_device : on_tbb));
      world.step();
      REQUIRE(world.state_hash() == hashes[static_cast<size_t>(step)]);
    }
    const PlacementReport report = world.placement_report();
    CHECK(report.on == "cl:pocl");
    CHECK(report.building.steps_on_cpu == static_cast<uint64_t>(move_after));
    CHECK(report.building.moved_after == static_cast<uint64_t>(move_after));
    CHECK(report.building.kernels == world.kernels().size());
    CHECK(report.building.built == report.building.kernels);
    CHECK(world.build_milliseconds() > 0);
  }
}

TEST_CASE("start on the CPU: a step takes the kernels over by itself, all of them at once")
{
  require_pocl();
  const Gate gate;
  World world(load_scene(scene_text), {}, on_cpu_at_first()), serial(load_scene(scene_text), {}, {"serial", {}});
  const OpenAtLast opened;
  builds_let_through = 4;
  while (world.placement_report().building.built == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  for (int step = 0; step < 3; ++step) world.step();
  CHECK(backends_of(world) == on_tbb);
  CHECK(world.placement_report().building.built < world.placement_report().building.kernels);
  Gate::open();
  world.finish(); /* waits for no compiler */
  while (!world.is_placed()) {
    world.step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  CHECK(backends_of(world) == on_device);
  while (serial.statistics().steps < world.statistics().steps) serial.step();
  CHECK(world.state_hash() == serial.state_hash());
}

TEST_CASE("start on the CPU: devices that may be inexact are refused, because the hour of the move would decide bits")
{
  Placement inexact = on_cpu_at_first("tbb");
  inexact.allow_inexact = true;
  CHECK_THROWS_AS(World(load_scene(scene_text), {}, inexact), InputError);
  World world(load_scene(scene_text), {}, on_cpu_at_first("tbb"));
  CHECK(world.is_placed());
  CHECK_THROWS_AS(world.place(inexact), InputError);
}

TEST_CASE("start on the CPU: an automatic placement, which does so by itself, takes no start")
{
  Placement automatic = on_cpu_at_first("tbb");
  automatic.automatic = true;
  CHECK_THROWS_WITH(World(load_scene(scene_text), {}, automatic), ContainsSubstring("it starts on the CPU by itself"));
}

TEST_CASE("start on the CPU: a world in which nothing moves is placed, too")
{
  require_pocl();
  const Gate gate;
  Settings settings;
  settings.sleeping = true;
  World world(load_scene("box-stack:n=1"), settings, on_cpu_at_first());
  const OpenAtLast opened;
  for (int step = 0; step < 60; ++step) world.step();
  REQUIRE(world.statistics().asleep == 1);
  CHECK_FALSE(world.is_placed());
  Gate::open();
  for (int step = 0; step < 60000 && !world.is_placed(); ++step) {
    world.step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  CHECK(world.is_placed());
  World serial(load_scene("box-stack:n=1"), settings, {"serial", {}});
  for (int step = 0; step < 60; ++step) serial.step();
  CHECK(world.body_hash() == serial.body_hash());
}

TEST_CASE("start on the CPU: a build that fails is told in one line, once, and is tried again")
{
  require_pocl();
  const Gate gate;
  World world(load_scene(scene_text), {}, on_cpu_at_first());
  const OpenAtLast opened;
  builds_fail = true;
  world.step();
  Gate::open();
  std::string told;
  while (told.empty()) try {
      world.step();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } catch (const std::runtime_error &error) {
      told = error.what();
    }
  CAPTURE(told);
  CHECK(told.find("OpenCL device") != std::string::npos);
  CHECK(told.find("the state is that before the step") != std::string::npos);
  CHECK(told.find('\n') == std::string::npos);
  CHECK(backends_of(world) == on_tbb);
  builds_fail = false;
  int told_again = 0; /* of the build that began before this */
  while (!world.is_placed()) try {
      world.wait_until_placed();
    } catch (const std::runtime_error &) {
      ++told_again;
      world.step();
    }
  CHECK(told_again <= 1);
  world.step();
  CHECK(backends_of(world) == on_device);
  CHECK(world.state_hash() == state_after(scene_text, "serial", world.statistics().steps));
}

TEST_CASE("start on the CPU: a world may end in the middle of a build")
{
  require_pocl();
  for (const int let_through : {0, 1, 5}) {
    const Gate gate;
    auto world = std::make_unique<World>(load_scene(scene_text), Settings{}, on_cpu_at_first());
    builds_let_through = let_through;
    world->step();
    const uint64_t hash = world->state_hash();
    std::thread opens_later([] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      Gate::open();
    });
    world.reset();
    opens_later.join();
    CHECK(hash == state_after(scene_text, "serial", 1));
  }
}

namespace {

/* Equal worlds through all that a world can do, while the gate opens and closes. */
void require_equal_day(uint64_t seed, const std::function<void(World &, uint64_t step)> &before_step)
{
  const Gate gate;
  World serial(plain_yard(), FullDay::settings(), {"serial", {}}),
      moving(plain_yard(), FullDay::settings(), on_cpu_at_first());
  const OpenAtLast opened;
  FullDay day(seed, Changes::without_features);
  std::set<bool> placed;
  for (uint64_t step = 0; step < FullDay::length; ++step) {
    CAPTURE(seed, step);
    day(serial, step);
    day(moving, step);
    before_step(moving, step);
    serial.step();
    moving.step();
    placed.insert(moving.is_placed());
    REQUIRE(moving.state_hash() == serial.state_hash());
    REQUIRE(moving.statistics().asleep == serial.statistics().asleep);
    const std::vector<Ray> rays = {{{0, 9, 0}, {0, -10, 0}, 1, {}}, {{-9, 0.5, 0}, {18, 0, 0}, 1, {}}};
    const std::vector<RayHit> hits = moving.cast_rays(rays), wanted = serial.cast_rays(rays);
    for (size_t ray = 0; ray < rays.size(); ++ray) {
      REQUIRE(hits[ray].body == wanted[ray].body);
      REQUIRE(hits[ray].fraction == wanted[ray].fraction);
    }
  }
  CHECK(placed.size() == 2);
}

} // namespace

TEST_CASE("start on the CPU: bodies, properties, sleep, kept states, snapshots and queries, before and after the move")
{
  require_pocl();
  require_equal_day(7, [](World &world, uint64_t step) {
    if (step != 43) return; /* between a snapshot and the restoring of it, with states of the CPU kept */
    Gate::open();
    world.wait_until_placed();
  });
}

TEST_CASE("start on the CPU: a snapshot is restored in the middle of a build, which goes on")
{
  require_pocl();
  const Gate gate;
  World world(load_scene(scene_text), {}, on_cpu_at_first());
  const OpenAtLast opened;
  const std::vector<std::byte> snapshot = world.save();
  world.step();
  world.step();
  world.restore(snapshot);
  CHECK(backends_of(world) == on_tbb);
  world.step();
  World other(snapshot, on_cpu_at_first());
  other.step();
  CHECK(world.placement_report().building.steps_on_cpu == 3);
  Gate::open();
  for (World *one : {&world, &other}) {
    CHECK(one->wait_until_placed());
    one->step();
    CHECK(backends_of(*one) == on_device);
    CHECK(one->state_hash() == state_after(scene_text, "serial", 2));
  }
}

TEST_CASE("start on the CPU: a feature that comes in the middle of a build is built, too")
{
  require_pocl();
  const Gate gate;
  World world(load_scene(scene_text), {}, on_cpu_at_first()), serial(load_scene(scene_text), {}, {"serial", {}});
  const OpenAtLast opened;
  const auto step_both = [&] {
    world.step();
    serial.step();
    REQUIRE(world.state_hash() == serial.state_hash());
  };
  step_both();
  for (World *one : {&world, &serial}) one->set_damping(one->id_of(3), 0.5f, 0.5f);
  step_both();
  Gate::open();
  CHECK(world.wait_until_placed());
  step_both();
  CHECK(backends_of(world) == on_device);
}

TEST_CASE("start on the CPU: a recording of the first steps is that of serial")
{
  require_pocl();
  const Gate gate;
  std::string folder = (std::filesystem::temp_directory_path() / "tandem-start-XXXXXX").string();
  REQUIRE(mkdtemp(folder.data()));
  const std::string path = folder + "/F.tandem";
  {
    World world(load_scene(scene_text), {}, on_cpu_at_first());
    const OpenAtLast opened;
    world.start_recording(path);
    for (int step = 0; step < 6; ++step) {
      if (step == 3) Gate::open(), world.wait_until_placed();
      world.step();
    }
    world.stop_recording();
  }
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::filesystem::remove_all(folder);
  const auto bytes = std::as_bytes(std::span(text));
  const WorldRecording recording({bytes.begin(), bytes.end()}, "F.tandem");
  REQUIRE(recording.steps() == 6);
  World serial(recording.snapshot(), {"serial", {}});
  CHECK_FALSE(replay(recording, serial, {}).has_value());
}

TEST_CASE("start on the CPU: a batch of worlds starts there, too")
{
  require_pocl();
  const Gate gate;
  const Scene scene = load_scene("falling-boxes:n=6,height=0");
  Worlds moving(scene, 3, {}, on_cpu_at_first()), serial(scene, 3, {}, {"serial", {}});
  const OpenAtLast opened;
  for (int step = 0; step < 9; ++step) {
    CAPTURE(step);
    for (Worlds *worlds : {&moving, &serial}) {
      if (step == 1 || step == 5) worlds->set_gravity(2, {0, -1.6f, 0});
      if (step == 2 || step == 7) worlds->reset(1);
    }
    if (step == 4) Gate::open(), moving.wait_until_placed();
    moving.step();
    serial.step();
    CHECK(moving.is_placed() == (step >= 4));
    REQUIRE(moving.state_hashes() == serial.state_hashes());
  }
  CHECK(moving.placement_report().building.steps_on_cpu == 4);
}

TEST_CASE("start on the CPU: the move copies what is used, not the room for it")
{
  require_pocl();
  std::vector<uint64_t> moved;
  for (const uint32_t pairs : {1000u, 100000u}) {
    const Gate gate;
    sharing_fails = true; /* so that PoCL has a memory of its own */
    World world(load_scene(scene_text), {}, on_cpu_at_first());
    const OpenAtLast opened;
    for (int step = 0; step < 5; ++step) world.step();
    world.reserve_pairs(pairs);
    CHECK(world.bytes_moved() == 0);
    world.step();
    Gate::open();
    world.wait_until_placed();
    REQUIRE_FALSE(world.backend_of(Kernel::solve_contacts).storage().shares_host_memory());
    world.step();
    moved.push_back(world.bytes_moved());
  }
  CHECK(moved[0] > 0);
  CHECK(moved[0] == moved[1]);
}

TEST_CASE("start on the device: who waits is told how many kernels are built")
{
  require_pocl();
  std::vector<std::pair<size_t, size_t>> told;
  Placement placement{"cl:pocl", {}};
  placement.while_building = [&](size_t built, size_t kernels) { told.emplace_back(built, kernels); };
  World world(load_scene(scene_text), {}, placement);
  CHECK(backends_of(world) == on_device);
  CHECK(world.placement_report().building.steps_on_cpu == 0);
  REQUIRE_FALSE(told.empty());
  for (const auto &[built, kernels] : told) {
    CHECK(kernels == world.kernels().size());
    CHECK(built <= kernels);
  }
  CHECK(std::is_sorted(told.begin(), told.end()));
}

} // namespace tandem::start_on_cpu
