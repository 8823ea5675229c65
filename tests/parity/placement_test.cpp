/* Any kernel runs on any backend in any step: buffers are transferred to the backend that reads them, and the bits
 * stay. */
#include "host/base/random.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

Placement random_placement(World &world, const std::vector<std::string> &backends, Random &random)
{
  const auto any = [&] { return backends[random.below(static_cast<uint32_t>(backends.size()))]; };
  Placement placement{any(), {}, false};
  for (const Kernel kernel : world.kernels()) placement.exceptions.emplace_back(row_of(kernel).name, any());
  return placement;
}

size_t backends_in_use(World &world)
{
  std::vector<const Backend *> found;
  for (const Kernel kernel : world.kernels()) found.push_back(&world.backend_of(kernel));
  std::sort(found.begin(), found.end());
  return static_cast<size_t>(std::unique(found.begin(), found.end()) - found.begin());
}

/* Each frame every kernel moves; each frame's state is that of a world where nothing moves. */
void require_same_states(const std::string &scene, const std::vector<std::string> &backends, uint64_t steps,
                         uint64_t seed, Broadphase broadphase = Broadphase::grid)
{
  Settings settings;
  settings.broadphase = broadphase;
  settings.specialise = false; /* one build serves all scenes on OpenCL */
  settings.events = true;      /* their part of the state is in the hash then */
  World still(load_scene(scene), settings, Placement{"serial", {}, false}),
      moving(load_scene(scene), settings, Placement{"serial", {}, false});
  Random random(seed);
  CAPTURE(scene, seed);
  for (uint64_t step = 0; step < steps; ++step) {
    moving.place(random_placement(moving, backends, random));
    CHECK(backends_in_use(moving) == backends.size());
    still.step();
    moving.step();
    CAPTURE(step);
    REQUIRE(moving.state_hash() == still.state_hash());
  }
}

} // namespace

TEST_CASE("parity on CPU: kernels placed at random in each frame", "[sanitizer]")
{
  for (uint64_t seed : {1u, 2u})
    require_same_states("mixed:n=40", {"serial", "tbb:threads=4", "serial:order=backward"}, 30, seed);
  require_same_states(every_shape(), {"serial", "tbb:threads=4", "serial:order=backward"}, 30, 3);
  require_same_states(few_trees(), {"serial", "tbb:threads=4", "serial:order=backward"}, 30, 3);
  for (const Broadphase keeping : {Broadphase::trees, Broadphase::sap3, Broadphase::bvh})
    require_same_states("mixed:n=40", {"serial", "tbb:threads=4", "serial:order=backward"}, 30, 4, keeping);
}

TEST_CASE("parity on OpenCL: kernels placed at random in each frame")
{
  require_pocl();
  require_same_states("mixed:n=60", {"serial", "tbb", "cl:pocl"}, 30, 1);
  require_same_states("box-grid:nx=4,ny=4,nz=4", {"serial", "tbb", "cl:pocl"}, 30, 2);
  require_same_states(every_shape(), {"serial", "tbb", "cl:pocl"}, 30, 3);
  for (const Broadphase keeping : {Broadphase::trees, Broadphase::sap3, Broadphase::bvh})
    require_same_states("mixed:n=60", {"serial", "tbb", "cl:pocl"}, 20, 4, keeping);
  require_same_states(few_trees(), {"serial", "tbb", "cl:pocl"}, 30, 3);
}

TEST_CASE("parity on CPU: a refused placement changes nothing")
{
  World world(load_scene("spheres:n=20,height=0"), {}, Placement{"serial", {}, false});
  world.step();
  CHECK_THROWS_AS(world.place(Placement{"tbb", {{"solve", "no-such-backend"}}, false}), InputError);
  for (const Kernel kernel : world.kernels()) CHECK(world.backend_of(kernel).name() == "serial");
  for (int k = 1; k < 10; ++k) world.step();
  CHECK(world.state_hash() == state_after("spheres:n=20,height=0", "serial", 10));
}

TEST_CASE("parity on OpenCL: kernels of a new feature run on tbb until the device has them")
{
  require_pocl();
  const Scene scene = load_scene("spheres:n=5,height=0");
  World serial(scene, {}, {"serial", {}}), device(scene, {}, {"cl:pocl", {}}),
      waiting(scene, {}, {"cl:pocl", {}, false, false});
  const auto ran_on = [](World &world) { return world.backend_of(Kernel::integrate_velocities).name().substr(0, 3); };
  for (World *world : {&serial, &device, &waiting}) {
    world->step();
    world->set_damping(world->id_of(3), 1, 1);
  }
  CHECK(ran_on(waiting) == "cl:");
  CHECK(ran_on(device) == "tbb");
  device.step();
  serial.step();
  CHECK(device.state_hash() == serial.state_hash());
  device.finish();
  CHECK(ran_on(device) == "cl:");
  device.step();
  serial.step();
  CHECK(device.state_hash() == serial.state_hash());
}
