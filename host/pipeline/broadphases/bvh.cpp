/* bvh.cpp - a hierarchy of boxes over the bodies sorted along a space-filling curve, which every body traverses
 * (shared/broadphase/hierarchy.h). Its order is kept from step to step and its boxes are recomputed, until too many
 * bodies have left the places at which they were inserted. */
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/layout.h"
#include "shared/body_codes.h"
#include "shared/broadphase/curve_limits.h"

namespace tandem {
namespace {

void find_pairs_by(StepLaunches &step, uint32_t walk)
{
  step.run(Kernel::count_escaped);
  build_hierarchy(step, true);
  step.run(Kernel::hierarchy_count, {walk});
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::hierarchy_write, {walk});
}

} // namespace

void link_leaves(StepLaunches &step, Buffer boxes)
{
  step.run_at_most(Kernel::insert_leaves, step.plan().bodies, {}, {boxes});
  step.run_at_most(Kernel::link_nodes, step.plan().bodies);
}

void raise_boxes(StepLaunches &step, Buffer boxes, uint32_t leaves, uint32_t nodes)
{
  const uint32_t most = leaves_for(step.plan().bodies);
  const auto levels = [&](uint32_t range, uint32_t height) {
    step.launcher().launch({Kernel::pyramid_levels, {}, {height}, COUNT_ZERO, range, std::max(most >> height, 1u)});
  };
  step.launcher().launch({Kernel::pyramid_leaves, {boxes}, {}, COUNT_ZERO, leaves, most});
  levels(COUNT_LEAVES, 0);
  levels(COUNT_LEAF_TILES, 10);
  levels(COUNT_ONE, 20);
  step.launcher().launch({Kernel::node_boxes, {}, {}, COUNT_ZERO, nodes, step.plan().bodies});
  step.run_range(Kernel::fill, COUNT_ZERO, COUNT_LEAF_TILES, {0}, {Buffer::tile_changed});
}

void build_hierarchy(StepLaunches &step, bool keep)
{
  const uint32_t bodies = step.plan().bodies;
  step.run(Kernel::plan_hierarchy, {keep ? 1u : 0u});
  find_extent(step);
  step.run_at_most(Kernel::curve_keys, bodies);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_INSERTED, bodies, 0, CURVE_BITS);
  link_leaves(step, Buffer::bounds);
  raise_boxes(step, Buffer::bounds);
}

void find_pairs_by_skipping(StepLaunches &step) { find_pairs_by(step, WALK_BY_SKIPPING); }
void find_pairs_by_stack(StepLaunches &step) { find_pairs_by(step, WALK_BY_STACK); }
void find_pairs_by_history(StepLaunches &step) { find_pairs_by(step, WALK_BY_HISTORY); }

} // namespace tandem
