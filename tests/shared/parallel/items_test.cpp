/* The primitives of one item each: copies, searches, moves, compaction and the order of floats. */
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/shared/parallel/primitives.h"

using namespace tandem;

namespace {

uint32_t bits_of(float value)
{
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

void launch(Primitives &primitives, Kernel kernel, std::vector<Buffer> slots, std::vector<uint32_t> values, uint32_t n)
{
  primitives.launcher.launch({kernel, std::move(slots), std::move(values), COUNT_ZERO, COUNT_LENGTH, n});
}

} // namespace

TEST_CASE("fill, copy, sequence and offset write every item of the range and none beyond")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : {0u, 1u, 1023u, 70'001u}) {
      INFO(primitives->name() << ", n = " << n);
      std::vector<uint32_t> expected(n + 3, 99u);
      primitives->set_length(n);
      primitives->set(Buffer::primitive_a, expected);
      primitives->set(Buffer::primitive_b, expected);
      launch(*primitives, Kernel::fill, {Buffer::primitive_a}, {7}, n);
      std::fill(expected.begin(), expected.begin() + n, 7u);
      REQUIRE((primitives->get<uint32_t>(Buffer::primitive_a, n + 3) == expected));
      launch(*primitives, Kernel::copy, {Buffer::primitive_a, Buffer::primitive_b}, {}, n);
      REQUIRE((primitives->get<uint32_t>(Buffer::primitive_b, n + 3) == expected));
      launch(*primitives, Kernel::sequence, {Buffer::primitive_a}, {}, n);
      launch(*primitives, Kernel::add_offset, {Buffer::primitive_a}, {0xfffffff0u}, n);
      std::iota(expected.begin(), expected.begin() + n, 0xfffffff0u);
      REQUIRE((primitives->get<uint32_t>(Buffer::primitive_a, n + 3) == expected));
    }
}

TEST_CASE("a copy of 64-bit numbers keeps all bits")
{
  for (const auto &primitives : all_primitives()) {
    const auto values = keys_of<uint64_t>(Distribution::random, 5000);
    primitives->set_length(5000);
    primitives->set(Buffer::pair_key, values);
    primitives->reserve(Buffer::pair_key_other, 5000 * 8);
    launch(*primitives, Kernel::copy64, {Buffer::pair_key, Buffer::pair_key_other}, {}, 5000);
    INFO(primitives->name());
    CHECK((primitives->get<uint64_t>(Buffer::pair_key_other, 5000) == values));
  }
}

TEST_CASE("scatter undoes gather, and a scan undoes the difference")
{
  for (const auto &primitives : all_primitives()) {
    const uint32_t n = 20'011;
    const auto values = keys_of<uint32_t>(Distribution::random, n);
    std::vector<uint32_t> indices(n), expected(n);
    std::iota(indices.begin(), indices.end(), 0u);
    std::shuffle(indices.begin(), indices.end(), std::mt19937(5));
    for (uint32_t i = 0; i < n; ++i) expected[i] = values[indices[i]];
    INFO(primitives->name());
    primitives->set_length(n);
    primitives->set(Buffer::primitive_a, values);
    primitives->set(Buffer::primitive_b, indices);
    primitives->reserve(Buffer::primitive_c, n * 4);
    primitives->reserve(Buffer::primitive_d, n * 4);
    launch(*primitives, Kernel::gather, {Buffer::primitive_a, Buffer::primitive_b, Buffer::primitive_c}, {}, n);
    CHECK((primitives->get<uint32_t>(Buffer::primitive_c, n) == expected));
    launch(*primitives, Kernel::scatter, {Buffer::primitive_c, Buffer::primitive_b, Buffer::primitive_d}, {}, n);
    CHECK((primitives->get<uint32_t>(Buffer::primitive_d, n) == values));
    launch(*primitives, Kernel::difference, {Buffer::primitive_a, Buffer::primitive_c}, {}, n);
    auto sums = primitives->get<uint32_t>(Buffer::primitive_c, n);
    std::partial_sum(sums.begin(), sums.end(), sums.begin());
    CHECK((sums == values));
  }
}

