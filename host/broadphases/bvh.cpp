/* bvh.cpp - a hierarchy of boxes built on the device every step, and walked by every body (shared/broadphase/hierarchy.h). */
#include "host/broadphases/broadphase.h"
#include "shared/body_codes.h"

namespace tandem {
namespace {

void find_pairs_by(StepLaunches &step, uint32_t walk)
{
  build_hierarchy(step);
  step.run(Kernel::hierarchy_count, {walk});
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::hierarchy_write, {walk});
}

} // namespace

void join_levels(StepLaunches &step)
{
  step.run_range(Kernel::hierarchy_levels, COUNT_ZERO, COUNT_LEAVES, {0});
  step.run_range(Kernel::hierarchy_levels, COUNT_ZERO, COUNT_LEAF_TILES, {10});
  step.run_range(Kernel::hierarchy_levels, COUNT_ZERO, COUNT_ONE, {20});
}

void build_hierarchy(StepLaunches &step)
{
  find_extent(step);
  step.run(Kernel::curve_keys);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_BOUNDED, step.plan().bodies, 0, 30);
  step.run(Kernel::hierarchy_leaves);
  join_levels(step);
}

void find_pairs_by_skipping(StepLaunches &step) { find_pairs_by(step, WALK_BY_SKIPPING); }
void find_pairs_by_stack(StepLaunches &step) { find_pairs_by(step, WALK_BY_STACK); }
void find_pairs_by_history(StepLaunches &step) { find_pairs_by(step, WALK_BY_HISTORY); }

} // namespace tandem
