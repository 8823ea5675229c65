/* joint_graph.cpp - see joint_graph.h. */
#include "host/scene/joint_graph.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

#include "host/scene/articulation_buffers.h"
#include "host/scene/joint_buffers.h"
#include "shared/counts.h"

namespace tandem {
namespace {

/* The colour of joints that are not enabled, and of those of articulations. */
constexpr uint32_t behind_all = COLOR_OVERFLOW + 1;

/* The colours in use at the bodies, as one word of 64 bits each. */
class ColorsAtBodies {
public:
  explicit ColorsAtBodies(const Scene &scene) : scene_(scene), used_(scene.bodies.size()) {}

  /* The lowest colour that is free at both sides; COLOR_OVERFLOW if none is. */
  uint32_t take(const Joint &joint)
  {
    const auto color = static_cast<uint32_t>(std::countr_one(used_at(joint.body_a) | used_at(joint.body_b)));
    if (color >= COLOR_LIMIT) return COLOR_OVERFLOW;
    mark(joint.body_a, color);
    mark(joint.body_b, color);
    return color;
  }
  std::vector<uint32_t> words() const
  {
    std::vector<uint32_t> words;
    for (const uint64_t used : used_)
      words.insert(words.end(), {static_cast<uint32_t>(used), static_cast<uint32_t>(used >> 32)});
    return words;
  }

private:
  /* Bodies that cannot be pushed are shared by the joints of a colour. */
  bool is_shared(uint32_t body) const { return !can_be_pushed(scene_, body); }
  uint64_t used_at(uint32_t body) const { return is_shared(body) ? 0 : used_[body]; }
  void mark(uint32_t body, uint32_t color)
  {
    if (!is_shared(body)) used_[body] |= uint64_t{1} << color;
  }

  const Scene &scene_;
  std::vector<uint64_t> used_;
};

} // namespace

JointGraph joint_graph_of(const Scene &scene, uint32_t worlds)
{
  JointGraph graph;
  ColorsAtBodies at_bodies(scene);
  std::vector<uint32_t> colors;
  graph.starts.assign(COLOR_ENTRIES, 0);
  const std::vector<bool> articulated = articulated_joints(scene);
  for (size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint &joint = scene.joints[k];
    const bool holds = joint.enabled && !articulated[k];
    const uint32_t color = colors.emplace_back(holds ? at_bodies.take(joint) : behind_all);
    if (articulated[k]) graph.in_trees.push_back(static_cast<uint32_t>(k));
    if (!holds) continue;
    ++graph.starts[color + 1];
    graph.colors = std::max(graph.colors, color + 1);
  }
  graph.axes = most_axes_of_joint(scene);
  graph.joined_pairs = joined_pair_entries(scene);
  std::partial_sum(graph.starts.begin(), graph.starts.end(), graph.starts.begin());
  graph.order.resize(colors.size());
  std::iota(graph.order.begin(), graph.order.end(), 0u);
  const size_t bodies_of_world = scene.bodies.size() / worlds;
  const auto place = [&](uint32_t joint) {
    const size_t world = colors[joint] == COLOR_OVERFLOW ? some_body_of(scene.joints[joint]) / bodies_of_world : 0;
    return std::tuple(colors[joint], world, scene.joints[joint].type, joint);
  };
  std::sort(graph.order.begin(), graph.order.end(), [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
  graph.body_colors = at_bodies.words();
  return graph;
}

} // namespace tandem
