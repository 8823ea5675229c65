/* carried.cpp - see carried.h. */
#include "host/world/carried.h"

#include <algorithm>
#include <array>

#include "host/scene/body_buffers.h"

namespace tandem {
namespace {

constexpr size_t carried_count = 0
#define BUFFER(name, element, capacity, per_item, feature, fields)
#define CARRIED(name, element, capacity, per_item, feature, fields) +1
#include "shared/buffers.def"
    ;

constexpr std::array<CarriedBuffer, carried_count> rows = {{
#define CARRIED(name, element, capacity, per_item, feature, fields) {Buffer::name, Buffer::previous_##name},
#include "shared/buffers.def"
#undef BUFFER
}};

/* How many items of it the last step left; what lies behind them is of older ones. */
size_t items_of(Capacity capacity, uint32_t bodies, uint32_t pairs)
{
  return capacity == Capacity::BODIES ? bodies : capacity == Capacity::BODIES_PLUS_ONE ? size_t{bodies} + 1 : pairs;
}

} // namespace

std::span<const CarriedBuffer> carried_buffers() { return rows; }

bool is_carried(Buffer buffer)
{
  return std::any_of(rows.begin(), rows.end(), [&](const CarriedBuffer &carried) { return carried.now == buffer; });
}

void turn_carried(Memory &memory) noexcept
{
  for (const CarriedBuffer &carried : rows) memory.exchange(carried.now, carried.previous);
}

uint64_t hash_carried(Memory &memory, uint32_t bodies, uint32_t features)
{
  const uint32_t pairs = memory.read<uint32_t>(Buffer::cached_start, 1, bodies).front();
  uint64_t hash = 0;
  for (const CarriedBuffer &carried : rows) {
    const BufferRow &row = row_of(carried.now);
    const bool needed = row.feature == 0 || (row.feature & features) != 0;
    if (needed && memory.bytes(carried.now) > 0)
      hash = hash_buffers(memory, {carried.now}, items_of(row.capacity, bodies, pairs), hash);
  }
  return hash;
}

} // namespace tandem
