/* batch_fault.h - turns the counts of check_batches into a fault with the indices of bodies, if there is one. */
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <tandem/world.h>

#include "host/runtime/memory.h"

namespace tandem {

/* `order`: the scene's body of each index of the body buffers. */
std::optional<BatchFault> find_batch_fault(Memory &memory, const std::array<uint32_t, COUNT_TOTAL> &counts,
                                           const std::vector<uint32_t> &order, uint64_t step);

} // namespace tandem
