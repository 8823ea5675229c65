/* soft_step.cpp - the default solver: small substeps, each solved softly, moved, and relaxed; see shared/solve/contact.h. */
#include "host/solvers/solvers.h"

namespace tandem {
namespace {

constexpr uint32_t biased = 1, relaxing = 0;

void launch_substep(StepLaunches &step)
{
  step.run(Kernel::integrate_velocities);
  step.for_each_color(Kernel::warm_start, Kernel::warm_start_tail);
  for (uint32_t iteration = 0; iteration < step.settings().iterations; ++iteration)
    step.for_each_color(Kernel::solve_contacts, Kernel::solve_tail, {biased});
  step.run(Kernel::integrate_positions);
  step.for_each_color(Kernel::solve_contacts, Kernel::solve_tail, {relaxing});
}

} // namespace

void launch_soft_step(StepLaunches &step)
{
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_substep(step);
  if (step.has(FEATURE_RESTITUTION)) step.for_each_color(Kernel::apply_restitution, Kernel::apply_restitution_tail);
}

} // namespace tandem
