/* A world that chooses its placement by times: whatever it chooses, and whenever, the bits are those of `serial`. Its
 * clock is the test's, so that the choices are, too. */
#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

#include "host/runtime/interface/faults.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

/* Each reading is later than the one before by a time that a script or chance gives. */
struct Clock {
  double time = 0;
  std::function<double()> next;
  std::function<double()> reading()
  {
    return [this] { return time += next(); };
  }
};

Placement automatic_on(const std::string &device, const std::function<double()> &clock)
{
  Placement placement{device, {}};
  placement.automatic = true;
  placement.clock = clock;
  return placement;
}

/* A step takes 1 ms on the CPU, and this long where any of it runs on the device. */
std::function<double()> device_takes(double milliseconds, World *&world)
{
  return [milliseconds, &world] {
    if (!world) return 0.0;
    for (const Kernel kernel : world->kernels())
      if (world->backend_of(kernel).name().starts_with("cl")) return milliseconds;
    return 1.0;
  };
}

std::vector<std::string> backends_of(World &world)
{
  std::vector<std::string> names;
  for (const Kernel kernel : world.kernels()) names.push_back(world.backend_of(kernel).name().substr(0, 3));
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

void settle(World &world)
{
  world.finish(); /* waits for the device's kernels */
  for (int step = 0; step < 3000 && !world.placement_report().settled; ++step) {
    world.step();
    world.finish();
    std::this_thread::sleep_for(std::chrono::milliseconds(1)); /* for a thread that builds kernels */
  }
  REQUIRE(world.placement_report().settled);
}

} // namespace

TEST_CASE("automatic placement: the faster of CPU and device runs, and the report says so")
{
  require_pocl();
  for (const double milliseconds : {0.25, 4.0}) {
    World *asked = nullptr;
    Clock clock{0, device_takes(milliseconds, asked)};
    World world(load_scene("box-grid:nx=3,ny=3,nz=3"), {}, automatic_on("cl:pocl", clock.reading()));
    asked = &world;
    CHECK_FALSE(world.placement_report().settled);
    settle(world);
    world.step(); /* the first where it was chosen to be */
    const PlacementReport report = world.placement_report();
    CAPTURE(milliseconds, report.on, report.why);
    CHECK(backends_of(world) == std::vector<std::string>{milliseconds < 1 ? "cl:" : "tbb"});
    CHECK(report.on == (milliseconds < 1 ? "cl:pocl" : "tbb"));
    REQUIRE(report.times.size() >= 2);
    CHECK(report.times[0].milliseconds == 1);
    CHECK(report.times[1].milliseconds == milliseconds);
    CHECK(report.stages.size() > 3);
  }
}

TEST_CASE("automatic placement: without a device all runs on the CPU, and what times may not choose is refused")
{
  World cpu(load_scene("box-stack:n=10"), {}, [] {
    Placement placement{"tbb:threads=2", {}};
    placement.automatic = true;
    return placement;
  }());
  for (int step = 0; step < 5; ++step) cpu.step();
  CHECK(cpu.placement_report().settled);
  CHECK(cpu.placement_report().on == "tbb:threads=2");
  CHECK(cpu.placement_report().why.find("no OpenCL device is named") != std::string::npos);
  CHECK(cpu.state_hash() == state_after("box-stack:n=10", "serial", 5));
  CHECK_THROWS_AS(World(load_scene("box-stack:n=2"), {}, automatic_on("cl:no-such-device", {})), InputError);
  CHECK_THROWS_AS(World(load_scene("box-stack:n=2"), {}, automatic_on("reference", {})), InputError);
  Placement inexact = automatic_on("tbb", {});
  inexact.allow_inexact = true;
  CHECK_THROWS_AS(cpu.place(inexact), InputError);
}

TEST_CASE("automatic placement: where a device cannot build the kernels, the CPU goes on and the report says why")
{
  require_pocl();
  const Scene scene = load_scene("box-stack:n=10");
  faults::hook = [](faults::Site site) { return site == faults::Site::build; };
  World world(scene, {}, automatic_on("cl:pocl", {}));
  settle(world);
  faults::hook = nullptr;
  const PlacementReport report = world.placement_report();
  CAPTURE(report.why);
  CHECK(report.on == "tbb");
  CHECK(report.why.find("kernel") != std::string::npos);
  world.step();
  CHECK(backends_of(world) == std::vector<std::string>{"tbb"});
  CHECK(world.state_hash() == state_after("box-stack:n=10", "serial", world.statistics().steps));
}

namespace {

/* A day in which the size of the scene changes: bodies come and go, sleep and wake, and a state is restored. */
void live(World &world, uint64_t step, std::vector<BodyId> &made, std::vector<std::byte> &saved)
{
  if (step % 15 == 4) {
    std::vector<Body> bodies(world.scene().bodies.end() - 4, world.scene().bodies.end());
    for (size_t i = 0; i < bodies.size(); ++i) bodies[i].position[1] += 3.0 + double(i) + double(step) / 5;
    const std::vector<BodyId> more = world.create_bodies(bodies);
    made.insert(made.end(), more.begin(), more.end());
  }
  if (step % 40 == 39) {
    world.destroy_bodies(made);
    made.clear();
  }
  if (step == 60) world.set_damping(world.id_of(3), 0.5f, 0.5f); /* other kernels, which a device has to build */
  if (step == 80) saved = world.save();
  if (step == 95) {
    made.clear();
    world.restore(saved);
  }
}

} // namespace

TEST_CASE("automatic placement: the bits are those of serial, whatever is chosen and whenever it changes")
{
  require_pocl();
  Settings settings;
  settings.sleeping = true;
  settings.events = true;
  settings.sleep_time = 0.1f;
  const Scene scene = load_scene("falling-boxes:n=25,height=0");
  for (const uint64_t seed : {1u, 2u, 3u}) {
    Random random(seed);
    Clock clock{0, [&] { return 0.001 + random.uniform(0, 1); }};
    World still(scene, settings, {"serial", {}}), moving(scene, settings, automatic_on("cl:pocl", clock.reading()));
    std::vector<BodyId> of_still, of_moving;
    std::vector<std::byte> saved_still, saved_moving;
    std::set<std::string> ran_on;
    for (uint64_t step = 0; step < 140; ++step) {
      live(still, step, of_still, saved_still);
      live(moving, step, of_moving, saved_moving);
      if (step == 20) moving.finish(); /* up to here it may or may not have been built */
      still.step();
      moving.step();
      ran_on.insert(moving.placement_report().on);
      CAPTURE(seed, step, moving.placement_report().on);
      REQUIRE(moving.state_hash() == still.state_hash());
    }
    CHECK(ran_on.size() > 1);
  }
}
