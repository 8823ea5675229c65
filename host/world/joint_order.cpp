/* joint_order.cpp - see joint_order.h. */
#include "host/world/joint_order.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <unordered_set>

namespace tandem {
namespace {

/* The place of each joint of an order. */
std::vector<uint32_t> places_in(std::span<const uint32_t> joints)
{
  std::vector<uint32_t> places(joints.size());
  for (uint32_t place = 0; place < joints.size(); ++place) places[joints[place]] = place;
  return places;
}

} // namespace

JointOrder::JointOrder(const Scene &scene, const JointGraph &graph)
    : joints_(graph.order), place_(places_in(joints_)), starts_(graph.starts), rank_(place_), colors_(graph.starts),
      first_(scene.bodies.size() + 1)
{
  const auto for_each_side = [&](const auto &visit) {
    for (uint32_t joint = 0; joint < scene.joints.size(); ++joint)
      for (const uint32_t body : {scene.joints[joint].body_a, scene.joints[joint].body_b})
        if (scene.joints[joint].enabled && body != no_body) visit(joint, body);
  };
  for_each_side([&](uint32_t, uint32_t body) { ++first_[body + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  of_body_.resize(first_.back());
  std::vector<uint32_t> next = first_;
  for_each_side([&](uint32_t joint, uint32_t body) { of_body_[next[body]++] = joint; });
}

/* How many of the colours from one on, of which the last is that of overflow joints, are in use. */
uint32_t JointOrder::colors_from(uint32_t first) const
{
  uint32_t colors = COLOR_OVERFLOW + 1;
  while (colors > 0 && starts_[first + colors - 1] == starts_[first + COLOR_OVERFLOW + 1]) --colors;
  return colors;
}

/* Bodies that came later than the graph have no joints. */
std::span<const uint32_t> JointOrder::of_body(uint32_t body) const
{
  if (body + size_t{1} >= first_.size()) return {};
  return std::span(of_body_).subspan(first_[body], first_[body + 1] - first_[body]);
}

void JointOrder::find_starts(size_t awake)
{
  const auto end = joints_.begin() + static_cast<ptrdiff_t>(awake);
  for (size_t color = 0; color < starts_.size(); ++color) {
    const auto first =
        std::partition_point(joints_.begin(), end, [&](uint32_t joint) { return rank_[joint] < colors_[color]; });
    starts_[color] = static_cast<uint32_t>(first - joints_.begin());
  }
}

/* first: what stands at the first places, whose present joints are among these. all_from: the first place whose joint
 * is listed even if it stands there already. */
JointOrder::Moves JointOrder::put(std::vector<uint32_t> first, size_t awake, size_t all_from)
{
  Moves moves;
  for (uint32_t place = 0; place < first.size(); ++place)
    if (place_[first[place]] != place || place >= all_from) {
      moves.from.push_back(place_[first[place]]);
      moves.to.push_back(place);
    }
  std::copy(first.begin(), first.end(), joints_.begin());
  for (const uint32_t place : moves.to) place_[joints_[place]] = place;
  find_starts(awake);
  return moves;
}

JointOrder::Moves JointOrder::put_to_sleep(const std::function<bool(uint32_t)> &sleeps)
{
  std::vector<uint32_t> first(awake().begin(), awake().end());
  const auto fallen = std::stable_partition(first.begin(), first.end(), [&](uint32_t joint) { return !sleeps(joint); });
  const auto still_awake = static_cast<size_t>(fallen - first.begin());
  return put(std::move(first), still_awake, still_awake);
}

/* What sleeps on and stands where more are awake now goes to the places that those who wake leave. */
JointOrder::Moves JointOrder::wake(std::vector<uint32_t> woken)
{
  const size_t before = starts_.back(), end = before + woken.size();
  const auto by_rank = [&](uint32_t one, uint32_t other) { return rank_[one] < rank_[other]; };
  std::sort(woken.begin(), woken.end(), by_rank);
  const std::unordered_set<uint32_t> moving(woken.begin(), woken.end());
  std::vector<uint32_t> left;
  for (const uint32_t joint : woken)
    if (place_[joint] >= end) left.push_back(place_[joint]);
  std::sort(left.begin(), left.end());
  Moves others;
  for (size_t place = before; place < end; ++place)
    if (!moving.contains(joints_[place])) {
      others.to.push_back(left[others.from.size()]);
      others.from.push_back(static_cast<uint32_t>(place));
    }
  std::vector<uint32_t> first, displaced;
  std::merge(awake().begin(), awake().end(), woken.begin(), woken.end(), std::back_inserter(first), by_rank);
  for (const uint32_t place : others.from) displaced.push_back(joints_[place]);
  Moves moves = put(std::move(first), end, end);
  for (size_t k = 0; k < displaced.size(); ++k) {
    joints_[others.to[k]] = displaced[k];
    place_[displaced[k]] = others.to[k];
  }
  moves.from.insert(moves.from.end(), others.from.begin(), others.from.end());
  moves.to.insert(moves.to.end(), others.to.begin(), others.to.end());
  return moves;
}

JointOrder::Moves JointOrder::take(std::vector<uint32_t> joints, size_t awake)
{
  const size_t all = joints.size();
  return put(std::move(joints), awake, all);
}

bool JointOrder::is_order(std::span<const uint32_t> joints, size_t awake) const
{
  std::vector<bool> seen(joints_.size());
  if (joints.size() != joints_.size() || awake > joints.size()) return false;
  for (const uint32_t joint : joints) {
    if (joint >= seen.size() || seen[joint]) return false;
    seen[joint] = true;
  }
  return std::is_sorted(joints.begin(), joints.begin() + static_cast<ptrdiff_t>(awake),
                        [&](uint32_t one, uint32_t other) { return rank_[one] < rank_[other]; });
}

} // namespace tandem
