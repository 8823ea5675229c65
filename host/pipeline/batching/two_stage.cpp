/* two_stage.cpp - the talks' two-stage batching: contacts are grouped by cells of space, and then batched within each
 * cell (shared/batching/cells.h). */
#include <bit>

#include "host/pipeline/batching/batcher.h"
#include "shared/batching/limits.h"

namespace tandem {

void batch_in_two_stages(StepLaunches &step)
{
  step.run(Kernel::clear_cells);
  step.run(Kernel::claim_cells);
  step.run(Kernel::cell_keys);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_PAIRS, step.plan().capacity_pairs, 0,
            std::bit_width(CELL_CLASSES * batch_cells_for(step.plan().bodies)));
  for (uint32_t parity = 0; parity < CELL_CLASSES; ++parity) step.run(Kernel::color_cells, {parity});
  batch_by_coloring(step);
}

} // namespace tandem
