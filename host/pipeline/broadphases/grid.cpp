/* grid.cpp - small bodies sorted by grid cell, large ones tested against all others (shared/broadphase/grid.h,
 * grid_symmetric.h). */
#include <bit>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/primitives.h"

namespace tandem {
namespace {

void search_cells(StepLaunches &step)
{
  step.run(Kernel::grid_count);
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::grid_write);
}

} // namespace

void sort_into_cells(StepLaunches &step, bool bitonic)
{
  const StepPlan &plan = step.plan();
  find_extent(step);
  step.run(Kernel::grid_keys);
  if (bitonic) bitonic_sort(step.launcher(), Buffer::sort_key, Buffer::sort_value, COUNT_SMALL, plan.bodies);
  else
    step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_SMALL, plan.bodies, 0, std::bit_width(plan.capacity_cells));
  step.run_at_most(Kernel::grid_cells, plan.capacity_cells + 1, {COUNT_SMALL});
}

void find_pairs_in_grid(StepLaunches &step)
{
  sort_into_cells(step);
  search_cells(step);
}

void find_pairs_in_bitonic_grid(StepLaunches &step)
{
  sort_into_cells(step, true);
  search_cells(step);
}

void find_pairs_in_half_the_cells(StepLaunches &step)
{
  sort_into_cells(step);
  step.run(Kernel::symmetric_count);
  step.scan_pairs(Buffer::key_start);
  step.run(Kernel::symmetric_write);
  pairs_from_keys(step);
}

} // namespace tandem
