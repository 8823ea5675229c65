/* carried.cpp - see carried.h. */
#include "host/world/carried.h"

#include <algorithm>
#include <array>

#include "host/scene/body_buffers.h"

namespace tandem {
namespace {

/* The sides of a buffer stand next to each other. */
std::vector<CarriedBuffer> rows_of_list()
{
  std::vector<CarriedBuffer> rows;
  for (size_t i = 0; i < buffer_count; ++i)
    if (is_carried(row_of(buffer_at(i)).lifetime)) {
      rows.push_back({buffer_at(i), buffer_at(i + 1)});
      ++i;
    }
  return rows;
}

/* How many items of it the last step left; what lies behind them is of older ones. */
size_t items_of(Capacity capacity, uint32_t bodies, uint32_t pairs)
{
  return capacity == Capacity::BODIES ? bodies : capacity == Capacity::BODIES_PLUS_ONE ? size_t{bodies} + 1 : pairs;
}

} // namespace

const std::vector<CarriedBuffer> &carried_buffers()
{
  static const std::vector<CarriedBuffer> rows = rows_of_list();
  return rows;
}

void turn_carried(Memory &memory) noexcept
{
  for (const CarriedBuffer &carried : carried_buffers()) memory.exchange(carried.now, carried.previous);
}

uint64_t hash_carried(Memory &memory, uint32_t bodies, Features features)
{
  const uint32_t pairs = memory.read<uint32_t>(Buffer::cached_start, 1, bodies).front();
  uint64_t hash = 0;
  for (const CarriedBuffer &carried : carried_buffers()) {
    const BufferRow &row = row_of(carried.now);
    const bool needed = row.feature == 0 || (row.feature & features) != 0;
    if (needed && memory.bytes(carried.now) > 0)
      hash = hash_buffers(memory, {carried.now}, items_of(row.capacity, bodies, pairs), hash);
  }
  return hash;
}

} // namespace tandem
