/* probe.cpp - runs a small scene in which gdb stops, and prints the value that gdb must then show.
 *
 * The value is the first normal impulse of item 17 after step 3's first launch of solve_contacts that holds this item.
 * A debugger sees it at the end of that item; the program reads it from the buffer. `probe threads` runs a scene that
 * several threads share, so that gdb can inspect the step in one of them.
 */
#include <cinttypes>
#include <cstdio>
#include <cstring>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"

using namespace tandem;

namespace {

constexpr uint32_t item = 17;
constexpr uint64_t step = 3;

bool holds_item(World &world, const Launch &launch)
{
  const auto count = [&](uint32_t entry) { return world.memory().read<uint32_t>(Buffer::counts, 1, entry).at(0); };
  return launch.kernel == Kernel::solve_contacts && count(launch.first) <= item && item < count(launch.last);
}

void print_impulse(World &world)
{
  const float impulse = world.memory().read<float>(Buffer::constraint_normal_impulse, 1, 4 * item).at(0);
  uint32_t bits;
  std::memcpy(&bits, &impulse, sizeof bits);
  std::printf("impulse %.9g bits 0x%" PRIx32 "\n", static_cast<double>(impulse), bits);
}

void run_in_threads()
{
  World world(load_scene("box-grid:nx=9,ny=9,nz=9"), {}, Placement{"tbb:threads=2,lanes=1", {}, false});
  for (int k = 0; k < 20; ++k) world.step();
}

} // namespace

int main(int count, char **)
{
  if (count > 1) return run_in_threads(), 0;
  World world(load_scene("box-grid:nx=3,ny=3,nz=3"), {}, Placement{"serial", {}, false});
  bool printed = false;
  world.set_observer([&](const Launch &launch) {
    if (world.statistics().steps != step || printed || !holds_item(world, launch)) return;
    print_impulse(world);
    printed = true;
  });
  for (uint64_t k = 0; k <= step; ++k) world.step();
  return printed ? 0 : 1;
}
