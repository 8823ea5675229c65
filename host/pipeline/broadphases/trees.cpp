/* trees.cpp - a dynamic and a static tree of fat AABBs, and the pairs of those, which are kept from step to step
 * (shared/broadphase/fat_aabbs.h, candidate_pairs.h).
 *
 * If no body left its fat AABB, the kernels between plan_trees and the filter have hardly any items. Their ranges are
 * entries of counts on the device, so the host launches them without asking.
 */
#include <bit>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/layout.h"
#include "host/pipeline/primitives.h"
#include "shared/broadphase/curve_limits.h"

namespace tandem {
namespace {

void file_in_trees(StepLaunches &step)
{
  const uint32_t bodies = step.plan().bodies;
  step.run_at_most(Kernel::refit_leaves, bodies);
  step.run(Kernel::plan_hierarchy, {1});
  find_extent(step);
  step.run_at_most(Kernel::tree_keys, bodies);
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_INSERTED, bodies, 0, CURVE_BITS + 1);
  link_leaves(step, Buffer::fat_bounds);
  raise_boxes(step, Buffer::fat_bounds, COUNT_INSERTED_LEAVES, COUNT_RAISED);
}

void find_new_pairs(StepLaunches &step)
{
  const StepPlan &plan = step.plan();
  step.run_at_most(Kernel::candidate_count, plan.bodies);
  exclusive_scan(step.launcher(), Buffer::key_start, Buffer::key_start, Buffer::scan_sums, COUNT_CHANGED, plan.bodies);
  step.run(Kernel::count_candidate_keys);
  step.run_at_most(Kernel::candidate_write, plan.bodies);
  sort_pair_keys(step, Buffer::candidate_key, Buffer::candidate_key_other, COUNT_CANDIDATE_KEYS,
                 plan.capacity_candidates);
}

void merge_new_pairs(StepLaunches &step)
{
  const uint32_t bodies = step.plan().bodies;
  step.run_at_most(Kernel::merge_candidate_count, bodies);
  exclusive_scan(step.launcher(), Buffer::key_start, Buffer::key_start, Buffer::scan_sums, COUNT_CHANGED, bodies);
  step.run_at_most(Kernel::merge_candidate_write, bodies);
  step.run(Kernel::swap_candidate_lists);
}

} // namespace

void find_pairs_in_trees(StepLaunches &step)
{
  step.run(Kernel::update_fat_aabbs);
  step.run(Kernel::plan_trees);
  file_in_trees(step);
  find_new_pairs(step);
  merge_new_pairs(step);
  step.run(Kernel::filter_candidates);
  step.scan_pairs(Buffer::pair_start);
  step.run(Kernel::take_candidates);
  step.run(Kernel::keep_candidates);
}

} // namespace tandem
