/* equal_error.h - compares solvers at the same error: for a few round levels the cheapest setting of each solver on
 * each backend.
 *
 *   error |  .a  .b                 level 10 mm:  a 0.1 ms, b 0.2 ms
 *         |---\---\-------- 10 mm   level  1 mm:  a -       b 0.8 ms
 *         |    `.  \                a solver whose curve does not cross a level does not reach that error
 *         |---------\------  1 mm
 *         +-------------- ms
 */
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/report/experiment.h"

namespace tandem {

struct EqualError {
  double error; /* at most */
  std::string solver;
  std::vector<std::optional<size_t>>
      runs; /* for each backend the cheapest, as an index into its runs; nothing where none keeps the error */
};

/* Levels are powers of ten from the coarsest error on the common front to the finest, none finer than `finest`; of more
 * than five, five are chosen evenly. `by_backend` holds the runs of each backend. The rows are ordered by level, then
 * by solver in the order of first occurrence. */
std::vector<EqualError> equal_errors(const std::vector<std::vector<Run>> &by_backend, Metric metric, double finest);

} // namespace tandem
