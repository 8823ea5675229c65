/* broadphase.h - the ways to find bodies whose bounds overlap, one small file each, of which `--broadphase NAME`
 * selects one.
 *
 * A broadphase reads `bounds`. It writes the pairs that may collide (shared/broadphase/overlap.h) to pair_a and pair_b,
 * sorted by (a, b) with a > b, the start of each body's pairs to pair_start, and COUNT_PAIRS. All of them produce the
 * same list, and therefore the same bits in every later stage; they differ only in time.
 */
#pragma once

#include <span>

#include "host/pipeline/step_launches.h"
#include "shared/body_codes.h"

namespace tandem {

struct BroadphaseRow {
  Broadphase choice;
  const char *name;
  const char *what; /* for --help and `tandem plan` */
  void (*launch)(StepLaunches &step);
  uint32_t queries = QUERY_HIERARCHY; /* QUERY_ of body_codes.h: the structure that queries between steps traverse, the
                                         broadphase's own if it has one */
};

/* In the order of the enum. All but automatic, the last, launch kernels. */
std::span<const BroadphaseRow> broadphase_rows();
std::span<const BroadphaseRow> broadphases(); /* without automatic */
const BroadphaseRow &row_of(Broadphase broadphase);

/* Invalidates what broadphases kept from the last launch. */
void forget_kept(Memory &memory);

/* Each is defined in the file of its kind. */
void find_pairs_by_brute_force(StepLaunches &step);
void find_pairs_in_grid(StepLaunches &step);
void find_pairs_in_bitonic_grid(StepLaunches &step);
void find_pairs_in_half_the_cells(StepLaunches &step);
void find_pairs_by_sweep_and_prune(StepLaunches &step);
void find_pairs_by_principal_sweep_and_prune(StepLaunches &step);
void find_pairs_by_plain_sweep_and_prune(StepLaunches &step);
void find_pairs_incrementally(StepLaunches &step);
void find_pairs_in_hybrid(StepLaunches &step);
void find_pairs_by_skipping(StepLaunches &step);
void find_pairs_by_stack(StepLaunches &step);
void find_pairs_by_history(StepLaunches &step);
void find_pairs_in_trees(StepLaunches &step);

/* Finds the extent of the small bodies, which the grid, the axis of the sweep and the frame of the curve need. */
void find_extent(StepLaunches &step, bool hybrid = false);
/* Sorts the small bodies by cells of their own extent, for the grid and for queries. */
void sort_into_cells(StepLaunches &step, bool bitonic = false);
/* Sorts as many keys of pairs as counts[length] says. */
void sort_pair_keys(StepLaunches &step, Buffer keys, Buffer other_keys, uint32_t length, uint32_t capacity);
/* Makes the list of pairs from pair_key, whose entries may be in any order. */
void pairs_from_keys(StepLaunches &step);
/* Builds the hierarchy of boxes over all bounds, for the broadphase and for queries. keep: its order may be kept from
 * the last step, and is kept for the next one. */
void build_hierarchy(StepLaunches &step, bool keep);
/* Links the nodes of a hierarchy to its sorted leaves, and computes the boxes of its nodes. boxes: the boxes of the
 * leaves; the ranges of the leaves and of the nodes are entries of counts. */
void link_leaves(StepLaunches &step, Buffer boxes);
void raise_boxes(StepLaunches &step, Buffer boxes, uint32_t leaves = COUNT_LEAVES, uint32_t nodes = COUNT_HIERARCHY);

} // namespace tandem
