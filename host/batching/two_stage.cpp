/* two_stage.cpp - the talks' two-stage batching: cells of space, then the contacts of each (shared/batching/cells.h). */
#include "host/batching/batcher.h"

#include <bit>

#include "host/primitives.h"
#include "shared/batching/limits.h"

namespace tandem {

void batch_in_two_stages(Launcher &launcher, const StepPlan &plan)
{
  launch_kernel(launcher, plan, Kernel::clear_cells);
  launch_kernel(launcher, plan, Kernel::claim_cells);
  launch_kernel(launcher, plan, Kernel::cell_keys);
  sort_pairs(launcher, Buffer::sort_key, Buffer::sort_value, Buffer::sort_key_other, Buffer::sort_value_other, Buffer::sort_histogram,
             Buffer::scan_sums, COUNT_PAIRS, plan.capacity_pairs, 0, std::bit_width(CELL_CLASSES * batch_cells_for(plan.bodies)));
  for (uint32_t parity = 0; parity < CELL_CLASSES; ++parity) launch_kernel(launcher, plan, Kernel::color_cells, {parity});
  batch_by_coloring(launcher, plan);
}

} // namespace tandem
