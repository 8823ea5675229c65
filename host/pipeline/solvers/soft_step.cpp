/* soft_step.cpp - the default solver: small substeps, each solved softly, moved, and relaxed; see
 * shared/solve/contact.h. */
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

void solve(StepLaunches &step, MassSplit &tail, uint32_t pass)
{
  step.for_each_color(Kernel::solve_contacts, {pass});
  tail.solve(pass, tail_iterations);
  solve_rolling(step);
}

/* The first substep starts from the impulses that the last step's contacts carried, and is solved once more for that:
 * it takes a quarter off the penetration of a pile, at an eighth of what another substep costs (docs/departures.md). */
uint32_t passes_of(const StepLaunches &step, const MassSplit &tail, uint32_t substep)
{
  return (step.settings().iterations + (substep == 0 ? 1 : 0)) * tail.turns();
}

/* Later substeps find the impulses of the colours in solver_push; the tail adds its own each time. */
void launch_soft_step_substep(StepLaunches &step, MassSplit &tail, uint32_t substep)
{
  step.begin_substep(substep);
  if (substep == 0) step.for_each_color(Kernel::warm_start);
  tail.warm_start();
  warm_start_rolling(step);
  for (uint32_t turn = 0; turn < passes_of(step, tail, substep); ++turn) solve(step, tail, PASS_BIASED);
  step.run(Kernel::integrate_positions);
  solve(step, tail, substep + 1 < step.settings().substeps ? PASS_RELAXING : PASS_LAST);
}

} // namespace

void launch_soft_step(StepLaunches &step)
{
  MassSplit tail = MassSplit::tail_of(step);
  tail.prepare();
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep)
    launch_soft_step_substep(step, tail, substep);
  apply_restitution(step, tail);
}

} // namespace tandem
