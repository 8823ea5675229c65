/* primitives.cpp - levels of scans and passes of sorts; see primitives.h. */
#include "host/primitives.h"

#include <utility>
#include <vector>

#include "shared/platform.h"
#include "shared/parallel/radix_sort.h"

namespace tandem {
namespace {

constexpr size_t tiles_of(size_t n) { return (n + TILE - 1) / TILE; }

/* Where the sums of each level start; the last level has one tile. */
std::vector<uint32_t> level_offsets(size_t capacity)
{
  std::vector<uint32_t> offsets;
  size_t offset = 0;
  for (size_t n = tiles_of(capacity);; n = tiles_of(n)) {
    offsets.push_back(static_cast<uint32_t>(offset));
    offset += n + 1;
    if (n <= 1) return offsets;
  }
}

} // namespace

size_t scan_sum_words(size_t capacity) { return level_offsets(capacity).back() + 2; }

void exclusive_scan(Launcher &launcher, Buffer in, Buffer out, Buffer sums, uint32_t length, uint32_t capacity)
{
  const std::vector<uint32_t> offsets = level_offsets(capacity);
  const auto levels = static_cast<uint32_t>(offsets.size());
  const auto expected = [&](uint32_t level) {
    size_t n = capacity;
    for (uint32_t k = 0; k < level; ++k) n = tiles_of(n);
    return static_cast<uint32_t>(n);
  };
  for (uint32_t level = 0; level < levels; ++level) {
    const Buffer from = level == 0 ? in : sums, to = level == 0 ? out : sums;
    const uint32_t start = level == 0 ? 0 : offsets[level - 1];
    launcher.launch({Kernel::scan_tiles, {from, to, sums}, {length, level, start, offsets[level]}, COUNT_ZERO, length, expected(level)});
  }
  for (uint32_t level = levels - 1; level-- > 0;) {
    const uint32_t start = level == 0 ? 0 : offsets[level - 1];
    launcher.launch({Kernel::scan_add, {level == 0 ? out : sums, sums}, {length, level, start, offsets[level]}, COUNT_ZERO, length, expected(level)});
  }
  launcher.launch({Kernel::scan_total, {out, sums}, {length, offsets.back()}, COUNT_ZERO, COUNT_ONE, 1});
}

size_t histogram_words(size_t capacity) { return tiles_of(capacity) * SORT_DIGITS + 1; }

namespace {

uint32_t begin_sort(Launcher &launcher, uint32_t length, uint32_t capacity)
{
  launcher.launch({Kernel::sort_length, {}, {length}, COUNT_ZERO, COUNT_ONE, 1});
  return static_cast<uint32_t>(tiles_of(capacity) * SORT_DIGITS);
}

} // namespace

void sort_pairs(Launcher &launcher, Buffer keys, Buffer values, Buffer other_keys, Buffer other_values, Buffer histogram, Buffer sums,
                uint32_t length, uint32_t capacity, unsigned first_bit, unsigned last_bit)
{
  const uint32_t histogram_capacity = begin_sort(launcher, length, capacity);
  bool swapped = false;
  for (unsigned shift = first_bit; shift < last_bit; shift += SORT_BITS, swapped = !swapped) {
    launcher.launch({Kernel::sort_histogram, {keys, histogram}, {length, shift}, COUNT_ZERO, length, capacity});
    exclusive_scan(launcher, histogram, histogram, sums, COUNT_HISTOGRAM, histogram_capacity);
    launcher.launch({Kernel::sort_scatter, {keys, values, histogram, other_keys, other_values}, {length, shift}, COUNT_ZERO, length, capacity});
    std::swap(keys, other_keys);
    std::swap(values, other_values);
  }
  if (!swapped) return;
  launcher.launch({Kernel::copy, {keys, other_keys}, {}, COUNT_ZERO, length, capacity});
  launcher.launch({Kernel::copy, {values, other_values}, {}, COUNT_ZERO, length, capacity});
}

void sort_keys64(Launcher &launcher, Buffer keys, Buffer other_keys, Buffer histogram, Buffer sums, uint32_t length, uint32_t capacity,
                 unsigned first_bit, unsigned last_bit)
{
  const uint32_t histogram_capacity = begin_sort(launcher, length, capacity);
  bool swapped = false;
  for (unsigned shift = first_bit; shift < last_bit; shift += SORT_BITS, swapped = !swapped) {
    launcher.launch({Kernel::sort_histogram64, {keys, histogram}, {length, shift}, COUNT_ZERO, length, capacity});
    exclusive_scan(launcher, histogram, histogram, sums, COUNT_HISTOGRAM, histogram_capacity);
    launcher.launch({Kernel::sort_scatter64, {keys, histogram, other_keys}, {length, shift}, COUNT_ZERO, length, capacity});
    std::swap(keys, other_keys);
  }
  if (swapped) launcher.launch({Kernel::copy64, {keys, other_keys}, {}, COUNT_ZERO, length, capacity});
}

} // namespace tandem
