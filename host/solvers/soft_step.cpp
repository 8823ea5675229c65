/* soft_step.cpp - the default solver: small substeps, each solved softly, moved, and relaxed; see shared/solve/contact.h. */
#include "host/solvers/mass_split.h"
#include "host/solvers/solvers.h"

namespace tandem {
namespace {

constexpr uint32_t biased = 1, relaxing = 0;

void solve(StepLaunches &step, MassSplit &tail, uint32_t bias)
{
  step.for_each_color(Kernel::solve_contacts, {bias});
  tail.solve(bias, tail_iterations);
}

void launch_substep(StepLaunches &step, MassSplit &tail)
{
  step.run(Kernel::integrate_velocities);
  step.for_each_color(Kernel::warm_start);
  tail.warm_start();
  for (uint32_t iteration = 0; iteration < step.settings().iterations; ++iteration) solve(step, tail, biased);
  step.run(Kernel::integrate_positions);
  solve(step, tail, relaxing);
}

} // namespace

void launch_soft_step(StepLaunches &step)
{
  MassSplit tail = MassSplit::tail_of(step);
  tail.prepare();
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_substep(step, tail);
  if (!step.has(FEATURE_RESTITUTION)) return;
  step.for_each_color(Kernel::apply_restitution);
  tail.apply_restitution();
}

} // namespace tandem
