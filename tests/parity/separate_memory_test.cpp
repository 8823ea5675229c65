/* Devices with a memory of their own, as PoCL is one where it is kept from sharing the host's: what moves between
 * memories suffices for the bits, and is no more than what a step uses. */
#include <atomic>

#include "host/runtime/interface/faults.h"
#include "host/runtime/interface/storage.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

std::atomic<bool> sharing_fails{false};

/* A device tests whether it shares the host's memory by its first transfer. */
bool fail_to_share(faults::Site site) { return site == faults::Site::transfer && sharing_fails.exchange(false); }

const char *const device = "cl:pocl";

/* Everything runs on PoCL, with a memory of its own. */
std::unique_ptr<World> separate_world(const Scene &scene, const Settings &settings)
{
  sharing_fails = true;
  faults::hook = fail_to_share;
  auto world = std::make_unique<World>(scene, settings, Placement{device, {}, false, false});
  faults::hook = nullptr;
  sharing_fails = false;
  REQUIRE_FALSE(world->backend_of(world->kernels().front()).storage().shares_host_memory());
  return world;
}

/* Half of the kernels, others in each step. */
Placement random_placement(World &world, Random &random)
{
  Placement placement{device, {}, false, false};
  for (const Kernel kernel : world.kernels())
    if (random.below(2)) placement.exceptions.emplace_back(row_of(kernel).name, "serial");
  return placement;
}

void require_same_states(const Scene &scene, const Settings &settings, uint64_t steps)
{
  CAPTURE(scene.name, settings.broadphase, settings.solver, settings.batching);
  World still(scene, settings, {"serial", {}});
  const std::unique_ptr<World> moving = separate_world(scene, settings);
  moving->memory().poison_shared_memory();
  Random random(7);
  for (uint64_t step = 0; step < steps; ++step) {
    moving->place(random_placement(*moving, random));
    still.step();
    moving->step();
    CAPTURE(step);
    REQUIRE(moving->state_hash() == still.state_hash());
  }
  CHECK(moving->bytes_moved() > 0);
  CHECK(still.bytes_moved() == 0);
}

Settings with_all_features(Solver solver = Solver::soft_step)
{
  Settings settings = settings_for(solver);
  settings.specialise = false; /* one build serves all scenes */
  settings.events = true;
  return settings;
}

} // namespace

TEST_CASE("separate memories: kernels placed at random in each frame, in each broadphase")
{
  require_pocl();
  for (const Broadphase broadphase :
       {Broadphase::brute_force, Broadphase::grid, Broadphase::trees, Broadphase::sap3, Broadphase::bvh}) {
    Settings settings = with_all_features();
    settings.broadphase = broadphase;
    require_same_states(load_scene("mixed:n=60"), settings, 15);
    require_same_states(load_scene(few_trees()), settings, 10);
  }
}

TEST_CASE("separate memories: kernels placed at random in each frame, in each solver and batching")
{
  require_pocl();
  for (const std::string &batching : choice_names<Batching>()) {
    Settings settings = with_all_features();
    settings.batching = parse_setting<Batching>(batching);
    require_same_states(load_scene("pyramid:rows=6"), settings, 10);
  }
  for (const std::string &solver : choice_names<Solver>())
    require_same_states(load_scene("pyramid:rows=6"), with_all_features(parse_setting<Solver>(solver)), 10);
}

namespace {

/* Bytes that 10 steps move, some steps after the buffers have got their sizes. */
uint64_t bytes_of_ten_steps(const Scene &scene, uint32_t max_pairs, const Placement &placement)
{
  Settings settings;
  settings.max_pairs = max_pairs;
  const std::unique_ptr<World> world = separate_world(scene, settings);
  world->place(placement);
  for (int step = 0; step < 10; ++step) world->step();
  const uint64_t before = world->bytes_moved();
  for (int step = 0; step < 10; ++step) world->step();
  return world->bytes_moved() - before;
}

} // namespace

TEST_CASE("separate memories: what moves follows what is used, not the room for it")
{
  require_pocl();
  const Scene scene = load_scene("box-stack:n=30");
  for (const char *stage : {"narrowphase", "setup", "solve"}) {
    CAPTURE(stage);
    const Placement placement{device, {{stage, "serial"}}, false, false};
    const uint64_t moved = bytes_of_ten_steps(scene, 100, placement);
    CHECK(moved > 0);
    CHECK(moved == bytes_of_ten_steps(scene, 1000, placement));
  }
}
