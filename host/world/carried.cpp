/* carried.cpp - lists, swaps and hashes the carried buffers; see carried.h. */
#include "host/world/carried.h"

#include <algorithm>
#include <array>
#include <utility>

#include "host/base/hash.h"
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

std::vector<float4> impulse_rows(const std::vector<float> &single, std::vector<float4> rows)
{
  const bool has_rows = !rows.empty();
  rows.resize(single.size());
  for (size_t i = 0; i < single.size(); ++i)
    if (!has_rows || single[i] > 0) rows[i].x = single[i];
  return rows;
}

namespace {

uint64_t hash_impulses(Memory &memory, uint32_t pairs, uint64_t hash)
{
  const bool has_rows = memory.bytes(Buffer::cached_normal_impulse) > 0;
  auto rows = has_rows ? memory.read<float4>(Buffer::cached_normal_impulse, pairs) : std::vector<float4>();
  rows = impulse_rows(memory.read<float>(Buffer::cached_single_impulse, pairs), std::move(rows));
  return hash_bytes(rows.data(), rows.size() * sizeof(float4), hash);
}

/* Pairs of single points have no features, and count as if they had rows of zeros. */
uint64_t hash_no_features(uint32_t pairs, uint64_t hash)
{
  const std::vector<uint32_t> zeros(pairs);
  return hash_bytes(zeros.data(), zeros.size() * sizeof(uint32_t), hash);
}

} // namespace

/* The layout of the impulses changes no hash. */
uint64_t hash_carried(Memory &memory, const std::vector<CarriedBuffer> &carried, BodyNumbers bodies, Features features)
{
  const uint32_t pairs = memory.read<uint32_t>(Buffer::cached_start, 1, bodies.awake).front();
  uint64_t hash = 0;
  for (const CarriedBuffer &buffer : carried) {
    const BufferRow &row = row_of(buffer.now);
    const bool needed = row.feature == 0 || (row.feature & features) != 0;
    if (buffer.now == Buffer::cached_normal_impulse) continue;
    if (buffer.now == Buffer::cached_single_impulse && memory.bytes(buffer.now) > 0)
      hash = hash_impulses(memory, pairs, hash);
    else if (buffer.now == Buffer::cached_feature && !needed && memory.bytes(Buffer::cached_single_impulse) > 0)
      hash = hash_no_features(pairs, hash);
    else if (needed && memory.bytes(buffer.now) > 0)
      hash = hash_buffers(memory, {buffer.now}, items_in_use(memory, buffer.now, bodies, pairs), hash);
  }
  return hash;
}

} // namespace tandem
