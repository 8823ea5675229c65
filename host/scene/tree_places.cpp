/* tree_places.cpp - see tree_places.h. */
#include "host/scene/tree_places.h"

#include <algorithm>

namespace tandem {
namespace {

constexpr size_t most_beside = 32; /* the work-items of a warp */

} // namespace

std::vector<TreePlace> tree_places(std::span<const uint32_t> lengths)
{
  std::vector<TreePlace> places;
  uint32_t block = 0;
  for (size_t first = 0; first < lengths.size();) {
    const uint32_t length = lengths[first];
    const auto rest = lengths.subspan(first, std::min(most_beside, lengths.size() - first));
    const auto end = std::find_if(rest.begin(), rest.end(), [&](uint32_t other) { return other != length; });
    const auto stride = static_cast<uint32_t>(end - rest.begin());
    for (uint32_t item = 0; item < stride; ++item) places.push_back({block, item, stride, length});
    block += stride * length;
    first += stride;
  }
  return places;
}

PathPlaces path_places(std::span<const TreePlace> places, std::span<const uint32_t> entries)
{
  PathPlaces paths;
  for (size_t first = 0; first < places.size(); first += places[first].stride) {
    const TreePlace &place = places[first];
    const auto beside = entries.subspan(first, place.stride);
    const uint32_t most = *std::max_element(beside.begin(), beside.end());
    paths.of_tree.insert(paths.of_tree.end(), place.stride, {static_cast<uint32_t>(paths.entries), most});
    paths.entries += size_t{most} * place.stride * place.links;
  }
  return paths;
}

} // namespace tandem
