/* tree_places.h - where the links of articulations stand in the tables (shared/articulations/tree.h).
 *
 *   trees of one length that follow each other    | row 0 of link 0 of 32 trees | row 1 of link 0 of them | ...
 *   any other tree                                 | row 0 of link 0 | row 1 of link 0 | ... | row 0 of link 1 | ...
 *
 * The work-items of a device that run neighbouring trees read neighbouring rows then. A thread of a CPU that runs one
 * tree after the other finds those of the others in its cache (docs/articulations.md has figures).
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tandem {

/* The words of articulation_place: the first link of those that stand beside each other, the number of the tree among
 * them, how many they are, and the links of the tree. */
struct TreePlace {
  uint32_t block, item, stride, links;

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

/* lengths: the links of each tree. */
std::vector<TreePlace> tree_places(std::span<const uint32_t> lengths);

/* entries: of the longest path of each tree; 0 of one without a table. */
PathPlaces path_places(std::span<const TreePlace> places, std::span<const uint32_t> entries);

} // namespace tandem
