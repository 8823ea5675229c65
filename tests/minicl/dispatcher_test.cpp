/* The dispatcher hands each item of a range to exactly one thread and width, and a launch sees what the one before it
 * wrote. */
#include <algorithm>
#include <array>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "host/runtime/interface/debug.h"
#include "host/runtime/make_backend.h"
#include "minicl/dispatcher.h"
#include "tests/catch.h"
#include "tests/parity/parity.h"

using namespace tandem;

namespace {

/* Fills [first, last) of the values through the backend. */
void fill(Backend &backend, std::vector<uint32_t> &values, uint32_t first, uint32_t last, uint32_t value)
{
  std::array<uint32_t, COUNT_TOTAL> counts{};
  counts[COUNT_GRID_X] = first;
  counts[COUNT_LENGTH] = last;
  Launch launch;
  launch.kernel = Kernel::fill;
  launch.first = COUNT_GRID_X;
  launch.last = COUNT_LENGTH;
  backend.run(launch, {{values.data(), 0}, {nullptr, value}}, counts.data());
  backend.finish();
}

bool all_equal(const std::vector<uint32_t> &values, uint32_t first, uint32_t last, uint32_t value)
{
  return std::all_of(values.begin() + first, values.begin() + last, [&](uint32_t v) { return v == value; });
}

Placement on(const std::string &backend) { return {backend, {}, false}; }

uint64_t hash_after(World &world, uint64_t steps)
{
  while (world.statistics().steps < steps) world.step();
  return world.state_hash();
}

/* A worker may come late to short launches, so a scene goes on until one has come. */
uint32_t threads_seen(World &world, uint64_t least_steps)
{
  const auto seen = [&] { return minicl::threads_used(world.backend_of(Kernel::compute_bounds)); };
  for (uint64_t k = 0; k < least_steps || (seen() < 2 && k < 300); ++k) world.step();
  return seen();
}

} // namespace

TEST_CASE("every item of a range is written and none outside it", "[sanitizer]")
{
  for (const std::string name : {"serial", "serial:order=backward", "serial:order=shuffled", "tbb:threads=4,lanes=1",
                                 "tbb:threads=4,lanes=4", "tbb:threads=7"}) {
    const std::unique_ptr<Backend> backend = make_backend(name);
    for (uint32_t length : {0u, 1u, 255u, 256u, 257u, 5000u}) {
      const uint32_t first = 3, last = first + length;
      std::vector<uint32_t> values(last + 5, 1u);
      CAPTURE(name, length);
      fill(*backend, values, first, last, 2u);
      CHECK(all_equal(values, 0, first, 1u));
      CHECK(all_equal(values, first, last, 2u));
      CHECK(all_equal(values, last, last + 5, 1u));
    }
  }
}

TEST_CASE("a launch overwrites what other threads wrote in the one before", "[sanitizer]")
{
  const std::unique_ptr<Backend> backend = make_backend("tbb:threads=4,lanes=4");
  std::vector<uint32_t> values(20000, 0u);
  for (uint32_t round = 1; round <= 50; ++round) {
    fill(*backend, values, round, 20000u - 7u * round, round);
    CHECK(all_equal(values, round, 20000u - 7u * round, round));
  }
}

/* More bodies and pairs than a task takes, for every family of kernels that threads share. */
TEST_CASE("several threads take part in the steps of scenes of more than a task's items", "[sanitizer]")
{
  for (const char *scene :
       {"box-grid:nx=9,ny=7,nz=9", "mixed:n=500", "spheres:n=600,height=0,restitution=0.5", "hulls-on-mesh:n=300"}) {
    World world(load_scene(scene), {}, on("tbb:threads=4,lanes=4"));
    CAPTURE(scene);
    CHECK(threads_seen(world, 3) > 1);
  }
  for (const Solver solver : {Solver::pgs, Solver::nncg, Solver::jacobi, Solver::xpbd, Solver::avbd}) {
    Settings settings;
    settings.solver = solver;
    World world(load_scene("box-grid:nx=9,ny=5,nz=9"), settings, on("tbb:threads=4,lanes=4"));
    CAPTURE(solver);
    CHECK(threads_seen(world, 2) > 1);
  }
}

TEST_CASE("one thread splits nothing")
{
  World alone(load_scene("box-grid:nx=9,ny=7,nz=9"), {}, on("tbb:threads=1"));
  alone.step();
  CHECK(minicl::threads_used(alone.backend_of(Kernel::compute_bounds)) == 0);
}

TEST_CASE("worlds that step in two threads at the same time have the bits that each has alone", "[sanitizer]")
{
  const Scene scene = load_scene("box-grid:nx=9,ny=5,nz=9"), other = load_scene("mixed:n=400");
  World alone(scene, {}, on("serial")), other_alone(other, {}, on("serial"));
  World first(scene, {}, on("tbb:threads=2,lanes=4")), second(other, {}, on("tbb:threads=2,lanes=4"));
  uint64_t hash = 0, other_hash = 0;
  std::thread one([&] { hash = hash_after(first, 6); }), two([&] { other_hash = hash_after(second, 6); });
  one.join();
  two.join();
  CHECK(hash == hash_after(alone, 6));
  CHECK(other_hash == hash_after(other_alone, 6));
}

/* Contacts of one colour, as many as there are boxes, and joints: what does not fill the lanes is padded. With auto and
 * restitution, so that contacts are weighed and bounce, too. */
TEST_CASE("colours of any size have the same bits in lanes", "[sanitizer]")
{
  std::vector<std::string> backends = {"serial"};
  for (const uint32_t lanes : {4u, 8u, 16u})
    if (minicl::lanes_table(lanes)) backends.push_back(fmt::format("tbb:threads=1,lanes={}", lanes));
  Settings weighed;
  weighed.substeps = automatic_substeps;
  for (const uint32_t boxes : {1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 13u, 15u, 16u, 17u, 31u, 33u, 139u}) {
    parity::require_parity(fmt::format("box-grid:nx={},ny=1,nz=1", boxes), backends, 4);
    parity::require_parity(fmt::format("spheres:n={},height=0,restitution=0.5", boxes), backends, 20, weighed);
  }
  for (const uint32_t people : {1u, 2u, 3u})
    parity::require_parity(fmt::format("ragdolls:n={},height=0.1", people), backends, 4);
}

/* The value that a debugger's condition reads: while a launch of one world is inspected, another world steps in another
 * thread. */
TEST_CASE("the step that a thread tells a debugger is that of its own world", "[sanitizer]")
{
  const Scene scene = load_scene("box-grid:nx=2,ny=2,nz=2");
  World world(scene, {}, on("tbb:threads=2"));
  for (int k = 0; k < 2; ++k) world.step();
  uint64_t launches = 0, right = 0;
  world.set_observer([&](const Launch &) {
    if (launches++ == 0) std::thread([&] { World(scene, {}, on("serial")).step(); }).join();
    right += step_of_launch == 2;
  });
  world.step();
  CHECK(launches > 10);
  CHECK(right == launches);
}
