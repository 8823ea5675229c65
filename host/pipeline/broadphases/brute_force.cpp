/* brute_force.cpp - every body against every one before it (shared/broadphase/brute_force.h). */
#include "host/pipeline/broadphases/broadphase.h"

namespace tandem {

void find_pairs_by_brute_force(StepLaunches &step)
{
  step.run(Kernel::brute_force_count);
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::brute_force_write);
}

} // namespace tandem
