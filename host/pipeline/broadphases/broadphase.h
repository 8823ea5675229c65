/* broadphase.h - the ways to find bodies whose bounds overlap, one small file each: what `--broadphase NAME` picks.
 *
 * A broadphase finds `bounds` filled. It leaves the pairs that may meet (shared/broadphase/overlap.h) in pair_a and
 * pair_b, sorted by (a, b) with a > b, where those of each body start in pair_start, and COUNT_PAIRS. Every one yields
 * the same list, hence the same bits in all that comes after: they differ in time alone.
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
  uint32_t queries = QUERY_HIERARCHY; /* the structure that queries between its steps walk: its own where it has one,
                                         QUERY_ of body_codes.h */
};

/* In the order of the enum; all but automatic, the last, launch kernels. */
std::span<const BroadphaseRow> broadphase_rows();
std::span<const BroadphaseRow> broadphases(); /* without automatic */
const BroadphaseRow &row_of(Broadphase broadphase);

/* What is kept from the last launch no longer holds. */
void forget_kept(Memory &memory);

/* Each in the file of its kind. */
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

/* What several of them share: where the small bodies are, for the grid, the axis of the sweep and the frame of the
 * curve. */
void find_extent(StepLaunches &step, bool hybrid = false);
/* The small bodies, sorted by cells of their own extent: for the grid, and for queries. */
void sort_into_cells(StepLaunches &step, bool bitonic = false);
/* Sorts as many keys of pairs as the entry of counts says. */
void sort_pair_keys(StepLaunches &step, Buffer keys, Buffer other_keys, uint32_t length, uint32_t capacity);
/* The list from pair_key, in any order. */
void pairs_from_keys(StepLaunches &step);
/* The hierarchy of boxes over all bounds: for the broadphase, and for queries. keep: whether its order may be, and
 * becomes, a kept one. */
void build_hierarchy(StepLaunches &step, bool keep);
/* The order and the links of its leaves, once they are sorted, and the boxes of its nodes. boxes: those that it is of;
 * the ranges of the leaves and of the nodes are entries of counts. */
void link_leaves(StepLaunches &step, Buffer boxes);
void raise_boxes(StepLaunches &step, Buffer boxes, uint32_t leaves = COUNT_LEAVES, uint32_t nodes = COUNT_HIERARCHY);

} // namespace tandem
