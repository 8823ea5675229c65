/* reordered_rows.cpp - see reordered_rows.h. */
#include "host/world/reordered_rows.h"

#include <algorithm>

#include "shared/counts.h"

namespace tandem {

ReorderedRows::ReorderedRows(const std::vector<uint32_t> &old_order, const std::vector<uint32_t> &new_order)
    : old_count_(static_cast<uint32_t>(old_order.size())), old_of_new_(new_order.size(), INDEX_NONE),
      new_of_old_(old_order.size())
{
  uint32_t old = 0;
  for (uint32_t i = 0; i < new_order.size(); ++i) {
    if (old == old_count_ || new_order[i] != old_order[old]) continue;
    old_of_new_[i] = old;
    new_of_old_[old++] = i;
  }
}

std::vector<uint32_t> ReorderedRows::rows_of(Memory &memory, Buffer buffer) const
{
  const BufferRow &row = row_of(buffer);
  const size_t words = row.per_item * size_of(row.element) / sizeof(uint32_t);
  const auto old = memory.read<uint32_t>(buffer, old_count_ * words);
  std::vector<uint32_t> rows(old_of_new_.size() * words);
  for (size_t i = 0; i < old_of_new_.size(); ++i)
    if (old_of_new_[i] != INDEX_NONE) std::copy_n(&old[old_of_new_[i] * words], words, &rows[i * words]);
  return rows;
}

/* The list of a new body is empty: it starts where that of the next old one does. */
std::vector<uint32_t> ReorderedRows::starts_of(Memory &memory, Buffer buffer) const
{
  const auto old = memory.read<uint32_t>(buffer, size_t{old_count_} + 1);
  std::vector<uint32_t> starts(old_of_new_.size() + 1);
  uint32_t start = starts.back() = old.back();
  for (size_t i = old_of_new_.size(); i-- > 0;) {
    if (old_of_new_[i] != INDEX_NONE) start = old[old_of_new_[i]];
    starts[i] = start;
  }
  return starts;
}

std::vector<uint32_t> ReorderedRows::indices_of(Memory &memory, Buffer buffer, uint32_t count) const
{
  auto values = memory.read<uint32_t>(buffer, count);
  for (uint32_t &value : values)
    if (value != INDEX_NONE) value = new_of_old_[value]; /* a pair of a world that was reset has no partner */
  return values;
}

} // namespace tandem
