/* broadphase.h - the ways to find bodies whose bounds overlap, one small file each: what `--broadphase NAME` picks.
 *
 * A broadphase finds `bounds` filled. It leaves the pairs that may meet (shared/broadphase/overlap.h) in pair_a and pair_b, sorted
 * by (a, b) with a > b, where those of each body start in pair_start, and COUNT_PAIRS. Every one yields the same list, hence the
 * same bits in all that comes after: they differ in time alone.
 */
#pragma once

#include <span>
#include <string>

#include "host/step_launches.h"

namespace tandem {

struct Broadphase {
  const char *name;
  const char *what; /* for --help and `tandem plan` */
  void (*launch)(StepLaunches &step);
};

std::span<const Broadphase> broadphases(); /* default first */
const Broadphase &broadphase_named(const std::string &name); /* std::logic_error if there is none: settings are validated */

/* Each in the file of its name. */
void find_pairs_by_brute_force(StepLaunches &step);
void find_pairs_in_grid(StepLaunches &step);
void find_pairs_by_sweep(StepLaunches &step);
void find_pairs_by_skipping(StepLaunches &step);
void find_pairs_by_stack(StepLaunches &step);
void find_pairs_by_history(StepLaunches &step);

/* Where the small bodies are: the grid, the axis of the sweep, the frame of the curve. */
void find_extent(StepLaunches &step);

/* The hierarchy of boxes over `bounds`: for the broadphase, and for queries. */
void build_hierarchy(StepLaunches &step);

} // namespace tandem
