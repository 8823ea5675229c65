/* hybrid.cpp - small bodies in a grid, large ones in a hierarchy (shared/broadphase/hybrid.h). */
#include <bit>

#include "host/pipeline/broadphases/broadphase.h"
#include "shared/broadphase/curve_limits.h"

namespace tandem {

void find_pairs_in_hybrid(StepLaunches &step)
{
  const uint32_t bodies = step.plan().bodies;
  find_extent(step, true);
  step.run(Kernel::large_keys);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_BOUNDED, bodies, 0, CURVE_BITS + 1);
  step.run_range(Kernel::copy, COUNT_ZERO, COUNT_BOUNDED, {}, {Buffer::sort_value, Buffer::leaf_body});
  step.run(Kernel::plan_large);
  step.run_at_most(Kernel::link_nodes, bodies);
  raise_boxes(step, Buffer::bounds);
  step.run(Kernel::large_count);
  step.run(Kernel::small_keys);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_BOUNDED, bodies, 0, std::bit_width(step.plan().capacity_cells));
  step.run_at_most(Kernel::grid_cells, step.plan().capacity_cells + 1, {COUNT_BOUNDED});
  step.run(Kernel::small_count);
  step.run(Kernel::join_neighbors);
  step.scan_pairs(Buffer::share_start, COUNT_HALVES);
  step.run(Kernel::large_write);
  step.run(Kernel::small_write);
  pairs_from_keys(step);
}

} // namespace tandem