TEST_CASE("bounds equal those of the standard library, for every value there is between and beyond")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : {0u, 1u, 2u, 777u}) {
      auto sorted = keys_of<uint32_t>(n == 777 ? Distribution::few : Distribution::random, n);
      std::sort(sorted.begin(), sorted.end());
      std::vector<uint32_t> queries = {0u, 1u, 0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu};
      for (const uint32_t value : sorted) queries.insert(queries.end(), {value - 1, value, value + 1});
      const uint32_t count = static_cast<uint32_t>(queries.size());
      std::vector<uint32_t> counts(COUNT_TOTAL, 0);
      counts[COUNT_LENGTH] = n;
      counts[COUNT_PAIRS] = count;
      primitives->set(Buffer::counts, counts);
      primitives->set(Buffer::primitive_a, sorted);
      primitives->set(Buffer::primitive_b, queries);
      primitives->reserve(Buffer::primitive_c, count * 4);
      primitives->reserve(Buffer::primitive_d, count * 4);
      for (const auto &[kernel, result] :
           {std::pair(Kernel::lower_bound, Buffer::primitive_c), std::pair(Kernel::upper_bound, Buffer::primitive_d)})
        primitives->launcher.launch({kernel,
                                     {Buffer::primitive_a, Buffer::primitive_b, result},
                                     {COUNT_LENGTH},
                                     COUNT_ZERO,
                                     COUNT_PAIRS,
                                     count});
      const auto lower = primitives->get<uint32_t>(Buffer::primitive_c, count),
                 upper = primitives->get<uint32_t>(Buffer::primitive_d, count);
      for (uint32_t i = 0; i < count; ++i) {
        INFO(primitives->name() << ", n = " << n << ", query " << queries[i]);
        REQUIRE(lower[i] ==
                static_cast<uint32_t>(std::lower_bound(sorted.begin(), sorted.end(), queries[i]) - sorted.begin()));
        REQUIRE(upper[i] ==
                static_cast<uint32_t>(std::upper_bound(sorted.begin(), sorted.end(), queries[i]) - sorted.begin()));
      }
    }
}

TEST_CASE("compaction keeps the indices of all flags, in order, and counts them for the device")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : lengths())
      for (const uint32_t one_in : {1u, 3u, 1000u}) {
        std::vector<uint32_t> flags(n), expected;
        std::mt19937 engine(n + one_in);
        for (uint32_t i = 0; i < n; ++i) {
          flags[i] = engine() % one_in == 0 ? engine() | 1u : 0u;
          if (flags[i]) expected.push_back(i);
        }
        primitives->set_length(n);
        primitives->set(Buffer::primitive_a, flags);
        primitives->reserve(Buffer::primitive_b, (n + 1) * 4);
        primitives->reserve(Buffer::primitive_c, (expected.size() + 1) * 4);
        primitives->reserve(Buffer::scan_sums, scan_sum_words(n) * 4);
        compact(primitives->launcher, Buffer::primitive_a, Buffer::primitive_b, Buffer::scan_sums, Buffer::primitive_c,
                COUNT_LENGTH, n, COUNT_PAIRS);
        INFO(primitives->name() << ", n = " << n << ", one flag in " << one_in);
        REQUIRE(primitives->get<uint32_t>(Buffer::counts, COUNT_TOTAL)[COUNT_PAIRS] == expected.size());
        REQUIRE((primitives->get<uint32_t>(Buffer::primitive_c, expected.size()) == expected));
      }
}

TEST_CASE("flipped floats are ordered like the floats, and come back bit for bit")
{
  constexpr float infinity = std::numeric_limits<float>::infinity(),
                  denormal = std::numeric_limits<float>::denorm_min();
  const std::vector<float> ordered = {-infinity, -3e38f, -1.5f, -1.0f,    -1e-38f,      -2 * denormal,
                                      -denormal, -0.0f,  0.0f,  denormal, 2 * denormal, 1e-38f,
                                      1.0f,      1.5f,   3e38f, infinity};
  std::vector<uint32_t> bits;
  for (const float value : ordered) bits.push_back(bits_of(value));
  const auto random = keys_of<uint32_t>(Distribution::random, 5000);
  bits.insert(bits.end(), random.begin(), random.end());
  const uint32_t n = static_cast<uint32_t>(bits.size());
  for (const auto &primitives : all_primitives()) {
    INFO(primitives->name());
    primitives->set_length(n);
    primitives->set(Buffer::primitive_a, bits);
    launch(*primitives, Kernel::flip_float, {Buffer::primitive_a}, {}, n);
    const auto keys = primitives->get<uint32_t>(Buffer::primitive_a, n);
    for (size_t i = 1; i < ordered.size(); ++i) REQUIRE(keys[i - 1] < keys[i]);
    for (size_t i = ordered.size() + 1; i < n; ++i) {
      float a, b;
      std::memcpy(&a, &bits[i - 1], 4);
      std::memcpy(&b, &bits[i], 4);
      if (a < b) REQUIRE(keys[i - 1] < keys[i]);
      if (a > b) REQUIRE(keys[i - 1] > keys[i]);
    }
    launch(*primitives, Kernel::unflip_float, {Buffer::primitive_a}, {}, n);
    REQUIRE((primitives->get<uint32_t>(Buffer::primitive_a, n) == bits));
  }
}
