/* Scratch buffers hold what every sort and scan of a step needs, whatever the capacities are. */
#include "host/pipeline/layout.h"
#include "host/pipeline/primitives.h"
#include "shared/articulations/joint_types.h"
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

TEST_CASE("rows of contacts of trees have room for those of trees alone, and never for more than there are pairs")
{
  Sizes sizes = sizes_of(20000, 100000, 0);
  sizes.features = FEATURE_ARTICULATIONS;
  sizes.tree_freedoms = 27;
  const auto rows = [&] { return bytes_of(Buffer::contact_row, sizes) / (2 * 4 * sizeof(float)); };
  sizes.articulations = 1;
  CHECK(rows() == 27 * TREE_COLORS);
  sizes.articulations = 1000;
  CHECK(rows() == size_t{27} * 1000 * TREE_COLORS);
  sizes.articulations = 10000;
  CHECK(rows() == size_t{27} * 100000);
  CHECK(bytes_of(Buffer::contact_term, sizes) == size_t{9} * 4 * sizeof(float) * 100000);
}
