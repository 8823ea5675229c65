/* rolling.cpp - rolling and spinning friction for any solver, as rows that follow the solver's own; see
 * shared/solve/rolling.h. */
#include "host/pipeline/solvers/solvers.h"

namespace tandem {

void warm_start_rolling(StepLaunches &step)
{
  if (step.has(FEATURE_ROLLING)) step.for_each_color(Kernel::warm_start_rolling, Kernel::warm_start_rolling_overflow);
}

void solve_rolling(StepLaunches &step)
{
  if (step.has(FEATURE_ROLLING)) step.for_each_color(Kernel::solve_rolling, Kernel::solve_rolling_overflow);
}

} // namespace tandem
