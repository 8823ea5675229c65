/* joint_graph.cpp - see joint_graph.h. */
#include "host/scene/joint_graph.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>

#include "host/scene/articulation_buffers.h"
#include "host/scene/articulation_order.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"
#include "shared/counts.h"

namespace tandem {
namespace {

/* The colours of joints that hold links come behind all others. */
constexpr uint32_t first_of_links = COLOR_OVERFLOW + 1;

/* The colour of joints that are not enabled, of those of articulations, and of those of links that hold nothing. */
constexpr uint32_t behind_all = 2 * first_of_links;

/* The colours in use at the bodies, as one word of 64 bits each; of links, at the node of their tree. */
class ColorsAtBodies {
public:
  ColorsAtBodies(const Scene &scene, std::vector<uint32_t> node_of_body)
      : scene_(scene), node_(std::move(node_of_body)), used_(scene.bodies.size())
  {}

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
  uint64_t used_at(uint32_t body) const { return is_shared(body) ? 0 : used_[node_[body]]; }
  void mark(uint32_t body, uint32_t color)
  {
    if (!is_shared(body)) used_[node_[body]] |= uint64_t{1} << color;
  }

  const Scene &scene_;
  std::vector<uint32_t> node_;
  std::vector<uint64_t> used_;
};

std::vector<uint32_t> each_by_itself(size_t bodies)
{
  std::vector<uint32_t> nodes(bodies);
  std::iota(nodes.begin(), nodes.end(), 0u);
  return nodes;
}

/* By body: that of the first link of its tree, or its own. */
std::vector<uint32_t> nodes_of(const JointedLinks &links)
{
  std::vector<uint32_t> nodes = each_by_itself(links.of_body.size());
  for (uint32_t body = 0; body < nodes.size(); ++body)
    if (links.has_body(body)) nodes[body] = links.trees[links.of_body[body]].front();
  return nodes;
}

/* Gives the joints of a scene their colours. */
class JointColors {
public:
  explicit JointColors(const Scene &scene)
      : scene_(scene), links_(links_of(scene)), articulated_(articulated_joints(scene)),
        at_bodies_(scene, each_by_itself(scene.bodies.size())), at_trees_(scene, nodes_of(links_))
  {}
  uint32_t take(size_t number)
  {
    const Joint &joint = scene_.joints[number];
    if (!joint.enabled || is_without_rows(number)) return behind_all;
    if (holds_link(links_, joint)) return first_of_links + at_trees_.take(joint);
    return at_bodies_.take(joint);
  }
  std::vector<uint32_t> words() const { return at_bodies_.words(); }

private:
  bool is_without_rows(size_t number) const
  {
    const Joint &joint = scene_.joints[number];
    return articulated_[number] ? !has_rows_besides_tree(joint) : holds_link(links_, joint) && holds_nothing(joint);
  }

  const Scene &scene_;
  JointedLinks links_;
  std::vector<bool> articulated_;
  ColorsAtBodies at_bodies_, at_trees_;
};

} // namespace

JointGraph joint_graph_of(const Scene &scene, uint32_t worlds)
{
  JointGraph graph;
  JointColors given(scene);
  std::vector<uint32_t> colors;
  graph.starts.assign(behind_all + 1, 0);
  for (size_t k = 0; k < scene.joints.size(); ++k) {
    const uint32_t color = colors.emplace_back(given.take(k));
    if (color == behind_all) {
      if (scene.joints[k].enabled) graph.without_rows.push_back(static_cast<uint32_t>(k));
      continue;
    }
    ++graph.starts[color + 1];
    if (color < first_of_links) graph.colors = std::max(graph.colors, color + 1);
    else graph.link_colors = std::max(graph.link_colors, color - first_of_links + 1);
  }
  graph.axes = most_axes_of_joint(scene);
  graph.joined_pairs = joined_pair_entries(scene);
  std::partial_sum(graph.starts.begin(), graph.starts.end(), graph.starts.begin());
  graph.order.resize(colors.size());
  std::iota(graph.order.begin(), graph.order.end(), 0u);
  const size_t bodies_of_world = scene.bodies.size() / worlds;
  const auto place = [&](uint32_t joint) {
    const bool overflows = colors[joint] == COLOR_OVERFLOW || colors[joint] == first_of_links + COLOR_OVERFLOW;
    const size_t world = overflows ? some_body_of(scene.joints[joint]) / bodies_of_world : 0;
    return std::tuple(colors[joint], world, scene.joints[joint].type, joint);
  };
  std::sort(graph.order.begin(), graph.order.end(), [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
  graph.body_colors = given.words();
  return graph;
}

} // namespace tandem
