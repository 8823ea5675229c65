/* pgs.cpp - projected Gauss-Seidel, rows in the order of the talks; see shared/solve/pgs.h. */
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

void launch_pgs_substep(StepLaunches &step, MassSplit &tail, uint32_t substep)
{
  const uint32_t sweeps = step.settings().iterations;
  step.begin_substep(substep);
  warm_start_contacts(step, tail);
  for (uint32_t sweep = 0; sweep < sweeps; ++sweep) launch_pgs_sweep(step, tail, PASS_BIASED);
  step.run(Kernel::integrate_positions);
  step.run(Kernel::pgs_masses);
  for (uint32_t sweep = 0; sweep < sweeps; ++sweep) launch_pgs_sweep(step, tail, PASS_LAST);
}

} // namespace

void launch_pgs_sweep(StepLaunches &step, MassSplit &tail, uint32_t pass)
{
  for (uint32_t turn = 0; turn < tail.turns(); ++turn) {
    step.for_each_color(Kernel::pgs_normals, {pass});
    if (step.has(FEATURE_FRICTION)) step.for_each_color(Kernel::pgs_friction);
    tail.solve(pass, tail_iterations);
  }
  solve_rolling(step);
}

void launch_pgs(StepLaunches &step)
{
  MassSplit tail = MassSplit::tail_of(step);
  tail.prepare();
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_pgs_substep(step, tail, substep);
  apply_restitution(step, tail);
}

} // namespace tandem
