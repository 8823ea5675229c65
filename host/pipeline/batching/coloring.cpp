/* coloring.cpp - the default batcher: deterministic parallel graph colouring, with colours kept from step to step
 * (shared/batching/coloring.h). */
#include "host/pipeline/batching/batcher.h"

namespace tandem {

void batch_by_coloring(StepLaunches &step)
{
  for (uint32_t round = 0; round < step.plan().rounds; ++round) {
    step.run(Kernel::color_bid, {round});
    step.run(Kernel::color_assign, {round});
  }
}

} // namespace tandem
