/* soft_step.cpp - the default solver: small substeps, each solved softly, moved, and relaxed; see
 * shared/solve/contact.h. */
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

void solve(StepLaunches &step, MassSplit &overflow, uint32_t pass)
{
  step.for_each_color(Kernel::solve_contacts, {pass});
  overflow.solve(pass, overflow_iterations);
  solve_rolling(step);
}

/* The first substep starts from the impulses that the last step's contacts carried, and is solved once more for that:
 * it takes a quarter off the penetration of a pile, at an eighth of what another substep costs (docs/departures.md). */
uint32_t passes_of(const StepLaunches &step, const MassSplit &overflow, uint32_t substep)
{
  return (step.settings().iterations + (substep == 0 ? 1 : 0)) * overflow.turns();
}

/* Later substeps find the impulses of the colours in warm_start_impulse; the overflow constraints add their own each
 * time. */
void launch_soft_step_substep(StepLaunches &step, MassSplit &overflow, uint32_t substep)
{
  step.begin_substep(substep);
  if (substep == 0) step.for_each_color(Kernel::warm_start);
  overflow.warm_start();
  warm_start_rolling(step);
  for (uint32_t turn = 0; turn < passes_of(step, overflow, substep); ++turn) solve(step, overflow, PASS_BIASED);
  step.run(Kernel::integrate_positions);
  solve(step, overflow, substep + 1 < step.settings().substeps ? PASS_RELAXING : PASS_LAST);
}

} // namespace

void launch_soft_step(StepLaunches &step)
{
  MassSplit overflow = MassSplit::overflow_of(step);
  overflow.prepare();
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep)
    launch_soft_step_substep(step, overflow, substep);
  apply_restitution(step, overflow);
}

} // namespace tandem
