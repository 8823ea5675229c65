/* iterative.cpp - the talks' iterative batching, which fills batch after batch in a few rounds each
 * (shared/batching/iterative.h). */
#include <algorithm>

#include "host/pipeline/batching/batcher.h"
#include "shared/batching/limits.h"

namespace tandem {

void batch_by_iteration(StepLaunches &step)
{
  const uint32_t batches = std::min((step.plan().rounds + BATCH_ROUNDS - 1) / BATCH_ROUNDS, COLOR_LIMIT);
  for (uint32_t round = 0; round < batches * BATCH_ROUNDS; ++round) {
    step.run(Kernel::batch_bid, {round / BATCH_ROUNDS, round});
    step.run(Kernel::batch_reserve, {round / BATCH_ROUNDS, round});
  }
  if (batches == COLOR_LIMIT) step.run(Kernel::batch_rest);
}

} // namespace tandem
