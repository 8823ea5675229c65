/* Bitonic sort of pairs against std::sort, at lengths that are powers of two and that are not. */
#include <algorithm>

#include "tests/shared/parallel/primitives.h"

using namespace tandem;

TEST_CASE("bitonic sort orders pairs by key, then value, at any length, in place")
{
  for (const auto &primitives : all_primitives())
    for (const uint32_t n : lengths())
      for (const Distribution distribution : {Distribution::random, Distribution::few, Distribution::reversed}) {
        if (n > 10'000 && distribution != Distribution::random) continue;
        const auto keys = keys_of<uint32_t>(distribution, n), values = keys_of<uint32_t>(Distribution::few, n, 17);
        std::vector<std::pair<uint32_t, uint32_t>> expected, found;
        for (uint32_t i = 0; i < n; ++i) expected.emplace_back(keys[i], values[i]);
        std::sort(expected.begin(), expected.end());
        primitives->set_length(n);
        primitives->set(Buffer::primitive_a, keys);
        primitives->set(Buffer::primitive_b, values);
        bitonic_sort(primitives->launcher, Buffer::primitive_a, Buffer::primitive_b, COUNT_LENGTH,
                     n % 2 ? n : 3 * n + 1);
        const auto sorted_keys = primitives->get<uint32_t>(Buffer::primitive_a, n);
        const auto sorted_values = primitives->get<uint32_t>(Buffer::primitive_b, n);
        for (uint32_t i = 0; i < n; ++i) found.emplace_back(sorted_keys[i], sorted_values[i]);
        INFO(primitives->name() << ", n = " << n << ", distribution " << static_cast<int>(distribution));
        REQUIRE((found == expected));
      }
}
