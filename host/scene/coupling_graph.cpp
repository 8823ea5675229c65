/* coupling_graph.cpp - see coupling_graph.h. */
#include "host/scene/coupling_graph.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <tuple>

#include <tandem/round_to_float.h>

#include "host/scene/coupling_rows.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_graph.h"
#include "shared/counts.h"
#include "shared/joints/coupling_codes.h"

namespace tandem {
namespace {

std::array<uint32_t, 4> bodies_of(const Scene &scene, const Coupling &coupling)
{
  const Joint &a = scene.joints[coupling.joint_a], &b = scene.joints[coupling.joint_b];
  return {a.body_a, a.body_b, b.body_a, b.body_b};
}

/* By coupling of the scene its articulation, or no_link. */
std::vector<uint32_t> trees_of(const Scene &scene)
{
  std::vector<uint32_t> trees(scene.couplings.size(), no_link);
  if (scene.couplings.empty() || scene.articulations.empty()) return trees;
  const JointedLinks links = links_of(scene);
  for (size_t k = 0; k < trees.size(); ++k) trees[k] = links.of_joint[scene.couplings[k].joint_a];
  return trees;
}

/* The lowest colour that is free at all of its bodies that can be pushed; of one of a tree the last one. */
std::vector<uint32_t> colors_of(const Scene &scene, const std::vector<uint32_t> &trees)
{
  std::vector<uint64_t> used(scene.couplings.empty() ? 0 : scene.bodies.size());
  std::vector<uint32_t> colors;
  for (size_t k = 0; k < scene.couplings.size(); ++k) {
    const Coupling &coupling = scene.couplings[k];
    uint64_t taken = trees[k] == no_link ? 0 : UINT64_MAX;
    for (const uint32_t body : bodies_of(scene, coupling))
      if (can_be_pushed(scene, body)) taken |= used[body];
    const auto color = static_cast<uint32_t>(std::countr_one(taken));
    colors.push_back(std::min(color, COLOR_OVERFLOW));
    if (color >= COLOR_LIMIT) continue;
    for (const uint32_t body : bodies_of(scene, coupling))
      if (can_be_pushed(scene, body)) used[body] |= uint64_t{1} << color;
  }
  return colors;
}

} // namespace

CouplingGraph coupling_graph_of(const Scene &scene, uint32_t worlds)
{
  CouplingGraph graph;
  const std::vector<uint32_t> trees = trees_of(scene), colors = colors_of(scene, trees);
  graph.starts.assign(COLOR_ENTRIES, 0);
  for (size_t k = 0; k < colors.size(); ++k) {
    ++graph.starts[colors[k] + 1];
    if (trees[k] == no_link) graph.colors = std::max(graph.colors, colors[k] + 1);
  }
  std::partial_sum(graph.starts.begin(), graph.starts.end(), graph.starts.begin());
  graph.order.resize(colors.size());
  std::iota(graph.order.begin(), graph.order.end(), 0u);
  const size_t bodies_of_world = std::max<size_t>(scene.bodies.size() / worlds, 1);
  const auto place = [&](uint32_t coupling) {
    const uint32_t body = some_body_of(scene.joints[scene.couplings[coupling].joint_a]), tree = trees[coupling];
    const bool is_of_tree = tree != no_link;
    const size_t world = colors[coupling] == COLOR_OVERFLOW ? body / bodies_of_world : 0;
    return std::tuple(colors[coupling], is_of_tree, is_of_tree ? tree : world, coupling);
  };
  std::sort(graph.order.begin(), graph.order.end(), [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
  return graph;
}

Features coupling_features(const Scene &scene)
{
  if (scene.couplings.empty()) return 0;
  const std::vector<bool> articulated = articulated_joints(scene);
  const bool of_tree = std::any_of(scene.couplings.begin(), scene.couplings.end(),
                                   [&](const Coupling &coupling) { return articulated[coupling.joint_a]; });
  return FEATURE_COUPLINGS | FEATURE_JOINT_FRAMES | (of_tree ? FEATURE_TREE_COUPLINGS : 0);
}

void stage_couplings(StagedUploads &uploads, const Scene &scene, const CouplingGraph &graph)
{
  std::vector<uint32_t> kinds;
  std::vector<float4> rows;
  for (const uint32_t coupling : graph.order) {
    const CouplingRow row = row_of(scene.couplings[coupling], scene);
    kinds.push_back(row.kind_a | row.kind_b << COUPLING_KIND_B_SHIFT |
                    (row.one_sided ? uint32_t{COUPLING_ONE_SIDED} : 0u));
    rows.push_back(
        {round_to_float(row.of_a), round_to_float(row.of_b), round_to_float(row.offset), round_to_float(row.period)});
  }
  uploads.add(Buffer::coupling_kind, std::move(kinds));
  uploads.add(Buffer::coupling_row, std::move(rows));
}

void stage_couplings_of_trees(StagedUploads &uploads, const Scene &scene, const CouplingGraph &graph,
                              const JointedLinks &links)
{
  std::vector<uint32_t> of_tree(2 * scene.articulations.size()), link(2 * graph.order.size());
  for (uint32_t place = 0; place < graph.order.size(); ++place) {
    const Coupling &coupling = scene.couplings[graph.order[place]];
    const uint32_t tree = links.of_joint.empty() ? no_link : links.of_joint[coupling.joint_a];
    if (tree == no_link) continue;
    link[2 * place] = links.number_of_joint[coupling.joint_a];
    link[2 * place + 1] = links.number_of_joint[coupling.joint_b];
    uint32_t &first = of_tree[2 * tree], &count = of_tree[2 * tree + 1];
    if (count++ == 0) first = place;
  }
  uploads.add(Buffer::tree_coupling, std::move(of_tree));
  uploads.add(Buffer::coupling_link, std::move(link));
}

void stage_joints_of_couplings(StagedUploads &uploads, const Scene &scene, const CouplingGraph &graph,
                               std::span<const uint32_t> awake)
{
  std::vector<uint32_t> places(scene.joints.size(), INDEX_NONE), a, b;
  for (uint32_t place = 0; place < awake.size(); ++place) places[awake[place]] = place;
  for (const uint32_t coupling : graph.order) {
    a.push_back(places[scene.couplings[coupling].joint_a]);
    b.push_back(places[scene.couplings[coupling].joint_b]);
  }
  uploads.add(Buffer::coupling_a, std::move(a));
  uploads.add(Buffer::coupling_b, std::move(b));
}

} // namespace tandem
