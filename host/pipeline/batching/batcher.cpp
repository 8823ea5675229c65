/* batcher.cpp - the table of the batchers, and the launches they share; see batcher.h. */
#include "host/pipeline/batching/batcher.h"

#include <algorithm>
#include <bit>

#include "host/pipeline/setting_rows.h"

namespace tandem {

std::span<const BatcherRow> batchers()
{
  static constexpr BatcherRow rows[] = {
      {Batching::coloring, "coloring", true, batch_by_coloring},
      {Batching::sequential, "sequential", false, batch_in_sequence},
      {Batching::single_group, "single-group", false, batch_in_single_group},
      {Batching::iterative, "iterative", false, batch_by_iteration},
      {Batching::two_stage, "two-stage", false, batch_in_two_stages},
  };
  static_assert(are_in_order(rows));
  return rows;
}

const BatcherRow &row_of(Batching batching) { return row_in(batchers(), batching); }

void launch_check(StepLaunches &step)
{
  for (Kernel kernel : {Kernel::clear_body_marks, Kernel::clear_pair_marks, Kernel::mark_batches, Kernel::check_batches,
                        Kernel::check_pairs})
    step.run(kernel);
}

uint32_t batch_cells_for(uint32_t bodies) { return std::clamp<uint32_t>(std::bit_ceil(bodies / 512 + 1), 4, 8192); }

} // namespace tandem
