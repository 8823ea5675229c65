/* tree_places.h - where the links of articulations stand in the tables (shared/articulations/tree.h).
 *
 *   8 trees or more of one shape in a row    | row 0 of link 0 of 32 trees | row 1 of link 0 of them | ...
 *   any other tree                            | row 0 of link 0 | row 1 of link 0 | ... | row 0 of link 1 | ...
 *
 * The work-items of a device that run neighbouring trees read neighbouring rows then, and so do the lanes of a CPU,
 * for which all numbers that depend on the shape are one (shared/articulations/place.h). A shape is the joint and the
 * parent of each link. Where less than 32 of a shape are left, the rows of the others stay empty.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tandem {

/* The words of articulation_place: the first link of those that stand beside each other, the number of the tree among
 * them, for how many there is room, and the links of the tree; and the first of the places of trees that these take. */
struct TreePlace {
  uint32_t block, item, stride, links, first;

  /* Of a table with so many rows a link. */
  size_t row(size_t rows, size_t link, size_t row) const { return block * rows + item + (link * rows + row) * stride; }
};

/* The words that follow: where the tables of paths of the trees beside each other begin, and how many entries each of
 * their links has. */
struct PathPlace {
  uint32_t block, entries;
};
struct PathPlaces {
  std::vector<PathPlace> of_tree;
  size_t entries = 0; /* of all */
};

/* By link the word of its joint and its parent: link_code. */
using TreeShape = std::vector<uint32_t>;

/* InputError: the rows are more than 32 bits can count. */
std::vector<TreePlace> tree_places(std::span<const TreeShape> shapes);

/* With room for those that are missing. */
struct TreeRoom {
  uint32_t trees, links;
};
TreeRoom room_of(std::span<const TreePlace> places);

/* entries: of the longest path of each tree; 0 of one without a table. */
PathPlaces path_places(std::span<const TreePlace> places, std::span<const uint32_t> entries);

} // namespace tandem
