/* batch.h - runs many cases with many solvers, several at once, and hands over their results in one fixed order.
 *
 *   threads   |--case 7, a--|--case 2, b--|-- ...       the longest, as far as can be told, begin first
 *             |--case 9, c------------------| ...
 *   results   1a 1b 1c 2a 2b ...                         the same whatever finishes first
 *
 * Every run is a World of its own and has equal bits by construction, so that they may share the machine, TBB's threads
 * included: each world's tasks stay in its own arena.
 */
#pragma once

#include "tools/stability/results.h"

namespace tandem::stability {

struct Batch {
  std::vector<const Case *> cases;
  std::vector<std::string> solvers;
  Placement placement;
  Length length = Length::full;
  size_t at_once = 1;
};

/* `after_each` is called when a run ends, one call at a time, with all that have ended. A progress bar counts steps. */
Results run_batch(const Batch &batch, const std::function<void(const Results &so_far)> &after_each);

} // namespace tandem::stability
