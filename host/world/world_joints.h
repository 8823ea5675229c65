/* world_joints.h - where the joints and couplings of each world of a batch stand among those of all, which are in the
 * order of their colours (host/scene/joint_graph.h, coupling_graph.h). */
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/runtime/interface/kernel_list.h"
#include "host/scene/coupling_graph.h"
#include "host/scene/joint_graph.h"

namespace tandem {

struct JointPlaces {
  std::span<const uint32_t> places;    /* ascending, which is the order that the joints have in the world alone */
  uint32_t axes;                       /* JointGraph::axes of the world alone */
  uint32_t all;                        /* joints of the batch, which is how far planes of axes are apart */
  std::span<const uint32_t> couplings; /* their places */
};

class WorldJoints {
public:
  WorldJoints() = default;
  WorldJoints(const Scene &all, const JointGraph &graph, const CouplingGraph &couplings, uint32_t worlds);
  JointPlaces of(uint32_t world) const;

private:
  std::vector<uint32_t> places_, first_;             /* world after world; where each begins, and the end */
  std::vector<uint32_t> axes_;                       /* by world */
  std::vector<uint32_t> couplings_, first_coupling_; /* as places_ and first_ */
};

/* Whether a buffer has rows of joints or of couplings. */
inline bool has_rows_in_joints(Buffer buffer)
{
  return has_rows_of_joints(row_of(buffer)) || row_of(buffer).capacity == Capacity::COUPLINGS;
}

/* The rows that a world has alone in such a buffer, by their numbers in that of the batch. */
std::vector<size_t> items_of_joints(Buffer buffer, const JointPlaces &joints);

/* Visits rows that follow one another together: the first of them in the list, its number, and how many they are. */
template <class Visit> void for_each_run(std::span<const size_t> items, const Visit &visit)
{
  for (size_t begin = 0, end = 0; begin < items.size(); begin = end) {
    while (end < items.size() && items[end] == items[begin] + (end - begin)) ++end;
    visit(begin, items[begin], end - begin);
  }
}

} // namespace tandem
