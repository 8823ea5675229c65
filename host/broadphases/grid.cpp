/* grid.cpp - small bodies sorted by cell, large ones against all (shared/broadphase/grid.h). */
#include <bit>

#include "host/broadphases/broadphase.h"

namespace tandem {

void find_pairs_in_grid(StepLaunches &step)
{
  find_extent(step);
  step.run(Kernel::grid_keys);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_SMALL, step.plan().bodies, 0, std::bit_width(step.plan().capacity_cells));
  step.run(Kernel::grid_cells);
  step.run(Kernel::grid_count);
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::grid_write);
}

} // namespace tandem
