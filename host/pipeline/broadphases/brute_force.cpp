/* brute_force.cpp - tests every body against every one before it; the reference for tests of the other broadphases
 * (shared/broadphase/brute_force.h). */
#include "host/pipeline/broadphases/broadphase.h"

namespace tandem {

void find_pairs_by_brute_force(StepLaunches &step)
{
  step.run(Kernel::brute_force_count);
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::brute_force_write);
}

} // namespace tandem
