/* Rows of articulations: each has a place of its own, and those of equal neighbours lie beside each other. */
#include <set>

#include "host/scene/tree_places.h"
#include "tests/catch.h"

using namespace tandem;

TEST_CASE("rows of articulations fill their tables, and those of equal trees in a row are neighbours")
{
  std::vector<uint32_t> lengths{5, 3, 3, 3, 1};
  lengths.insert(lengths.end(), 40, 14);
  const std::vector<TreePlace> places = tree_places(lengths);
  REQUIRE(places.size() == lengths.size());
  for (const size_t rows : {1, 8}) {
    std::set<size_t> taken;
    size_t all = 0;
    for (size_t tree = 0; tree < lengths.size(); ++tree) {
      REQUIRE(places[tree].links == lengths[tree]);
      all += rows * lengths[tree];
      for (size_t link = 0; link < lengths[tree]; ++link)
        for (size_t row = 0; row < rows; ++row) taken.insert(places[tree].row(rows, link, row));
    }
    CHECK(taken.size() == all);
    CHECK(*taken.rbegin() == all - 1);
  }
  CHECK(places[0].stride == 1);
  CHECK(places[2].row(8, 1, 3) == places[1].row(8, 1, 3) + 1);
  CHECK(places[5].stride == 32);
  CHECK(places[5 + 32].stride == 8);
  CHECK(tree_places({}).empty());
}
