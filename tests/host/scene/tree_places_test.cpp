/* Rows of articulations: each has a place of its own, and those of neighbours of one shape lie beside each other. */
#include <set>

#include <tandem/error.h>

#include "host/scene/tree_places.h"
#include "shared/articulations/joint_types.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

TreeShape chain_of(uint32_t links, uint32_t joint = TREE_JOINT_HINGE)
{
  TreeShape shape{LINK_NO_PARENT | TREE_JOINT_FREE << LINK_JOINT_SHIFT};
  for (uint32_t k = 1; k < links; ++k) shape.push_back((k - 1) | joint << LINK_JOINT_SHIFT);
  return shape;
}

std::vector<TreeShape> shapes_of_several_kinds()
{
  std::vector<TreeShape> shapes{chain_of(5), chain_of(3), chain_of(3), chain_of(3), chain_of(1)};
  shapes.insert(shapes.end(), 40, chain_of(14));
  shapes.insert(shapes.end(), 35, chain_of(14, TREE_JOINT_SLIDER));
  return shapes;
}

} // namespace

TEST_CASE("each row of an articulation has a place of its own in the tables")
{
  const std::vector<TreeShape> shapes = shapes_of_several_kinds();
  const std::vector<TreePlace> places = tree_places(shapes);
  REQUIRE(places.size() == shapes.size());
  const TreeRoom room = room_of(places);
  for (const size_t rows : {1, 8}) {
    std::set<size_t> taken;
    size_t all = 0;
    for (size_t tree = 0; tree < shapes.size(); ++tree) {
      REQUIRE(places[tree].links == shapes[tree].size());
      all += rows * places[tree].links;
      for (size_t link = 0; link < places[tree].links; ++link)
        for (size_t row = 0; row < rows; ++row) taken.insert(places[tree].row(rows, link, row));
    }
    CHECK(taken.size() == all);
    CHECK(*taken.rbegin() < rows * room.links);
  }
  std::set<uint32_t> of_trees;
  for (const TreePlace &place : places) of_trees.insert(place.first + place.item);
  CHECK(of_trees.size() == places.size());
  CHECK(*of_trees.rbegin() < room.trees);
}

TEST_CASE("eight articulations of one shape or more lie beside each other, and those of another shape apart")
{
  const std::vector<TreePlace> places = tree_places(shapes_of_several_kinds());
  for (size_t tree = 0; tree < 5; ++tree) CHECK(places[tree].stride == 1);
  for (size_t tree = 5; tree < 5 + 40 + 32; ++tree) CHECK(places[tree].stride == TREES_BESIDE);
  for (size_t tree = 5 + 40 + 32; tree < places.size(); ++tree) CHECK(places[tree].stride == 1); /* three are left */
  CHECK(places[6].row(8, 1, 3) == places[5].row(8, 1, 3) + 1);
  CHECK(places[5 + 32].block == places[5].block + 32 * 14);
  CHECK(places[5 + 40].block == places[5 + 32].block + 32 * 14); /* as many links, other joints */
}

TEST_CASE("tables of paths of articulations have room for all that lie beside each other")
{
  const std::vector<TreePlace> places = tree_places(shapes_of_several_kinds());
  std::vector<uint32_t> entries(places.size(), 7);
  entries.back() = 0; /* too long for a table */
  const PathPlaces paths = path_places(places, entries);
  REQUIRE(paths.of_tree.size() == places.size());
  CHECK(paths.of_tree[5].block == 7 * (5 + 3 + 3 + 3 + 1));
  CHECK(paths.of_tree[5 + 31].block == paths.of_tree[5].block);
  CHECK(paths.of_tree[5 + 32].block == paths.of_tree[5].block + 7 * 32 * 14);
  CHECK(paths.of_tree.back().entries == 0);
  CHECK(paths.entries == size_t{7} * (15 + 3 * 32 * 14 + 2 * 14));
}

TEST_CASE("articulations whose rows 32 bits cannot count are refused, and none take no room")
{
  CHECK(tree_places({}).empty());
  CHECK(room_of({}).links == 0);
  CHECK(path_places({}, {}).entries == 0);
  const std::vector<TreeShape> many(8, chain_of(5600000)); /* with room for 32 of them */
  CHECK_THROWS_AS(tree_places(many), InputError);
  CHECK_NOTHROW(tree_places(std::span(many).first(7)));
}
