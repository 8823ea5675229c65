/* joint_recoloring.cpp - see joint_recoloring.h. */
#include "host/scene/joint_recoloring.h"

#include <algorithm>
#include <bit>
#include <functional>

#include "host/scene/articulation_buffers.h"
#include "host/scene/joint_buffers.h"
#include "shared/counts.h"

namespace tandem {

JointEdge edge_of(const Joint &joint, const JointedLinks &links)
{
  return {joint.body_a, joint.body_b, joint.enabled && !holds_link(links, joint)};
}

JointRecoloring::JointRecoloring(const Scene &scene, const JointedLinks &links, const JointGraph &graph)
    : scene_(scene), bit_(scene.joints.size()), of_body_(scene.bodies.size()), used_(scene.bodies.size()),
      reached_(scene.bodies.size())
{
  for (uint32_t color = 0; color < COLOR_LIMIT; ++color)
    for (uint32_t place = graph.starts[color]; place < graph.starts[color + 1]; ++place)
      bit_[graph.order[place]] = uint64_t{1} << color;
  for (uint32_t joint = 0; joint < scene.joints.size(); ++joint)
    list(edges_.emplace_back(edge_of(scene.joints[joint], links)), joint, true);
  const size_t known = std::min(used_.size(), graph.body_colors.size() / 2); /* bodies that came since have no joints */
  for (size_t body = 0; body < known; ++body)
    used_[body] = uint64_t{graph.body_colors[2 * body]} | uint64_t{graph.body_colors[2 * body + 1]} << 32;
}

/* A body that cannot be pushed shares its colours. */
void JointRecoloring::list(const JointEdge &edge, uint32_t number, bool listed)
{
  if (!edge.has_color) return;
  for (const uint32_t body : {edge.a, edge.b}) {
    if (!can_be_pushed(scene_, body)) continue;
    std::vector<uint32_t> &joints = of_body_[body];
    const auto at = std::lower_bound(joints.begin(), joints.end(), number);
    if (listed) joints.insert(at, number);
    else joints.erase(at);
  }
}

uint64_t JointRecoloring::used_before(uint32_t body, uint32_t number) const
{
  constexpr uint64_t all = (uint64_t{1} << COLOR_LIMIT) - 1;
  uint64_t used = 0;
  if (!can_be_pushed(scene_, body)) return used;
  for (const uint32_t joint : of_body_[body]) {
    if (joint >= number || used == all) break;
    used |= bit_[joint];
  }
  return used;
}

void JointRecoloring::look_at(uint32_t number)
{
  to_look_at_.push_back(number);
  std::push_heap(to_look_at_.begin(), to_look_at_.end(), std::greater<>());
}

/* The joints of a body are looked at one after another, until they use what they did before. */
void JointRecoloring::go_on(uint32_t body, uint32_t number, uint64_t changed)
{
  if (!can_be_pushed(scene_, body)) return;
  Reached &reached = reached_[body];
  if (reached.change != changes_) {
    reached = {used_[body], 0, changes_};
    touched_.push_back(body);
  }
  used_[body] ^= changed;
  reached.differs ^= changed;
  if (reached.differs == 0) return;
  const std::vector<uint32_t> &joints = of_body_[body];
  const auto next = std::upper_bound(joints.begin(), joints.end(), number);
  if (next != joints.end()) look_at(*next);
}

void JointRecoloring::recolor(uint32_t number)
{
  const JointEdge &edge = edges_[number];
  uint64_t bit = 0;
  if (edge.has_color) {
    const int color = std::countr_one(used_before(edge.a, number) | used_before(edge.b, number));
    if (color < static_cast<int>(COLOR_LIMIT)) bit = uint64_t{1} << color;
  }
  const uint64_t changed = bit ^ bit_[number];
  bit_[number] = bit;
  go_on(edge.a, number, changed);
  go_on(edge.b, number, changed);
}

void JointRecoloring::change(uint32_t number, const JointEdge &now)
{
  if (number >= edges_.size()) edges_.resize(number + size_t{1}), bit_.resize(edges_.size());
  ++changes_;
  touched_.clear();
  list(edges_[number], number, false);
  edges_[number].has_color = false;
  recolor(number);
  edges_[number] = now;
  list(now, number, true);
  if (now.has_color) look_at(number);
  for (uint32_t last = no_body; !to_look_at_.empty();) {
    std::pop_heap(to_look_at_.begin(), to_look_at_.end(), std::greater<>());
    const uint32_t next = to_look_at_.back();
    to_look_at_.pop_back();
    if (next != last) recolor(next); /* both of its bodies may have named it */
    last = next;
  }
  for (const uint32_t body : touched_)
    if ((used_[body] & ~reached_[body].before) != 0) recolored_.insert(body);
}

} // namespace tandem
