/* words.h - sets a buffer to what a test made by hand, for the tests of lists that are gathered by key. */
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "host/runtime/memory.h"

namespace tandem {

inline void set_words(Memory &memory, Buffer buffer, const std::vector<uint32_t> &values)
{
  memory.resize(buffer, std::max<size_t>(values.size(), 1) * sizeof(uint32_t));
  memory.upload(buffer, values.data(), values.size() * sizeof(uint32_t));
}

} // namespace tandem
