/* soft_step.cpp - the default solver: small substeps, each solved softly, moved, and relaxed; see shared/solve/contact.h. */
#include "host/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

void solve(StepLaunches &step, uint32_t pass)
{
  step.for_each_color(Kernel::solve_contacts, Kernel::solve_tail, {pass});
  solve_rolling(step);
}

void launch_substep(StepLaunches &step, uint32_t substep)
{
  step.run(Kernel::integrate_velocities);
  if (substep == 0) step.for_each_color(Kernel::warm_start, Kernel::warm_start_tail);
  warm_start_rolling(step);
  for (uint32_t iteration = 0; iteration < step.settings().iterations; ++iteration) solve(step, PASS_BIASED);
  step.run(Kernel::integrate_positions);
  solve(step, substep + 1 < step.settings().substeps ? PASS_RELAXING : PASS_LAST);
}

} // namespace

void launch_soft_step(StepLaunches &step)
{
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_substep(step, substep);
  if (step.has(FEATURE_RESTITUTION)) step.for_each_color(Kernel::apply_restitution, Kernel::apply_restitution_tail);
}

} // namespace tandem
