/* Exclusive scan against sums in 64 bits: every length at which tiles begin, every backend. */
#include <algorithm>
#include <bit>
#include <numeric>

#include "host/runtime/make_backend.h"
#include "tests/shared/parallel/primitives.h"

using namespace tandem;

namespace {

constexpr uint32_t untouched = 0xabadcafeu;

/* Sums past the largest number stay there. */
std::vector<uint32_t> expected_scan(const std::vector<uint32_t> &values)
{
  std::vector<uint32_t> result{0};
  uint64_t sum = 0;
  for (const uint32_t value : values) {
    sum += value;
    result.push_back(static_cast<uint32_t>(std::min<uint64_t>(sum, UINT32_MAX)));
  }
  return result;
}

/* Small enough for the sum of n to stay below 2^32. */
std::vector<uint32_t> small_values(uint32_t n)
{
  std::vector<uint32_t> values = keys_of<uint32_t>(Distribution::random, n);
  for (uint32_t &value : values) value >>= std::bit_width(n);
  return values;
}

std::vector<uint32_t> scan_in_place(Primitives &primitives, const std::vector<uint32_t> &values, uint32_t capacity)
{
  std::vector<uint32_t> padded = values;
  padded.resize(std::max<size_t>(capacity, values.size()) + 1, untouched);
  primitives.set_length(static_cast<uint32_t>(values.size()));
  primitives.set(Buffer::primitive_a, padded);
  primitives.reserve(Buffer::scan_sums, scan_sum_words(capacity) * 4);
  exclusive_scan(primitives.launcher, Buffer::primitive_a, Buffer::primitive_a, Buffer::scan_sums, COUNT_LENGTH,
                 capacity);
  const auto all = primitives.get<uint32_t>(Buffer::primitive_a, padded.size());
  for (size_t i = values.size() + 1; i < all.size(); ++i)
    if (all[i] != untouched) FAIL("element " << i << " beyond the result was written");
  return {all.begin(), all.begin() + static_cast<ptrdiff_t>(values.size()) + 1};
}

} // namespace

TEST_CASE("exclusive scan equals sums in 64 bits")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : lengths()) {
      const auto values = small_values(n);
      INFO(primitives->name() << ", n = " << n);
      REQUIRE((scan_in_place(*primitives, values, n) == expected_scan(values)));
    }
}

/* 92,683 spheres in one place have 4,295,022,903 pairs: a sum modulo 2^32 makes that 55,607. */
TEST_CASE("sums past 2^32 stay at the largest number, however often they pass it and wherever")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : {1u, 2u, 31u, 257u, 4095u, 4096u, 4097u, 20'000u, 92'683u, 100'003u}) {
      std::vector<uint32_t> many(n);
      std::iota(many.begin(), many.end(), 0u);
      std::vector<uint32_t> one_large(n, 1), at_end(n, 0);
      one_large[n / 2] = UINT32_MAX;
      at_end[n - 1] = at_end[0] = 0x80000000u;
      for (const auto &values : {many, one_large, at_end, keys_of<uint32_t>(Distribution::random, n),
                                 std::vector<uint32_t>(n, UINT32_MAX)}) {
        INFO(primitives->name() << ", n = " << n);
        REQUIRE((scan_in_place(*primitives, values, n) == expected_scan(values)));
      }
    }
}

TEST_CASE("the capacity of a scan does not change its result")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : {0u, 1u, 4097u, 20'000u})
      for (const uint32_t capacity : {n + 1, n + 4096, 3 * n + 50'000}) {
        const auto values = keys_of<uint32_t>(Distribution::random, n);
        INFO(primitives->name() << ", n = " << n << ", capacity = " << capacity);
        REQUIRE((scan_in_place(*primitives, values, capacity) == expected_scan(values)));
      }
}

TEST_CASE("a scan from one buffer to another leaves the first alone")
{
  for (const auto &primitives : all_primitives()) {
    const auto values = keys_of<uint32_t>(Distribution::random, 9999);
    primitives->set_length(9999);
    primitives->set(Buffer::primitive_a, values);
    primitives->reserve(Buffer::primitive_b, 10'000 * 4);
    primitives->reserve(Buffer::scan_sums, scan_sum_words(9999) * 4);
    exclusive_scan(primitives->launcher, Buffer::primitive_a, Buffer::primitive_b, Buffer::scan_sums, COUNT_LENGTH,
                   9999);
    INFO(primitives->name());
    CHECK((primitives->get<uint32_t>(Buffer::primitive_b, 10'000) == expected_scan(values)));
    CHECK((primitives->get<uint32_t>(Buffer::primitive_a, 9999) == values));
  }
}

TEST_CASE("exclusive scan of 20 million values: more tiles than one group takes at once")
{
  Primitives primitives(make_backend("tbb"));
  const auto values = small_values(20'000'000);
  CHECK((scan_in_place(primitives, values, 20'000'000) == expected_scan(values)));
}
