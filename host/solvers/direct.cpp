/* direct.cpp - the soft step with each small island solved to convergence after every pass of its rows.
 *
 * The iterative rows run over all constraints: they are what large islands get, and the first guess of small ones, which
 * solve_islands (host/solvers/islands.h) then brings to the solution in double on the CPU. */
#include "host/solvers/islands.h"
#include "host/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

void launch_substep(StepLaunches &step)
{
  step.run(Kernel::integrate_velocities);
  step.for_each_color(Kernel::warm_start, Kernel::warm_start_tail);
  warm_start_rolling(step);
  for (uint32_t iteration = 0; iteration < step.settings().iterations; ++iteration)
    step.for_each_color(Kernel::solve_contacts, Kernel::solve_tail, {PASS_BIASED});
  step.run(Kernel::solve_islands, {island_pass_biased});
  solve_rolling(step);
  step.run(Kernel::integrate_positions);
  step.for_each_color(Kernel::solve_contacts, Kernel::solve_tail, {PASS_LAST});
  step.run(Kernel::solve_islands, {island_pass_relaxing});
  solve_rolling(step);
}

} // namespace

void launch_direct(StepLaunches &step)
{
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_substep(step);
  if (!step.has(FEATURE_RESTITUTION)) return;
  step.for_each_color(Kernel::apply_restitution, Kernel::apply_restitution_tail);
  step.run(Kernel::solve_islands, {island_pass_bouncing});
}

} // namespace tandem
