/* world_joints.cpp - see world_joints.h. */
#include "host/world/world_joints.h"

#include <algorithm>
#include <numeric>

#include "host/scene/joint_rows.h"

namespace tandem {

WorldJoints::WorldJoints(const Scene &all, const JointGraph &graph, uint32_t worlds)
    : places_(graph.order.size()), first_(worlds + size_t{1}), axes_(worlds)
{
  const auto world_of = [&](uint32_t joint) {
    return some_body_of(all.joints[joint]) / (all.bodies.size() / axes_.size());
  };
  for (const uint32_t joint : graph.order) {
    uint32_t &axes = axes_[world_of(joint)];
    axes = std::max(axes, static_cast<uint32_t>(axes_used_by(all.joints[joint]).size()));
    ++first_[world_of(joint) + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<uint32_t> next = first_;
  for (uint32_t place = 0; place < graph.order.size(); ++place) places_[next[world_of(graph.order[place])]++] = place;
}

JointPlaces WorldJoints::of(uint32_t world) const
{
  const std::span<const uint32_t> all(places_);
  return {all.subspan(first_[world], first_[world + 1] - first_[world]), axes_[world],
          static_cast<uint32_t>(all.size())};
}

std::vector<size_t> items_of_joints(Buffer buffer, const JointPlaces &joints)
{
  const uint32_t planes = row_of(buffer).capacity == Capacity::JOINTS ? 1 : joints.axes;
  std::vector<size_t> items;
  items.reserve(planes * joints.places.size());
  for (uint32_t plane = 0; plane < planes; ++plane)
    for (const uint32_t place : joints.places) items.push_back(size_t{plane} * joints.all + place);
  return items;
}

} // namespace tandem
