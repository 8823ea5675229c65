/* batch.h - runs many cases with many solvers, several at once, and returns their results in a fixed order.
 *
 *   threads   |--case 7, a--|--case 2, b--|-- ...       the runs that are expected to be the longest begin first
 *             |--case 9, c------------------| ...
 *   results   1a 1b 1c 2a 2b ...                         the order does not depend on which run ends first
 *
 * Every run is a World of its own and has equal bits by construction, so runs may share the machine, including TBB's
 * threads: each world's tasks stay in an arena of its own.
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

/* `after_each` is called when a run ends, one call at a time, with all results so far. A progress bar counts steps. */
Results run_batch(const Batch &batch, const std::function<void(const Results &so_far)> &after_each);

} // namespace tandem::stability
