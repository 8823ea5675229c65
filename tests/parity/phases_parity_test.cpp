/* Steps whose launches are joined have the bits of the serial backend, and need few launches. PoCL joins kernels of
 * single items alone (host/runtime/opencl/phases.cpp); parity.oclgrind.phases joins groups, too. */
#include "tests/host/runtime/opencl/opencl_device.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

std::vector<uint64_t> hashes_of(World &world, int steps)
{
  std::vector<uint64_t> hashes;
  for (int k = 0; k < steps; ++k) {
    world.step();
    const auto last = static_cast<uint32_t>(world.scene().bodies.size() - 1);
    if (k % 20 == 10) world.add_impulse(world.id_of(last), {{0, 1, 0}});
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

/* The number of launches of all steps after those that warm up. */
uint64_t launches_of(World &world)
{
  for (int k = 0; k < 3; ++k) world.step();
  const uint64_t before = world.launches();
  for (int k = 0; k < 10; ++k) world.step();
  return world.launches() - before;
}

/* PoCL takes ten seconds to compile the contacts of a program of phases, so one test has them on the CPU. */
void require_joined_equal(const std::string &scene, const Settings &settings, int steps, const Placement &placement)
{
  CAPTURE(scene);
  World serial(load_scene(scene), settings, {"serial", {}, false});
  std::unique_ptr<World> joined;
  {
    const Environment mode("TANDEM_PHASES", "together");
    joined = std::make_unique<World>(load_scene(scene), settings, placement);
  }
  REQUIRE(hashes_of(*joined, steps) == hashes_of(serial, steps));
  REQUIRE(launches_of(*joined) < launches_of(serial) / 2);
}

} // namespace

TEST_CASE("parity on OpenCL: joined launches of boxes")
{
  require_pocl();
  require_joined_equal("box-grid:nx=3,ny=3,nz=3", {}, 40, {"cl:pocl", {}, false});
}

TEST_CASE("parity on OpenCL: joined launches with events, rolling and islands that sleep and wake")
{
  require_pocl();
  Settings settings;
  settings.sleeping = true;
  settings.sleep_time = 0.1f;
  settings.events = true;
  require_joined_equal("mixed:n=12", settings, 120, {"cl:pocl", {{"narrowphase", "serial"}}, false});
}
