/* broadphase.cpp - the table of broadphases, and the launches they share; see broadphase.h. */
#include "host/pipeline/broadphases/broadphase.h"

#include <bit>

#include "host/pipeline/primitives.h"
#include "host/pipeline/scene_counts.h"
#include "host/pipeline/setting_rows.h"
#include "host/runtime/memory.h"

namespace tandem {

std::span<const BroadphaseRow> broadphase_rows()
{
  static constexpr BroadphaseRow rows[] = {
      {Broadphase::grid, "grid", "uniform grid, 27 cells in nine rows of three", find_pairs_in_grid, QUERY_GRID},
      {Broadphase::grid_bitonic, "grid-bitonic",
       "the same, its bodies sorted by a bitonic network instead of by digits", find_pairs_in_bitonic_grid, QUERY_GRID},
      {Broadphase::grid_14, "grid-14", "the grid by symmetry: 14 cells, and pairs to be sorted",
       find_pairs_in_half_the_cells, QUERY_GRID},
      {Broadphase::brute_force, "brute-force", "every body against every one before it: the oracle",
       find_pairs_by_brute_force, QUERY_EVERY_BODY},
      {Broadphase::sap, "sap", "sort, sweep and prune along the axis of largest variance, in windows of local memory",
       find_pairs_by_sweep_and_prune},
      {Broadphase::sap_pca, "sap-pca", "the same along the principal direction",
       find_pairs_by_principal_sweep_and_prune},
      {Broadphase::sap_plain, "sap-plain", "the sweep before it was optimised, one work-item a body",
       find_pairs_by_plain_sweep_and_prune},
      {Broadphase::sap3, "sap3",
       "incremental sweep and prune along three axes: only ends that changed their places are looked at",
       find_pairs_incrementally},
      {Broadphase::hybrid, "hybrid", "small bodies in a grid, large ones in a hierarchy", find_pairs_in_hybrid},
      {Broadphase::bvh, "bvh",
       "linear hierarchy of boxes, refitted until too many have left their places; walked by skip indices",
       find_pairs_by_skipping},
      {Broadphase::bvh_stack, "bvh-stack", "the same, walked with a stack", find_pairs_by_stack},
      {Broadphase::bvh_history, "bvh-history", "the same, walked by history flags, two bits a level",
       find_pairs_by_history},
      {Broadphase::trees, "trees",
       "a dynamic and a static tree of boxes with a margin to move in, and pairs that are kept until a body leaves its "
       "box",
       find_pairs_in_trees},
      {Broadphase::automatic, "auto", "as the scene suggests", nullptr},
  };
  static_assert(are_in_order(rows));
  return rows;
}

std::span<const BroadphaseRow> broadphases() { return broadphase_rows().first(broadphase_rows().size() - 1); }

const BroadphaseRow &row_of(Broadphase broadphase) { return row_in(broadphase_rows(), broadphase); }

void forget_kept(Memory &memory)
{
  for (const uint32_t entry : {COUNT_KEPT, COUNT_HIERARCHY_KEPT}) set_count(memory, entry, 0);
}

void find_extent(StepLaunches &step, bool hybrid)
{
  step.run(Kernel::extent_tiles);
  step.run(Kernel::extent_whole);
  step.run(Kernel::compute_grid_layout, {hybrid ? 1u : 0u});
}

void sort_pair_keys(StepLaunches &step, Buffer keys, Buffer other_keys, uint32_t length, uint32_t capacity)
{
  for (unsigned first_bit : {0u, 32u})
    sort_keys64(step.launcher(), keys, other_keys, Buffer::sort_histogram, Buffer::scan_sums, length, capacity,
                first_bit, first_bit + static_cast<unsigned>(std::bit_width(step.plan().bodies)));
}

void pairs_from_keys(StepLaunches &step)
{
  sort_pair_keys(step, Buffer::pair_key, Buffer::pair_key_other, COUNT_PAIRS, step.plan().capacity_pairs);
  step.run(Kernel::unpack_pairs);
  step.run(Kernel::start_pairs);
}

} // namespace tandem
