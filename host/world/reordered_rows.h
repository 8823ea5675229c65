/* reordered_rows.h - the contents of buffers that follow the bodies, copied into a new order of the bodies.
 *
 * The new order holds all bodies of the old one, in the same sequence, and new ones between or behind them:
 *
 *   old   A B C D          rows    a b c d          starts   0 2 3 3 5
 *   new   A x B C D y      rows    a 0 b c d 0      starts   0 2 2 3 3 5 5
 *
 * Lists that are sorted by body stay sorted.
 */
#pragma once

#include <cstdint>
#include <vector>

#include "host/runtime/memory.h"

namespace tandem {

class ReorderedRows {
public:
  /* Both orders hold numbers of bodies. */
  ReorderedRows(const std::vector<uint32_t> &old_order, const std::vector<uint32_t> &new_order);

  /* Of a buffer with a row for each body, as words; the rows of new bodies are zero. */
  std::vector<uint32_t> rows_of(Memory &memory, Buffer buffer) const;
  /* Of a buffer of starts: one for each body, and the end. */
  std::vector<uint32_t> starts_of(Memory &memory, Buffer buffer) const;
  /* Of the first entries of a buffer of indices of bodies. */
  std::vector<uint32_t> indices_of(Memory &memory, Buffer buffer, uint32_t count) const;

private:
  uint32_t old_count_;
  std::vector<uint32_t> old_of_new_, new_of_old_; /* INDEX_NONE: a new body */
};

} // namespace tandem
