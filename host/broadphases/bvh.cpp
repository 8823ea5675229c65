/* bvh.cpp - a hierarchy of boxes over the bodies along a curve, walked by every body (shared/broadphase/hierarchy.h). Its order is kept
 * from step to step and its boxes are made anew, until too many bodies have left the places they were filed under. */
#include "host/broadphases/broadphase.h"
#include "host/layout.h"
#include "shared/body_codes.h"
#include "shared/broadphase/curve_limits.h"

namespace tandem {
namespace {

void find_pairs_by(StepLaunches &step, uint32_t walk)
{
  step.run(Kernel::count_strays);
  build_hierarchy(step, true);
  step.run(Kernel::hierarchy_count, {walk});
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::hierarchy_write, {walk});
}

} // namespace

void raise_boxes(StepLaunches &step)
{
  const uint32_t most_leaves = leaves_for(step.plan().bodies);
  step.run_at_most(Kernel::pyramid_leaves, most_leaves, {COUNT_HIERARCHY}, {Buffer::leaf_body});
  for (const auto &[range, height] : {std::pair{COUNT_LEAVES, 0u}, {COUNT_LEAF_TILES, 10u}, {COUNT_ONE, 20u}})
    step.launcher().launch({Kernel::pyramid_levels, {}, {height}, COUNT_ZERO, uint32_t(range), std::max(most_leaves >> height, 1u)});
  step.run(Kernel::node_boxes);
}

void build_hierarchy(StepLaunches &step, bool keep)
{
  const uint32_t bodies = step.plan().bodies;
  step.run(Kernel::plan_hierarchy, {keep ? 1u : 0u});
  find_extent(step);
  step.run_at_most(Kernel::curve_keys, bodies);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_FILED, bodies, 0, CURVE_BITS);
  step.run_at_most(Kernel::file_leaves, bodies);
  step.run_at_most(Kernel::link_nodes, bodies);
  raise_boxes(step);
}

void find_pairs_by_skipping(StepLaunches &step) { find_pairs_by(step, WALK_BY_SKIPPING); }
void find_pairs_by_stack(StepLaunches &step) { find_pairs_by(step, WALK_BY_STACK); }
void find_pairs_by_history(StepLaunches &step) { find_pairs_by(step, WALK_BY_HISTORY); }

} // namespace tandem
