/* Couplings of joints give the serial backend's bits on every backend, in batches of worlds, with bodies that sleep,
 * and from every state that was kept or written down. */
#include "host/scene/coupling_graph.h"
#include "shared/counts.h"
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/host/world/worlds.h"
#include "tests/parity/couplings.h"

namespace tandem::parity {
namespace {

using namespace physics_tests;
using tests::BatchBesideWorlds;

Settings checked()
{
  Settings settings;
  settings.events = settings.check = true;
  return settings;
}

uint64_t hash_of_run(const Scene &scene, int steps, const Settings &settings, const Placement &placement)
{
  World world(scene, settings, placement);
  run(world, steps);
  return world.state_hash();
}

/* With few kernels to compile. */
Scene with_spheres_alone(Scene scene)
{
  for (Shape &shape : scene.shapes) shape = sphere_shape(0.2f);
  scene.bodies[0].position = {0, -3, 0}; /* the ground */
  return scene;
}

/* The same number of bodies, with other couplings, of which some belong to joints that are not enabled. */
std::vector<Scene> coupled_worlds()
{
  std::vector<Scene> scenes;
  for (int k = 0; k < 5; ++k) scenes.push_back(coupling_crowd(1));
  for (size_t k = 0; k < scenes[4].joints.size(); k += 4) scenes[4].joints[k].enabled = false;
  scenes[4].joints[0].enabled = true; /* the wheel with more couplings than there are colours */
  for (size_t k = 0, count = scenes[4].couplings.size(); k < count; ++k) {
    Coupling turned = scenes[4].couplings[k];
    if (turned.type != CouplingType::gear || turned.joint_b == 0) continue;
    std::swap(turned.joint_a, turned.joint_b);
    std::swap(turned.teeth_a, turned.teeth_b);
    scenes[4].couplings.push_back(turned);
  }
  scenes[1].couplings.clear();
  scenes[2].couplings.resize(20);
  std::reverse(scenes[3].couplings.begin(), scenes[3].couplings.end());
  return scenes;
}

} // namespace

TEST_CASE("a crowd of couplings has those that its tests are for")
{
  const Scene scene = coupling_crowd();
  const CouplingGraph graph = coupling_graph_of(scene);
  CHECK(graph.colors == COLOR_LIMIT + 1);
  CHECK(graph.starts.back() - graph.starts[COLOR_OVERFLOW] > 2);
  for (const CouplingType type :
       {CouplingType::gear, CouplingType::rack_and_pinion, CouplingType::pulley, CouplingType::mimic})
    CHECK(std::count_if(scene.couplings.begin(), scene.couplings.end(),
                        [&](const Coupling &coupling) { return coupling.type == type; }) > 3);
}

TEST_CASE("parity on CPU: couplings of every type, and past the last colour")
{
  require_parity(coupling_crowd(), cpu_backends(), 20, checked());
  require_parity(coupling_crowd(2, 40), cpu_backends(), 20, checked());
  for (const char *scene : {"motor-mill:wheels=5,stones=20", "crane"}) require_parity(scene, cpu_backends(), 30);
}

TEST_CASE("parity on OpenCL: couplings")
{
  require_pocl();
  require_parity(with_spheres_alone(coupling_crowd()), {"serial", "cl:pocl"}, 8, build_of_all_features());
}

TEST_CASE("couplings in their own place, and with every feature built, have the same bits")
{
  const Scene scene = coupling_crowd();
  const uint64_t expected = hash_of_run(scene, 20, {}, {"serial", {}, false});
  Settings whole;
  whole.specialise = false;
  CHECK(hash_of_run(scene, 20, whole, {"tbb", {}, false}) == expected);
  for (const char *exceptions : {"joints=serial", "joints=serial:order=backward,solve=tbb"})
    CHECK(hash_of_run(scene, 20, {}, Placement{"tbb", parse_placement(exceptions), false}) == expected);
  Scene uncoupled = scene;
  uncoupled.couplings.clear();
  CHECK(hash_of_run(uncoupled, 20, {}, {"serial", {}, false}) != expected);
}

TEST_CASE("a world with couplings goes on from its snapshot with the same bits, anywhere")
{
  require_goes_on(coupling_crowd(4), checked(), [](const World &world, const World &original) {
    CHECK(world.scene().couplings == original.scene().couplings);
  });
}

TEST_CASE("parity on CPU: worlds of a batch with couplings have the bits of worlds alone")
{
  BatchBesideWorlds(coupled_worlds(), "serial", {}).step(15);
  BatchBesideWorlds(coupled_worlds(), "tbb:threads=3,lanes=4", {}).step(10);
  BatchBesideWorlds(tests::varied_scenes("motor-mill:wheels=3,stones=12", 3), "tbb", {}).step(15);
}

TEST_CASE("parity with PoCL: worlds of a batch with couplings have the bits of worlds alone")
{
  require_pocl();
  std::vector<Scene> scenes;
  for (const Scene &scene : coupled_worlds()) scenes.push_back(with_spheres_alone(scene));
  BatchBesideWorlds(scenes, "cl:pocl", {}).step(4);
}

namespace {

void disturb_pendulums(World &world, uint64_t step)
{
  if (step % 60 == 50) world.add_impulse(world.body_ids()[step / 60 * 3 % 16], {.angular_impulse = {0.3f, 0, 0}});
}

} // namespace

TEST_CASE("parity on CPU: couplings that sleep and wake with their joints")
{
  ComparisonRequest request;
  request.settings.sleeping = true;
  request.settings.sleep_time = 0.2f;
  request.backends = cpu_backends();
  request.steps = 320;
  request.before_step = disturb_pendulums;
  const Comparison comparison = compare_backends(coupled_pendulums(), request);
  if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
}

TEST_CASE("what is coupled sleeps and wakes together, and goes on from a snapshot while some sleep")
{
  Settings settings;
  settings.sleeping = true;
  settings.sleep_time = 0.2f;
  World world(coupled_pendulums(), settings, {"serial", {}, false});
  std::unique_ptr<World> restored;
  size_t fallen = 0, some = 0;
  for (uint64_t step = 0; step < 320; ++step) {
    disturb_pendulums(world, step);
    if (restored) disturb_pendulums(*restored, step);
    world.step();
    if (restored) restored->step();
    for (uint32_t i = 0; i < 16; i += 2) {
      REQUIRE(world.is_asleep(world.id_of(i)) == world.is_asleep(world.id_of(i + 1)));
      fallen += world.is_asleep(world.id_of(i));
    }
    const auto asleep = uint32_t(world.statistics().asleep);
    some += asleep > 0 && asleep < 16;
    if (restored) REQUIRE(restored->body_hash() == world.body_hash());
    else if (asleep > 0 && asleep < 16 && step > 100)
      restored = std::make_unique<World>(world.save(), Placement{"tbb:threads=3,lanes=4", {}, false});
  }
  CHECK(restored);
  CHECK(fallen > 500);
  CHECK(some > 50);
  /* the pair that stands farthest from its hinges pulls with 7 N m at a stiffness of 3,100 N m/rad */
  for (const double error : coupling_errors(world.scene(), world.precise_bodies())) CHECK(error < 1.2 * 7 / 3100);
}

} // namespace tandem::parity
