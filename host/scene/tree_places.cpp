/* tree_places.cpp - see tree_places.h. */
#include "host/scene/tree_places.h"

#include <algorithm>

#include <fmt/format.h>

#include <tandem/error.h>

#include "shared/articulations/joint_types.h"

namespace tandem {
namespace {

constexpr size_t fewest_beside = 8;                     /* lanes of trees; fewer would share no instructions */
constexpr uint64_t most_links = UINT32_MAX / WORK_ROWS; /* the rows of link_work have indices below 2^32 */

size_t equal_ones(std::span<const TreeShape> shapes)
{
  const auto end = std::find_if(shapes.begin(), shapes.end(), [&](const TreeShape &s) { return s != shapes.front(); });
  return std::min<size_t>(end - shapes.begin(), TREES_BESIDE);
}

/* The trees of the block of the first one. */
size_t trees_of_block(std::span<const TreePlace> places)
{
  const auto end =
      std::find_if(places.begin(), places.end(), [&](const TreePlace &p) { return p.first != places.front().first; });
  return end - places.begin();
}

} // namespace

std::vector<TreePlace> tree_places(std::span<const TreeShape> shapes)
{
  std::vector<TreePlace> places;
  uint64_t links = 0, trees = 0;
  for (size_t first = 0; first < shapes.size();) {
    const size_t equal = equal_ones(shapes.subspan(first)), beside = equal < fewest_beside ? 1 : equal;
    const uint32_t stride = beside > 1 ? TREES_BESIDE : 1;
    const auto length = static_cast<uint32_t>(shapes[first].size());
    for (uint32_t item = 0; item < beside; ++item)
      places.push_back({static_cast<uint32_t>(links), item, stride, length, static_cast<uint32_t>(trees)});
    links += uint64_t{stride} * length;
    trees += stride;
    first += beside;
    if (links > most_links)
      throw InputError(fmt::format("the articulations have more than {} links, with room for those that lie beside "
                                   "each other",
                                   most_links));
  }
  return places;
}

TreeRoom room_of(std::span<const TreePlace> places)
{
  if (places.empty()) return {0, 0};
  const TreePlace &last = places.back();
  return {last.first + last.stride, last.block + last.stride * last.links};
}

PathPlaces path_places(std::span<const TreePlace> places, std::span<const uint32_t> entries)
{
  PathPlaces paths;
  for (size_t first = 0; first < places.size();) {
    const TreePlace &place = places[first];
    const size_t trees = trees_of_block(places.subspan(first));
    const auto beside = entries.subspan(first, trees);
    const uint32_t most = *std::max_element(beside.begin(), beside.end());
    paths.of_tree.insert(paths.of_tree.end(), trees, {static_cast<uint32_t>(paths.entries), most});
    paths.entries += size_t{most} * place.stride * place.links;
    first += trees;
  }
  return paths;
}

} // namespace tandem
