/* Scratch buffers hold what every sort and scan of a step needs, whatever the capacities are. */
#include "host/pipeline/layout.h"
#include "host/pipeline/primitives.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

size_t words_of(Buffer buffer, const Sizes &sizes) { return bytes_of(buffer, sizes) / sizeof(uint32_t); }

Sizes sizes_of(uint32_t bodies, uint32_t pairs, uint32_t candidates)
{
  Sizes sizes;
  sizes.bodies = bodies;
  sizes.pairs = pairs;
  sizes.candidates = candidates;
  return sizes;
}

} // namespace

TEST_CASE("the buffers of sorts hold the ends of boxes, pairs, candidates, and two bodies of each pair")
{
  const Sizes sizes = GENERATE(sizes_of(200, 22000, 22000), sizes_of(200, 22000, 0), sizes_of(200, 1000, 90000),
                               sizes_of(90000, 1000, 1000), sizes_of(1, 1, 1), sizes_of(0, 4097, 4097));
  const size_t sorted[] = {2 * size_t{sizes.bodies}, size_t{sizes.pairs}, size_t{sizes.candidates},
                           2 * size_t{sizes.pairs}};
  for (const size_t keys : sorted) {
    CAPTURE(sizes.bodies, sizes.pairs, sizes.candidates, keys);
    CHECK(words_of(Buffer::sort_histogram, sizes) >= histogram_words(keys));
    CHECK(words_of(Buffer::scan_sums, sizes) >= scan_sum_words(histogram_words(keys)));
  }
  CHECK(words_of(Buffer::body_constraint, sizes) == 2 * size_t{sizes.pairs});
}
