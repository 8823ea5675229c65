/* sap.cpp - sort, sweep and prune along one axis, in the variant with which the talk starts
 * (shared/broadphase/sweep_and_prune.h) and in the one with which it ends (sweep_window.h). */
#include "host/pipeline/broadphases/broadphase.h"

namespace tandem {
namespace {

void sort_along_axis(StepLaunches &step, uint32_t principal)
{
  find_extent(step);
  if (principal) step.run(Kernel::find_principal_direction);
  step.run(Kernel::sweep_keys, {principal});
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_SMALL, step.plan().bodies, 0, 32);
  step.run(Kernel::sweep_gather);
}

void sweep_in_windows(StepLaunches &step, uint32_t principal)
{
  sort_along_axis(step, principal);
  step.run(Kernel::sweep_ends, {principal});
  step.run(Kernel::sweep_blocks);
  step.run(Kernel::window_count);
  step.scan_pairs(Buffer::share_start, COUNT_SHARES);
  step.run(Kernel::window_write);
  pairs_from_keys(step);
}

} // namespace

void find_pairs_by_plain_sweep_and_prune(StepLaunches &step)
{
  sort_along_axis(step, 0);
  step.run(Kernel::sweep_count);
  step.scan_pairs(Buffer::key_start);
  step.run(Kernel::sweep_write);
  pairs_from_keys(step);
}

void find_pairs_by_sweep_and_prune(StepLaunches &step) { sweep_in_windows(step, 0); }
void find_pairs_by_principal_sweep_and_prune(StepLaunches &step) { sweep_in_windows(step, 1); }

} // namespace tandem
