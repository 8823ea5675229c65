/* The floors of `tandem bench floors` follow from what launches read and write. */
#include <algorithm>
#include <string>
#include <vector>

#include <tandem/load_scene.h>

#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tools/bench/floors.h"

namespace tandem {
namespace {

TEST_CASE("bench floors: a launch moves each row of its items once, and what it changes twice")
{
  World world(load_scene("box-grid:nx=6,ny=2,nz=6"), {}, {"serial", {}});
  for (int step = 0; step < 3; ++step) world.step();
  const auto counts = world.memory().read<uint32_t>(Buffer::counts, COUNT_TOTAL);
  const uint64_t bodies = 73, pairs = counts[COUNT_PAIRS];
  REQUIRE(counts[COUNT_BODIES] == bodies);
  REQUIRE(pairs > 50);
  const Launch copy{Kernel::copy, {Buffer::pair_a, Buffer::pair_b}, {}, COUNT_ZERO, COUNT_PAIRS, 0};
  CHECK(least_bytes(world, copy) == 2 * 4 * pairs);
  const Launch fill{Kernel::fill, {Buffer::pair_color}, {0}, COUNT_ZERO, COUNT_PAIRS, 0};
  CHECK(least_bytes(world, fill) == 4 * pairs);
  /* Of a constraint: a, b; normal, 4 points of 5 numbers, centre, offset, slop; the impulses of both kinds, twice; of 2
   * bodies: velocity twice, motion, the impulse of the next warm start twice. Cubes have no tensors. */
  const uint64_t constraints = counts[COLOR_START + 1] - counts[COLOR_START];
  REQUIRE(constraints > 5);
  REQUIRE(2 * constraints < bodies);
  const uint64_t each = 2 * 4 + 16 + 4 * 5 * 4 + 2 * 16 + 4 + 2 * (16 + 16) + 2 * 32 * (2 + 1 + 2);
  const Launch solve{Kernel::solve_contacts, {}, {0}, COLOR_START, COLOR_START + 1, 0};
  const uint64_t tables = least_bytes(world, solve) - constraints * each; /* counts and parameters */
  CHECK(tables < 4096);
}

TEST_CASE("bench floors: floors follow from bytes and the speed of a copy, and stages from the step")
{
  const Floors floors = bench_floors("spheres:n=50", {"serial", {}});
  CHECK(floors.bodies == 51);
  REQUIRE(floors.bytes_per_second > 0);
  std::vector<std::string> names;
  for (const StageFloor &floor : floors.stages) {
    names.push_back(floor.stage);
    CHECK(floor.floor_milliseconds == Approx(1e3 * double(floor.bytes) / floors.bytes_per_second));
    CHECK(floor.launches > 0);
  }
  for (const char *stage : {"broadphase", "narrowphase", "solve", "integrate"})
    CHECK(std::count(names.begin(), names.end(), stage) == 1);
}

} // namespace
} // namespace tandem
