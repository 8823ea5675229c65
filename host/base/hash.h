/* hash.h - a fast 64-bit fingerprint of bytes, for comparing states. It does not resist deliberate collisions. Four
 * independent lanes of multiply and rotate let it run at the speed of memory. */
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "host/base/parts.h"

namespace tandem {

inline uint64_t mix_bits(uint64_t x)
{
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

inline uint64_t hash_bytes(const void *data, size_t bytes, uint64_t seed = 0)
{
  const char *at = static_cast<const char *>(data);
  uint64_t lanes[4] = {seed + 1, seed + 2, seed + 3, seed + 4};
  const auto word = [&](size_t offset, size_t size) {
    uint64_t w = 0;
    std::memcpy(&w, at + offset, size);
    return w;
  };
  const auto take = [&](uint64_t &lane, uint64_t w) { lane = std::rotl((lane ^ w) * 0x9e3779b97f4a7c15u, 29); };
  size_t offset = 0;
  for (; offset + 32 <= bytes; offset += 32) { /* a loop over the lanes keeps them in memory, at half of the speed */
    take(lanes[0], word(offset, 8));
    take(lanes[1], word(offset + 8, 8));
    take(lanes[2], word(offset + 16, 8));
    take(lanes[3], word(offset + 24, 8));
  }
  for (; offset < bytes; offset += 8) take(lanes[0], word(offset, std::min<size_t>(8, bytes - offset)));
  uint64_t result = mix_bits(bytes + seed);
  for (uint64_t lane : lanes) result = mix_bits(result ^ lane);
  return result;
}

/* The hash of the hashes of blocks, which threads can share: of files, where one thread would take longest for it. */
inline uint64_t hash_blocks(const void *data, size_t bytes, uint64_t seed, RunParts run_parts)
{
  constexpr size_t block_bytes = size_t{1} << 20;
  std::vector<uint64_t> hashes((bytes + block_bytes - 1) / block_bytes);
  run_parts(hashes.size(), PartFunction([&](size_t block) {
              const size_t begin = block * block_bytes;
              hashes[block] =
                  hash_bytes(static_cast<const char *>(data) + begin, std::min(block_bytes, bytes - begin), seed);
            }));
  return hash_bytes(hashes.data(), hashes.size() * sizeof(uint64_t), seed + bytes);
}

} // namespace tandem
