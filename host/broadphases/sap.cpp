/* sap.cpp - 1-axis sort, sweep and prune (shared/broadphase/sweep.h). */
#include <bit>

#include "host/broadphases/broadphase.h"
#include "host/primitives.h"

namespace tandem {

void find_pairs_by_sweep(StepLaunches &step)
{
  const StepPlan &plan = step.plan();
  find_extent(step);
  step.run(Kernel::sweep_keys);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_SMALL, plan.bodies, 0, 32);
  step.run(Kernel::sweep_gather);
  step.run(Kernel::sweep_count);
  step.scan_pairs(Buffer::sweep_start);
  step.run(Kernel::sweep_write);
  for (unsigned first_bit : {0u, 32u})
    sort_keys64(step.launcher(), Buffer::pair_key, Buffer::pair_key_other, Buffer::sort_histogram, Buffer::scan_sums, COUNT_PAIRS,
                plan.capacity_pairs, first_bit, first_bit + static_cast<unsigned>(std::bit_width(plan.bodies)));
  step.run(Kernel::sweep_unpack);
  step.run(Kernel::sweep_starts);
}

} // namespace tandem
