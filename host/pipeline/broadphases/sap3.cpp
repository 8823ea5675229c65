/* sap3.cpp - the incremental sweep and prune along three axes (shared/broadphase/sap3.h). */
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/primitives.h"

namespace tandem {
namespace {

void sort_ends(StepLaunches &step)
{
  for (uint32_t axis = 0; axis < 3; ++axis) {
    step.run(Kernel::axis_keys, {axis});
    step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_HALVES, 2 * step.plan().bodies, 0, 32);
    step.run(Kernel::axis_places, {axis});
  }
}

void find_changed_pairs(StepLaunches &step)
{
  step.run(Kernel::count_changes);
  exclusive_scan(step.launcher(), Buffer::share_start, Buffer::share_start, Buffer::scan_sums, COUNT_HALVES,
                 2 * step.plan().bodies);
  step.run(Kernel::total_changes);
  step.run(Kernel::write_changes);
  sort_pair_keys(step, Buffer::pair_key, Buffer::pair_key_other, COUNT_CHANGES, step.plan().capacity_pairs);
}

void merge_with_kept_pairs(StepLaunches &step)
{
  step.run(Kernel::merge_count);
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::merge_write);
}

/* This does not belong to the commit: what is kept describes the bounds of this launch, whether the step runs again or
 * not. */
void keep_for_next_launch(StepLaunches &step)
{
  step.run(Kernel::keep_ends);
  step.run_range(Kernel::copy, COUNT_ZERO, COUNT_BODIES_PLUS_ONE, {}, {Buffer::pair_start, Buffer::kept_start});
  step.run_range(Kernel::copy, COUNT_ZERO, COUNT_PAIRS, {}, {Buffer::pair_b, Buffer::kept_b});
  step.run(Kernel::keep_or_forget);
}

} // namespace

void find_pairs_incrementally(StepLaunches &step)
{
  sort_ends(step);
  find_changed_pairs(step);
  merge_with_kept_pairs(step);
  keep_for_next_launch(step);
}

} // namespace tandem
