/* carried.cpp - lists, swaps and hashes the carried buffers; see carried.h. */
#include "host/world/carried.h"

#include <algorithm>
#include <array>

#include "host/scene/buffer_measures.h"

namespace tandem {

bool has_rows_of_sleepers(Buffer carried)
{
  return row_of(carried).capacity == Capacity::BODIES || has_rows_of_joints(row_of(carried));
}

size_t item_bytes(Buffer buffer) { return row_of(buffer).per_item * size_of(row_of(buffer).element); }

size_t items_in_use(Memory &memory, Buffer buffer, BodyNumbers bodies, uint32_t pairs)
{
  const BufferRow &row = row_of(buffer);
  switch (row.capacity) {
  case Capacity::BODIES: return bodies.all;
  case Capacity::BODIES_PLUS_ONE: return size_t{bodies.awake} + 1;
  case Capacity::PAIRS: return pairs;
  default: return memory.bytes(buffer) / (row.per_item * size_of(row.element));
  }
}

/* The two sides of a buffer have consecutive numbers. */
std::vector<CarriedBuffer> carried_buffers()
{
  std::vector<CarriedBuffer> rows;
  for (size_t i = 0; i < all_buffers(); ++i)
    if (is_carried(row_of(buffer_at(i)).lifetime)) {
      rows.push_back({buffer_at(i), buffer_at(i + 1)});
      ++i;
    }
  return rows;
}

void turn_carried(Memory &memory, const std::vector<CarriedBuffer> &carried) noexcept
{
  for (const CarriedBuffer &buffer : carried) memory.exchange(buffer.now, buffer.previous);
}

uint64_t hash_carried(Memory &memory, const std::vector<CarriedBuffer> &carried, BodyNumbers bodies, Features features)
{
  const uint32_t pairs = memory.read<uint32_t>(Buffer::cached_start, 1, bodies.awake).front();
  uint64_t hash = 0;
  for (const CarriedBuffer &buffer : carried) {
    const BufferRow &row = row_of(buffer.now);
    const bool needed = row.feature == 0 || (row.feature & features) != 0;
    if (needed && memory.bytes(buffer.now) > 0)
      hash = hash_buffers(memory, {buffer.now}, items_in_use(memory, buffer.now, bodies, pairs), hash);
  }
  return hash;
}

} // namespace tandem
