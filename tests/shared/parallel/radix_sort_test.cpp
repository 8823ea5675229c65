/* Radix sort against std::stable_sort: keys of 32 and 64 bits, with and without values, any range of bits. */
#include <algorithm>

#include "host/runtime/make_backend.h"
#include "tests/shared/parallel/primitives.h"

using namespace tandem;

namespace {

struct Bits {
  unsigned first, last;
};

template <class T> T masked(T key, Bits bits)
{
  const unsigned width = bits.last - bits.first;
  const T mask = width >= 8 * sizeof(T) ? ~T{0} : static_cast<T>((T{1} << width) - 1);
  return static_cast<T>(key >> bits.first) & mask;
}

/* The index in the input of each item of a stable sort. */
template <class T> std::vector<uint32_t> expected_order(const std::vector<T> &keys, Bits bits)
{
  std::vector<uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return masked(keys[a], bits) < masked(keys[b], bits); });
  return order;
}

template <class T> struct Sorted {
  std::vector<T> keys;
  std::vector<uint32_t> values;
};

/* The values are the numbers of the items: after the sort they show that it was stable. */
template <class T>
Sorted<T> sort_on(Primitives &primitives, const std::vector<T> &keys, Bits bits, bool with_values, uint32_t capacity)
{
  constexpr bool wide = sizeof(T) == 8;
  const Buffer key = wide ? Buffer::pair_key : Buffer::sort_key;
  const Buffer other = wide ? Buffer::pair_key_other : Buffer::sort_key_other;
  const uint32_t n = static_cast<uint32_t>(keys.size());
  std::vector<uint32_t> values(n);
  std::iota(values.begin(), values.end(), 0u);
  primitives.set_length(n);
  primitives.set(key, keys);
  primitives.set(Buffer::sort_value, values);
  primitives.reserve(other, std::max(n, 1u) * sizeof(T));
  primitives.reserve(Buffer::sort_value_other, std::max(n, 1u) * 4);
  primitives.reserve(Buffer::sort_histogram, histogram_words(capacity) * 4);
  primitives.reserve(Buffer::scan_sums, scan_sum_words(histogram_words(capacity)) * 4);
  const auto call = [&](auto sort, auto... buffers) {
    sort(primitives.launcher, buffers..., Buffer::sort_histogram, Buffer::scan_sums, COUNT_LENGTH, capacity, bits.first,
         bits.last);
  };
  if (with_values) call(wide ? sort_pairs64 : sort_pairs, key, Buffer::sort_value, other, Buffer::sort_value_other);
  else call(wide ? sort_keys64 : sort_keys, key, other);
  return {primitives.get<T>(key, n), primitives.get<uint32_t>(Buffer::sort_value, n)};
}

template <class T> void check_sort(Primitives &primitives, const std::vector<T> &keys, Bits bits, uint32_t capacity)
{
  const auto order = expected_order(keys, bits);
  std::vector<T> expected;
  for (const uint32_t from : order) expected.push_back(keys[from]);
  INFO(primitives.name() << ", " << 8 * sizeof(T) << "-bit keys, n = " << keys.size() << ", bits " << bits.first
                         << " to " << bits.last << ", capacity " << capacity);
  const Sorted<T> pairs = sort_on(primitives, keys, bits, true, capacity);
  REQUIRE((pairs.keys == expected));
  REQUIRE((pairs.values == order));
  REQUIRE((sort_on(primitives, keys, bits, false, capacity).keys == expected));
}

} // namespace

TEST_CASE("radix sort is the stable sort, at every length and distribution, on every backend")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : lengths())
      for (const Distribution distribution : distributions) {
        if (n > 10'000 && distribution != Distribution::random && distribution != Distribution::few) continue;
        INFO("distribution " << static_cast<int>(distribution));
        check_sort(*primitives, keys_of<uint32_t>(distribution, n), {0, 32}, n);
        check_sort(*primitives, keys_of<uint64_t>(distribution, n), {0, 64}, n);
      }
}

TEST_CASE("radix sort by some of the bits keeps the order of the rest")
{
  for (const auto &primitives : all_primitives())
    for (const Bits bits : {Bits{0, 1}, Bits{3, 10}, Bits{0, 8}, Bits{5, 14}, Bits{7, 24}, Bits{31, 32}, Bits{9, 9}}) {
      check_sort(*primitives, keys_of<uint32_t>(Distribution::random, 5000), bits, 5000);
      check_sort(*primitives, keys_of<uint64_t>(Distribution::random, 5000), {bits.first + 30, bits.last + 30}, 5000);
    }
}

TEST_CASE("the capacity of a sort does not change its result")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : {0u, 1u, 2049u, 7000u})
      for (const uint32_t capacity : {n + 1, n + 2048, 40 * n + 70'000})
        check_sort(*primitives, keys_of<uint32_t>(Distribution::random, n), {0, 32}, capacity);
}

TEST_CASE("radix sort of 10 million pairs")
{
  Primitives primitives(make_backend("tbb"));
  const auto keys = keys_of<uint32_t>(Distribution::random, 10'000'000);
  const Sorted<uint32_t> sorted = sort_on(primitives, keys, {0, 32}, true, 10'000'000);
  for (size_t i = 1; i < keys.size(); ++i)
    if (sorted.keys[i - 1] > sorted.keys[i] ||
        (sorted.keys[i - 1] == sorted.keys[i] && sorted.values[i - 1] >= sorted.values[i]))
      FAIL("items " << i - 1 << " and " << i << " are out of order");
  for (size_t i = 0; i < keys.size(); ++i)
    if (keys[sorted.values[i]] != sorted.keys[i]) FAIL("item " << i << " has lost its value");
}
