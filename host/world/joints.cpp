/* joints.cpp - the joints of a world: their tables, and what a world with joints refuses. */
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/error.h>

#include "host/pipeline/layout.h"
#include "host/pipeline/solvers/solvers.h"
#include "host/scene/articulation_buffers.h"
#include "host/scene/joint_buffers.h"
#include "host/world/implementation.h"

namespace tandem {
namespace {

std::string solvers_with_couplings()
{
  std::vector<std::string_view> names;
  for (const SolverRow &row : solvers())
    if (row.couplings) names.push_back(row.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

} // namespace

void check_couplings(const Settings &settings, const Scene &scene)
{
  if (scene.couplings.empty() || solves_couplings(settings.solver)) return;
  throw InputError(fmt::format("{}: the solver {} has no couplings, of which the scene has {}; {} have them",
                               scene.name, name_of(settings.solver), scene.couplings.size(), solvers_with_couplings()));
}

/* order: of the bodies in the buffers. */
void World::Implementation::stage_joint_tables(StagedUploads &uploads, std::span<const uint32_t> order) const
{
  std::vector<uint32_t> indices(scene.bodies.size());
  for (uint32_t i = 0; i < order.size(); ++i) indices[order[i]] = i;
  stage_joints(uploads, scene, joint_graph, joint_order.joints(), indices, plan.bodies);
  stage_bodies_of_joints(uploads, scene, joint_graph, joint_order.awake(), indices, first_joined_pair(sizes()));
  if (special.features & (FEATURE_AVBD | FEATURE_SPLIT_JOINTS))
    stage_joints_of_bodies(uploads, scene, joint_order.awake(), indices, plan.bodies);
  stage_couplings(uploads, scene, coupling_graph);
  stage_joints_of_couplings(uploads, scene, coupling_graph, joint_order.awake());
  if (!(special.features & FEATURE_ARTICULATIONS)) return;
  stage_articulations(uploads, scene, links);
  if (special.features & FEATURE_TREE_COUPLINGS) stage_couplings_of_trees(uploads, scene, coupling_graph, links);
  stage_bodies_of_links(uploads, links, indices, plan.bodies, slots.status(), special.awake);
}

/* given: slots of bodies that a call would change in a way that their joints cannot follow. */
void World::Implementation::refuse_joined(const char *call, const char *why, std::span<const uint32_t> given) const
{
  if (scene.joints.empty() || given.empty()) return;
  std::vector<bool> is_given(scene.bodies.size());
  for (const uint32_t slot : given) is_given[slot] = true;
  for (size_t k = 0; k < scene.joints.size(); ++k)
    for (const uint32_t body : {scene.joints[k].body_a, scene.joints[k].body_b})
      if (body != no_body && is_given[body])
        throw InputError(fmt::format("{}: body {}: {}, because joint {} holds it", call_in_message(call, body),
                                     body_in_message(body), why, joint_in_message(k)));
}

/* The call, and of a batch the world of the body. */
std::string World::Implementation::call_in_message(const char *call, uint32_t body) const
{
  return is_batch() ? fmt::format("{}: world {}", call, world_in_message(body)) : call;
}

/* The number of a joint, of a batch that in its world. */
uint32_t World::Implementation::joint_in_message(uint32_t joint) const
{
  if (!is_batch()) return joint;
  const auto world_of = [&](const Joint &one) { return some_body_of(one) / bodies_of_world(); };
  const uint32_t world = world_of(scene.joints[joint]);
  const auto first =
      std::find_if(scene.joints.begin(), scene.joints.end(), [&](const Joint &one) { return world_of(one) == world; });
  return joint - static_cast<uint32_t>(first - scene.joints.begin());
}

} // namespace tandem
