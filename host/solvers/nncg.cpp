/* nncg.cpp - conjugate gradients over the sweeps of pgs; see shared/solve/nncg.h. */
#include "host/primitives.h"
#include "host/solvers/solvers.h"

namespace tandem {
namespace {

void go_on_along_direction(StepLaunches &step, bool first)
{
  step.run(Kernel::nncg_change);
  reduce_real(step.launcher(), Reduction::sum, Buffer::nncg_square, Buffer::nncg_partial, Buffer::nncg_sum, COUNT_CONSTRAINTS,
              step.plan().capacity_pairs);
  step.run(Kernel::nncg_beta, {first ? 1u : 0u});
  step.for_each_color(Kernel::nncg_advance, Kernel::nncg_advance_tail);
}

/* The last sweep is not followed by a direction, so the impulses end within their cones. */
void launch_sweeps(StepLaunches &step, bool biased)
{
  const uint32_t sweeps = step.settings().iterations;
  if (sweeps > 1) step.run(Kernel::nncg_begin);
  for (uint32_t sweep = 0; sweep < sweeps; ++sweep) {
    launch_pgs_sweep(step, biased);
    if (sweep + 1 < sweeps) go_on_along_direction(step, sweep == 0);
  }
}

void launch_substep(StepLaunches &step)
{
  step.run(Kernel::integrate_velocities);
  step.for_each_color(Kernel::warm_start, Kernel::warm_start_tail);
  warm_start_rolling(step);
  launch_sweeps(step, true);
  step.run(Kernel::integrate_positions);
  step.run(Kernel::pgs_masses);
  launch_sweeps(step, false);
}

} // namespace

void launch_nncg(StepLaunches &step)
{
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_substep(step);
  if (step.has(FEATURE_RESTITUTION)) step.for_each_color(Kernel::apply_restitution, Kernel::apply_restitution_tail);
}

} // namespace tandem
