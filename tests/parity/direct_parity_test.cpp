/* The solver direct, whose islands the host solves on every backend: the bits are those of the serial backend. */
#include <tandem/scene.h>

#include "host/runtime/memory.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

const std::vector<std::string> &direct_scenes()
{
  static const std::vector<std::string> scenes = {"mixed:n=60", "box-stack:n=12,height=4",
                                                  "spheres:n=40,height=0,restitution=0.5"};
  return scenes;
}

std::vector<std::string> backends_of_the_cpu()
{
  std::vector<std::string> backends = {"serial", "serial:order=backward", "serial:order=shuffled",
                                       "tbb:threads=7,lanes=1"};
  for (const uint32_t lanes : {4u, 8u, 16u})
    if (minicl::lanes_table(lanes)) backends.push_back("tbb:threads=7,lanes=" + std::to_string(lanes));
  return backends;
}

const Backend &backend_of_islands(const Placement &placement)
{
  static std::unique_ptr<World> world;
  world = std::make_unique<World>(load_scene("spheres:n=4"), settings_for(Solver::direct), placement);
  return world->backend_of(Kernel::solve_islands);
}

} // namespace

TEST_CASE("parity on CPU: the solver direct")
{
  for (const std::string &scene : direct_scenes())
    require_parity(scene, backends_of_the_cpu(), 20, settings_for(Solver::direct));
}

TEST_CASE("parity on OpenCL: the solver direct")
{
  require_pocl();
  Settings settings = settings_for(Solver::direct);
  settings.specialise = false; /* one build for all scenes */
  for (const std::string &scene : direct_scenes()) require_parity(scene, {"serial", "cl:pocl"}, 12, settings);
}

TEST_CASE("parity on CPU: a stage of the host stays there wherever it is placed, and says so")
{
  for (const Placement &placement :
       {Placement{"serial", {}, false}, Placement{"tbb", {{"solve_islands", "serial"}}, false},
        Placement{"tbb", {{"solve", "reference"}}, false}}) {
    CHECK(backend_of_islands(placement).name() == "host (CPU only)");
  }
  CHECK_THROWS_AS(backend_of_islands(Placement{"serial", {{"solve_islands", "no-such-backend"}}, false}), InputError);
}

TEST_CASE("parity on OpenCL: islands solved on the host between stages on a device")
{
  require_pocl();
  const uint64_t expected = state_after("mixed:n=20", "serial", 8, settings_for(Solver::direct));
  World world(load_scene("mixed:n=20"), settings_for(Solver::direct),
              Placement{"tbb", {{"setup", "cl:pocl"}, {"integrate", "cl:pocl"}}, false});
  for (int k = 0; k < 8; ++k) world.step();
  CHECK(world.state_hash() == expected);
}

/* Doubles of the reference are read and written back as doubles, whoever looks at the buffers in between. */
TEST_CASE("parity on CPU: the solver direct in double does not round what passes through it")
{
  const auto position = [](bool observed) {
    World world(load_scene("mixed:n=8"), settings_for(Solver::direct), Placement{"reference", {}, false});
    if (observed)
      world.set_observer(
          [&](const Launch &) { world.memory().acquire(Buffer::solver_velocity, host_storage(), Access::in); });
    for (int k = 0; k < 10; ++k) world.step();
    return world.precise_bodies().back().position;
  };
  CHECK(position(true) == position(false));
  CHECK(position(false)[1] != double(float(position(false)[1])));
}

namespace {

/* How often the host reads memory that is not its own, in a step of a scene that has come to rest. */
double reads_of_a_step(World &world)
{
  for (int step = 0; step < 30; ++step) world.step();
  const uint64_t before = world.device_reads();
  for (int step = 0; step < 10; ++step) world.step();
  return static_cast<double>(world.device_reads() - before) / 10;
}

} // namespace

/* Rows that nothing writes within a step are read once. The others are those of eight passes: impulses and velocity,
 * and how far bodies have moved. */
TEST_CASE("the solver direct reads again what was written, and nothing of islands that are too large")
{
  World small(load_scene("box-stack:n=12,height=4"), settings_for(Solver::direct), {"reference", {}});
  CHECK(reads_of_a_step(small) <= 60);
  CHECK(small.statistics().direct_islands == 3);
  CHECK(small.statistics().direct_left == 0);
  World large(load_scene("pyramid:rows=10"), settings_for(Solver::direct), {"reference", {}});
  CHECK(reads_of_a_step(large) <= 20);
  CHECK(large.statistics().direct_islands == 0);
  CHECK(large.statistics().direct_left > 0);
}
