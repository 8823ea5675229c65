/* primitives.cpp - launches of scans, sorts and reductions; see primitives.h. */
#include "host/pipeline/primitives.h"

#include <algorithm>
#include <utility>

#include "shared/parallel/bitonic_sort.h"
#include "shared/parallel/radix_sort.h"
#include "shared/parallel/reduce.h"
#include "shared/parallel/scan.h"

namespace tandem {
namespace {

constexpr uint32_t units(uint64_t n, uint32_t unit) { return static_cast<uint32_t>((n + unit - 1) / unit); }

/* Launches count groups of TILE items; so many items make `groups` groups. */
constexpr uint32_t items_for(uint64_t groups)
{
  return static_cast<uint32_t>(std::min<uint64_t>(groups * TILE, UINT32_MAX));
}

/* per_unit * ceil(counts[length] / unit) words (shared/parallel/length.h), at most `capacity`. */
struct Extent {
  uint32_t length, unit, per_unit, capacity;
};

/* The launches use the range of the length. It has at least as many groups as there are tiles of words, because a tile
 * of the sort covers more items than a group and makes fewer words of histogram than it has keys. */
static_assert(SCAN_TILE >= TILE && SORT_TILE >= TILE && SORT_DIGITS <= SORT_TILE && SORT_DIGITS <= SCAN_TILE);

void scan_words(Launcher &launcher, Buffer in, Buffer out, Buffer sums, const Extent &extent)
{
  const uint32_t length = extent.length, unit = extent.unit,
                 per_unit = extent.per_unit; /* a lambda may not capture parts of a whole */
  const uint32_t tiles = units(extent.capacity, SCAN_TILE);
  const auto in_order = [&](Buffer from, Buffer to, uint32_t block) {
    launcher.launch(
        {Kernel::scan_in_order, {from, to, out}, {length, unit, per_unit, block}, COUNT_ZERO, COUNT_ONE, 1});
  };
  if (tiles <= 1) return in_order(in, out, 1);
  launcher.launch({Kernel::scan_reduce, {in, sums}, {length, unit, per_unit}, COUNT_ZERO, length, items_for(tiles)});
  in_order(sums, sums, SCAN_TILE);
  launcher.launch(
      {Kernel::scan_tiles, {in, sums, out}, {length, unit, per_unit}, COUNT_ZERO, length, items_for(tiles)});
}

/* The buffers and kernels of one kind of sort: with or without values, 32- or 64-bit keys. */
struct Sort {
  Kernel histogram_kernel, scatter_kernel, copy_kernel;
  Buffer keys, other_keys;
  bool has_values;
  Buffer values, other_values;
  Buffer histogram, sums;
};

void sort_pass(Launcher &launcher, const Sort &sort, uint32_t length, uint32_t capacity, unsigned shift, unsigned bits)
{
  const uint32_t tiles = units(capacity, SORT_TILE), digits = 1u << bits;
  launcher.launch({sort.histogram_kernel,
                   {sort.keys, sort.histogram},
                   {length, shift, bits},
                   COUNT_ZERO,
                   length,
                   items_for(tiles)});
  scan_words(launcher, sort.histogram, sort.histogram, sort.sums, {length, SORT_TILE, digits, tiles * digits});
  Launch scatter{
      sort.scatter_kernel, {sort.keys, sort.histogram, sort.other_keys}, {length, shift, bits}, COUNT_ZERO, length,
      items_for(tiles)};
  if (sort.has_values) scatter.slots = {sort.keys, sort.values, sort.histogram, sort.other_keys, sort.other_values};
  launcher.launch(scatter);
}

/* Sorts in as few passes as SORT_BITS allows, of about equal widths, and copies the result back after an odd number of
 * passes. */
void sort_bits(Launcher &launcher, Sort sort, uint32_t length, uint32_t capacity, unsigned first_bit, unsigned last_bit)
{
  if (last_bit <= first_bit || capacity == 0) return;
  const unsigned passes = units(last_bit - first_bit, SORT_BITS);
  for (unsigned pass = 0, shift = first_bit; pass < passes; ++pass) {
    const unsigned bits = units(last_bit - shift, passes - pass);
    sort_pass(launcher, sort, length, capacity, shift, bits);
    shift += bits;
    std::swap(sort.keys, sort.other_keys);
    std::swap(sort.values, sort.other_values);
  }
  if (passes % 2 == 0) return;
  launcher.launch({sort.copy_kernel, {sort.keys, sort.other_keys}, {}, COUNT_ZERO, length, capacity});
  if (sort.has_values)
    launcher.launch({Kernel::copy, {sort.values, sort.other_values}, {}, COUNT_ZERO, length, capacity});
}

} // namespace

size_t scan_sum_words(size_t capacity) { return units(capacity, SCAN_TILE) + 1; }

void exclusive_scan(Launcher &launcher, Buffer in, Buffer out, Buffer sums, uint32_t length, uint32_t capacity)
{
  scan_words(launcher, in, out, sums, {length, 1, 1, capacity});
}

void scan_table(Launcher &launcher, Buffer table, Buffer sums, uint32_t length, uint32_t unit, uint32_t per_unit,
                uint32_t capacity)
{
  scan_words(launcher, table, table, sums, {length, unit, per_unit, units(capacity, unit) * per_unit});
}

size_t histogram_words(size_t capacity) { return size_t{units(capacity, SORT_TILE)} * SORT_DIGITS + 1; }

void sort_keys(Launcher &launcher, Buffer keys, Buffer other_keys, Buffer histogram, Buffer sums, uint32_t length,
               uint32_t capacity, unsigned first_bit, unsigned last_bit)
{
  sort_bits(
      launcher,
      {Kernel::sort_histogram, Kernel::sort_scatter, Kernel::copy, keys, other_keys, false, {}, {}, histogram, sums},
      length, capacity, first_bit, last_bit);
}

void sort_pairs(Launcher &launcher, Buffer keys, Buffer values, Buffer other_keys, Buffer other_values,
                Buffer histogram, Buffer sums, uint32_t length, uint32_t capacity, unsigned first_bit,
                unsigned last_bit)
{
  sort_bits(launcher,
            {Kernel::sort_histogram, Kernel::sort_scatter_pairs, Kernel::copy, keys, other_keys, true, values,
             other_values, histogram, sums},
            length, capacity, first_bit, last_bit);
}

void sort_keys64(Launcher &launcher, Buffer keys, Buffer other_keys, Buffer histogram, Buffer sums, uint32_t length,
                 uint32_t capacity, unsigned first_bit, unsigned last_bit)
{
  sort_bits(launcher,
            {Kernel::sort_histogram64,
             Kernel::sort_scatter64,
             Kernel::copy64,
             keys,
             other_keys,
             false,
             {},
             {},
             histogram,
             sums},
            length, capacity, first_bit, last_bit);
}

void sort_pairs64(Launcher &launcher, Buffer keys, Buffer values, Buffer other_keys, Buffer other_values,
                  Buffer histogram, Buffer sums, uint32_t length, uint32_t capacity, unsigned first_bit,
                  unsigned last_bit)
{
  sort_bits(launcher,
            {Kernel::sort_histogram64, Kernel::sort_scatter64_pairs, Kernel::copy64, keys, other_keys, true, values,
             other_values, histogram, sums},
            length, capacity, first_bit, last_bit);
}

void bitonic_sort(Launcher &launcher, Buffer keys, Buffer values, uint32_t length, uint32_t capacity)
{
  if (capacity == 0) return;
  const auto tile = [&](uint32_t whole) {
    launcher.launch({Kernel::bitonic_tile, {keys, values}, {length, whole}, COUNT_ZERO, length, capacity});
  };
  const auto step = [&](uint32_t block, uint32_t reach) {
    launcher.launch({Kernel::bitonic_step, {keys, values}, {length, block, reach}, COUNT_ZERO, length, capacity});
  };
  tile(1);
  for (uint32_t block = 2 * BITONIC_TILE; block / 2 < capacity; block *= 2) {
    step(block, 0);
    for (uint32_t reach = block / 4; reach >= BITONIC_TILE; reach /= 2) step(0, reach);
    tile(0);
  }
}

namespace {

static_assert(REDUCE_SUM == static_cast<int>(Reduction::sum) &&
              REDUCE_SMALLEST == static_cast<int>(Reduction::smallest) &&
              REDUCE_LARGEST == static_cast<int>(Reduction::largest));

void reduce_with(Launcher &launcher, Kernel tiles, Kernel partials, Reduction reduction, Buffer values, Buffer partial,
                 Buffer result, uint32_t length, uint32_t capacity)
{
  const auto operation = static_cast<uint32_t>(reduction);
  launcher.launch(
      {tiles, {values, partial}, {length, operation}, COUNT_ZERO, length, items_for(units(capacity, REDUCE_TILE))});
  launcher.launch({partials, {partial, result}, {length, operation}, COUNT_ZERO, COUNT_ONE, 1});
}

} // namespace

size_t reduce_partial_words(size_t capacity) { return std::max(units(capacity, REDUCE_TILE), 1u); }

void reduce(Launcher &launcher, Reduction reduction, Buffer values, Buffer partial, Buffer result, uint32_t length,
            uint32_t capacity)
{
  reduce_with(launcher, Kernel::reduce_tiles, Kernel::reduce_partials, reduction, values, partial, result, length,
              capacity);
}

void reduce_real(Launcher &launcher, Reduction reduction, Buffer values, Buffer partial, Buffer result, uint32_t length,
                 uint32_t capacity)
{
  reduce_with(launcher, Kernel::reduce_real_tiles, Kernel::reduce_real_partials, reduction, values, partial, result,
              length, capacity);
}

void compact(Launcher &launcher, Buffer flags, Buffer offsets, Buffer sums, Buffer indices, uint32_t length,
             uint32_t capacity, uint32_t found)
{
  launcher.launch({Kernel::compact_count, {flags, offsets}, {}, COUNT_ZERO, length, capacity});
  exclusive_scan(launcher, offsets, offsets, sums, length, capacity);
  launcher.launch({Kernel::compact_write, {flags, offsets, indices}, {}, COUNT_ZERO, length, capacity});
  launcher.launch({Kernel::compact_total, {offsets}, {length, found}, COUNT_ZERO, COUNT_ONE, 1});
}

} // namespace tandem
