/* jacobi.cpp - the solver `jacobi`: all constraints at once, on bodies split into parts; see shared/solve/mass_split.h.
 *
 * It has the substeps of the soft step, with iterations in place of colours: two launches an iteration, and one more
 * where there are joints (shared/joints/mass_split.h), however many colours the scene would need. */
#include "host/pipeline/solvers/joints.h"
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

/* Couplings are solved by their colours, after the joints and contacts of each iteration. */
void launch_iterations(StepLaunches &step, MassSplit &rows, uint32_t pass)
{
  const uint32_t iterations = step.settings().iterations;
  for (uint32_t iteration = 0; iteration < iterations; ++iteration) {
    rows.iterate(pass, iteration, iterations);
    solve_couplings(step, pass);
  }
  rows.end_pass(pass);
  solve_rolling(step);
}

void launch_jacobi_substep(StepLaunches &step, MassSplit &rows, uint32_t substep)
{
  step.begin_substep(substep);
  rows.warm_start();
  warm_start_couplings(step);
  warm_start_rolling(step);
  launch_iterations(step, rows, PASS_BIASED);
  step.move_bodies();
  launch_iterations(step, rows, PASS_LAST);
  follow_joints(step, substep);
}

} // namespace

void launch_jacobi(StepLaunches &step)
{
  MassSplit rows = MassSplit::all_of(step);
  rows.prepare();
  begin_joints(step);
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_jacobi_substep(step, rows, substep);
  if (step.has(FEATURE_RESTITUTION)) rows.apply_restitution();
  bounce_joints(step);
}

} // namespace tandem
