/* Reductions against the standard library; sums of reals against their fixed tree and against doubles. */
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/shared/parallel/primitives.h"

using namespace tandem;

namespace {

/* reduce or reduce_real; the elements of both are 4 bytes. */
template <class T, class Function>
T reduced(Function function, Primitives &primitives, Reduction reduction, const std::vector<T> &values, size_t capacity)
{
  primitives.set_length(static_cast<uint32_t>(values.size()));
  primitives.set(Buffer::primitive_a, values);
  primitives.reserve(Buffer::primitive_b, reduce_partial_words(capacity) * sizeof(T));
  primitives.reserve(Buffer::primitive_c, sizeof(T));
  function(primitives.launcher, reduction, Buffer::primitive_a, Buffer::primitive_b, Buffer::primitive_c, COUNT_LENGTH,
           static_cast<uint32_t>(capacity));
  return primitives.get<T>(Buffer::primitive_c, 1)[0];
}

std::vector<float> random_floats(size_t n)
{
  std::mt19937 engine(static_cast<uint32_t>(n));
  std::vector<float> values(n);
  for (float &value : values)
    value = std::ldexp(static_cast<float>(engine() % 2000001u) - 1e6f, static_cast<int>(engine() % 20u) - 20);
  return values;
}

} // namespace

TEST_CASE("reductions of whole numbers equal the standard library's")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : lengths()) {
      const auto values = keys_of<uint32_t>(Distribution::random, n);
      INFO(primitives->name() << ", n = " << n);
      REQUIRE(reduced(reduce, *primitives, Reduction::sum, values, n) ==
              std::accumulate(values.begin(), values.end(), 0u));
      REQUIRE(reduced(reduce, *primitives, Reduction::smallest, values, n) ==
              (n ? *std::min_element(values.begin(), values.end()) : 0xffffffffu));
      REQUIRE(reduced(reduce, *primitives, Reduction::largest, values, n + 9000) ==
              (n ? *std::max_element(values.begin(), values.end()) : 0u));
    }
}

TEST_CASE("the smallest and largest real are found wherever they stand")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : lengths()) {
      if (n == 0) continue;
      const auto values = random_floats(n);
      INFO(primitives->name() << ", n = " << n);
      REQUIRE(reduced(reduce_real, *primitives, Reduction::smallest, values, n) ==
              *std::min_element(values.begin(), values.end()));
      REQUIRE(reduced(reduce_real, *primitives, Reduction::largest, values, n) ==
              *std::max_element(values.begin(), values.end()));
    }
}

TEST_CASE("the sum of reals has the same bits on every backend and is near the exact one")
{
  const auto all = all_primitives();
  for (const uint32_t n : lengths()) {
    const auto values = random_floats(n);
    const float first = reduced(reduce_real, *all.front(), Reduction::sum, values, n);
    const double exact = std::accumulate(values.begin(), values.end(), 0.0);
    double magnitude = 0;
    for (const float value : values) magnitude += std::fabs(value);
    /* each number passes through at most 16 + 8 additions of a tile and 1 + 8 of the tiles' sums, to first order */
    const double bound = 40 * std::ldexp(magnitude, -24);
    INFO("n = " << n);
    REQUIRE(std::fabs(first - exact) <= bound);
    for (const auto &primitives : all) {
      const float sum = reduced(reduce_real, *primitives, Reduction::sum, values, n + 5000);
      INFO(primitives->name());
      REQUIRE(std::memcmp(&sum, &first, sizeof sum) == 0);
    }
  }
}
