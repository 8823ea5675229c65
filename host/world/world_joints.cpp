/* world_joints.cpp - see world_joints.h. */
#include "host/world/world_joints.h"

#include <algorithm>
#include <numeric>

#include "host/scene/joint_rows.h"

namespace tandem {

namespace {

/* The places of each world, one world after the other, and where each begins. worlds: of each place. */
struct ByWorld {
  std::vector<uint32_t> places, first;
  ByWorld(std::span<const uint32_t> worlds, size_t count) : places(worlds.size()), first(count + 1)
  {
    for (const uint32_t world : worlds) ++first[world + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<uint32_t> next = first;
    for (uint32_t place = 0; place < worlds.size(); ++place) places[next[worlds[place]]++] = place;
  }
};

} // namespace

WorldJoints::WorldJoints(const Scene &all, const JointGraph &graph, const CouplingGraph &couplings, uint32_t worlds)
    : axes_(worlds)
{
  const auto world_of = [&](uint32_t joint) {
    return static_cast<uint32_t>(some_body_of(all.joints[joint]) / (all.bodies.size() / axes_.size()));
  };
  std::vector<uint32_t> of_joints, of_couplings;
  for (const uint32_t joint : graph.order) {
    uint32_t &axes = axes_[world_of(joint)];
    axes = std::max(axes, static_cast<uint32_t>(axes_used_by(all.joints[joint]).size()));
    of_joints.push_back(world_of(joint));
  }
  for (const uint32_t coupling : couplings.order) of_couplings.push_back(world_of(all.couplings[coupling].joint_a));
  ByWorld joints(of_joints, worlds), coupled(of_couplings, worlds);
  places_ = std::move(joints.places);
  first_ = std::move(joints.first);
  couplings_ = std::move(coupled.places);
  first_coupling_ = std::move(coupled.first);
}

JointPlaces WorldJoints::of(uint32_t world) const
{
  const auto own = [world](std::span<const uint32_t> all, const std::vector<uint32_t> &first) {
    return all.subspan(first[world], first[world + 1] - first[world]);
  };
  return {own(places_, first_), axes_[world], static_cast<uint32_t>(places_.size()), own(couplings_, first_coupling_)};
}

std::vector<size_t> items_of_joints(Buffer buffer, const JointPlaces &joints)
{
  if (row_of(buffer).capacity == Capacity::COUPLINGS) return {joints.couplings.begin(), joints.couplings.end()};
  const uint32_t planes = row_of(buffer).capacity == Capacity::JOINTS ? 1 : joints.axes;
  std::vector<size_t> items;
  items.reserve(planes * joints.places.size());
  for (uint32_t plane = 0; plane < planes; ++plane)
    for (const uint32_t place : joints.places) items.push_back(size_t{plane} * joints.all + place);
  return items;
}

} // namespace tandem
