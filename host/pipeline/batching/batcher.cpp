/* batcher.cpp - the rows of the batchers, and what they share; see batcher.h. */
#include "host/pipeline/batching/batcher.h"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>

namespace tandem {

std::span<const Batcher> batchers()
{
  static constexpr std::array<Batcher, 5> rows{{
      {"coloring", true, batch_by_coloring},
      {"sequential", false, batch_in_sequence},
      {"single-group", false, batch_in_single_group},
      {"iterative", false, batch_by_iteration},
      {"two-stage", false, batch_in_two_stages},
  }};
  return rows;
}

const Batcher &batcher_named(const std::string &name)
{
  for (const Batcher &batcher : batchers())
    if (name == batcher.name) return batcher;
  throw std::logic_error("no batcher '" + name + "'");
}

void launch_check(StepLaunches &step)
{
  for (Kernel kernel : {Kernel::clear_body_marks, Kernel::clear_pair_marks, Kernel::mark_batches, Kernel::check_batches,
                        Kernel::check_pairs})
    step.run(kernel);
}

uint32_t batch_cells_for(uint32_t bodies) { return std::clamp<uint32_t>(std::bit_ceil(bodies / 512 + 1), 4, 8192); }

} // namespace tandem
