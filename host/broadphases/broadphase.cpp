/* broadphase.cpp - the list of broadphases, and what they share; see broadphase.h. */
#include "host/broadphases/broadphase.h"

#include <array>
#include <stdexcept>

namespace tandem {

std::span<const Broadphase> broadphases()
{
  static constexpr std::array<Broadphase, 6> rows{{
      {"grid", "uniform grid, 27 cells in nine rows of three", find_pairs_in_grid},
      {"brute-force", "every body against every one before it: the oracle", find_pairs_by_brute_force},
      {"sap", "sort, sweep and prune along the axis of the largest variance", find_pairs_by_sweep},
      {"bvh", "linear hierarchy of boxes, walked by skip indices", find_pairs_by_skipping},
      {"bvh-stack", "the same, walked with a stack", find_pairs_by_stack},
      {"bvh-history", "the same, walked by history flags, two bits a level", find_pairs_by_history},
  }};
  return rows;
}

const Broadphase &broadphase_named(const std::string &name)
{
  for (const Broadphase &broadphase : broadphases())
    if (name == broadphase.name) return broadphase;
  throw std::logic_error("no broadphase '" + name + "'");
}

void find_extent(StepLaunches &step)
{
  step.run(Kernel::extent_tiles);
  step.run(Kernel::extent_whole);
  step.run(Kernel::lay_out);
}

} // namespace tandem
