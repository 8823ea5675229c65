/* pgs.cpp - projected Gauss-Seidel, rows in the order of the talks; see shared/solve/pgs.h. */
#include "host/solvers/solvers.h"

namespace tandem {
namespace {

void launch_substep(StepLaunches &step)
{
  step.run(Kernel::integrate_velocities);
  step.for_each_color(Kernel::warm_start, Kernel::warm_start_tail);
  warm_start_rolling(step);
  for (uint32_t iteration = 0; iteration < step.settings().iterations; ++iteration) launch_pgs_sweep(step, true);
  step.run(Kernel::integrate_positions);
  step.run(Kernel::pgs_masses);
  for (uint32_t iteration = 0; iteration < step.settings().iterations; ++iteration) launch_pgs_sweep(step, false);
}

} // namespace

void launch_pgs_sweep(StepLaunches &step, bool biased)
{
  step.for_each_color(Kernel::pgs_normals, Kernel::pgs_normals_tail, {biased ? 1u : 0u});
  if (step.has(FEATURE_FRICTION)) step.for_each_color(Kernel::pgs_friction, Kernel::pgs_friction_tail);
  solve_rolling(step);
}

void launch_pgs(StepLaunches &step)
{
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_substep(step);
  if (step.has(FEATURE_RESTITUTION)) step.for_each_color(Kernel::apply_restitution, Kernel::apply_restitution_tail);
}

} // namespace tandem
