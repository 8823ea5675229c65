/* steady_steps.cpp - a step that finds room for all it needs allocates nothing: each one of several, on any backend, of
 * the pipeline alone and with a module of a user's. */
#include <array>
#include <string>
#include <vector>

#include <tbb/task_arena.h>

#include <tandem/world.h>

#include "probe.h"
#include "tests/heap/allocations.h"
#include "tests/heap/heap_cases.h"
#include "tests/heap/malloc_calls.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::fault_scenes;
using namespace tests::heap;

namespace {

constexpr size_t steps = 20;
using Counts = std::array<uint64_t, steps>;

std::vector<std::string> all_backends()
{
  std::vector<std::string> backends{"serial", "tbb:threads=2"};
  parity::add_pocl(backends);
  return backends;
}

/* Of each of the next steps. */
Counts allocations(World &world)
{
  Counts counts{};
  for (uint64_t &count : counts) {
    const Failing never(UINT64_MAX);
    world.step();
    count = asked();
  }
  return counts;
}

void check_allocates_nothing(const Scene &scene, const Settings &settings, const std::string &backend,
                             uint32_t states = 0)
{
  CAPTURE(backend, states);
  World world(scene, settings, {backend, {}});
  world.keep_states(states);
  for (int i = 0; i < 40; ++i) world.step();
  const Statistics before = world.statistics();
  const Counts counts = allocations(world);
  REQUIRE(world.statistics().overflow == before.overflow);
  CHECK(counts == Counts{});
}

/* Stacks of boxes that slide, and balls that bounce for ever, so that every step has other contacts and no island is at
 * rest. */
Scene small_islands()
{
  Scene scene;
  scene.name = "small islands";
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.25f)};
  scene.materials.resize(2);
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0.1f;
  scene.materials[1].restitution = 1;
  scene.bodies.resize(1);
  scene.bodies[0].type = BodyType::fixed;
  for (int k = 0; k < 12; ++k) {
    Body box;
    box.shape = 1;
    box.position = {0, 0.5 + k % 3, 3.0 * (k / 3)};
    box.linear_velocity = {5, 0, 0};
    scene.bodies.push_back(box);
    Body ball;
    ball.shape = 2;
    ball.material = 1;
    ball.position = {0, 0.25 + 0.02 * k, -2.0 - k};
    scene.bodies.push_back(ball);
  }
  return scene;
}

/* A kernel with a value, one of pairs, one at the commit, and one of groups with a slot. */
Extension probing()
{
  return {&probe::module(),
          [](World &world) {
            const std::vector<float> force{0.01f, 0, 0, 0};
            world.write<float>(probe::buffer::probe_force(), force);
            world.write<uint32_t>(probe::buffer::probe_ghost(), std::vector<uint32_t>(world.bodies().size()));
          },
          {{StepPoint::contacts, [](Launches &launches) { launches.run(probe::kernel::probe_drop()); }},
           {StepPoint::forces,
            [](Launches &launches) {
              const uint32_t times[] = {2};
              launches.run(probe::kernel::probe_push(), times);
            }},
           {StepPoint::commit, [](Launches &launches) {
              const Buffer values[] = {probe::buffer::probe_age()};
              launches.run(probe::kernel::probe_count());
              launches.run(probe::kernel::probe_sum(), {}, values);
            }}}};
}

} // namespace

TEST_CASE("heap: a step that finds room for all it needs allocates nothing, on any backend")
{
  const std::vector<Case> all = heap_cases();
  for (const std::string &backend : all_backends())
    for (size_t k = 0; k < all.size(); ++k) {
      const Case &c = all[k];
      if (backend == "cl:pocl" && k % 3 != 0) continue; /* launched alike */
      CAPTURE(c.what, c.scene);
      const bool compiles = backend == "cl:pocl" && k > 0; /* for seconds, unless all share a build */
      check_allocates_nothing(load_scene(c.scene), compiles ? parity::build_of_all_features(c.settings) : c.settings,
                              backend);
    }
}

TEST_CASE("heap: a step that solves islands directly allocates nothing, on any backend")
{
  const Settings settings = short_step(with(Solver::direct, Broadphase::grid, true));
  for (const std::string &backend : all_backends()) check_allocates_nothing(small_islands(), settings, backend);
}

/* Eigen takes memory from malloc, past operator new. So does TBB where its own pool (libtbbmalloc) is missing, hence
 * the one thread, with which there are no tasks. */
TEST_CASE("heap: a step that solves islands directly does not call malloc")
{
  tbb::task_arena one(1);
  one.execute([] {
    World world(small_islands(), short_step(with(Solver::direct, Broadphase::grid, true)), {"serial", {}});
    for (int i = 0; i < 40; ++i) world.step();
    for (size_t k = 0; k < steps; ++k) {
      CAPTURE(k);
      CHECK(malloc_calls([&] { world.step(); }) == 0);
      CHECK(world.statistics().direct_islands >= 4);
      CHECK(world.statistics().direct_left == 0);
    }
  });
}

TEST_CASE("heap: a step whose state is kept allocates nothing, on any backend")
{
  for (const std::string &backend : all_backends())
    check_allocates_nothing(load_scene("box-grid:nx=3,ny=3,nz=3"),
                            short_step(with(Solver::soft_step, Broadphase::grid, true)), backend, 4);
}

TEST_CASE("heap: a step with a module of a user's allocates nothing, on any backend")
{
  Settings settings = short_step(with(Solver::soft_step, Broadphase::grid, true));
  settings.extensions = {probing()};
  for (const std::string &backend : all_backends())
    check_allocates_nothing(load_scene("box-grid:nx=2,ny=2,nz=2"), settings, backend);
}
