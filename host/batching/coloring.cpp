/* coloring.cpp - deterministic parallel graph colouring, kept from step to step (shared/batching/coloring.h). */
#include "host/batching/batcher.h"

namespace tandem {

void batch_by_coloring(Launcher &launcher, const StepPlan &plan)
{
  for (uint32_t round = 0; round < plan.rounds; ++round) {
    launch_kernel(launcher, plan, Kernel::color_bid, {round});
    launch_kernel(launcher, plan, Kernel::color_assign, {round});
  }
}

} // namespace tandem
