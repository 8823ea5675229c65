/* direct.cpp - the solver `direct`: the soft step, with each small island solved to convergence after every pass.
 *
 * The iterative pass runs over all constraints. Large islands keep its result; for small ones it is the first guess,
 * which solve_islands (host/pipeline/solvers/islands.h) then improves to the solution in double on the CPU. */
#include "host/pipeline/solvers/islands.h"
#include "host/pipeline/solvers/joints.h"
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

void launch_pass(StepLaunches &step, MassSplit &overflow, uint32_t pass)
{
  solve_with_joints(step, Kernel::solve_contacts, pass, pass);
  overflow.solve(pass, overflow_iterations);
}

void launch_direct_substep(StepLaunches &step, MassSplit &overflow, uint32_t substep)
{
  step.begin_substep(substep);
  warm_start_contacts(step, overflow);
  for (uint32_t iteration = 0; iteration < step.settings().iterations * overflow.turns(); ++iteration)
    launch_pass(step, overflow, PASS_BIASED);
  step.run(Kernel::solve_islands, {PASS_BIASED});
  solve_rolling(step);
  step.move_bodies();
  launch_pass(step, overflow, PASS_LAST);
  step.run(Kernel::solve_islands, {PASS_LAST});
  solve_rolling(step);
  follow_joints(step, substep);
}

} // namespace

void launch_direct(StepLaunches &step)
{
  MassSplit overflow = MassSplit::overflow_of(step);
  overflow.prepare();
  begin_joints(step);
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep)
    launch_direct_substep(step, overflow, substep);
  apply_restitution(step, overflow);
  if (step.has(FEATURE_RESTITUTION)) step.run(Kernel::solve_islands, {PASS_BOUNCING});
  bounce_joints(step);
}

} // namespace tandem
