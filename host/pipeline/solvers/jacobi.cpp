/* jacobi.cpp - the solver `jacobi`: all constraints at once, on bodies split into parts; see shared/solve/mass_split.h.
 *
 * It has the substeps of the soft step, with iterations in place of colours: two launches an iteration, however many
 * colours the scene would need. */
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {

void launch_jacobi(StepLaunches &step)
{
  const uint32_t iterations = step.settings().iterations;
  MassSplit contacts = MassSplit::all_of(step);
  contacts.prepare();
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) {
    step.begin_substep(substep);
    contacts.warm_start();
    warm_start_rolling(step);
    contacts.solve(PASS_BIASED, iterations);
    solve_rolling(step);
    step.move_bodies();
    contacts.solve(PASS_LAST, iterations);
    solve_rolling(step);
  }
  if (step.has(FEATURE_RESTITUTION)) contacts.apply_restitution();
}

} // namespace tandem
