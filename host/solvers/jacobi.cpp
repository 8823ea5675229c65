/* jacobi.cpp - all constraints at once, on bodies split into parts; see shared/solve/mass_split.h.
 *
 * The substeps of the soft step, with iterations in place of colours: two launches an iteration, however many colours the
 * scene would take. */
#include "host/solvers/mass_split.h"
#include "host/solvers/solvers.h"

namespace tandem {
namespace {

constexpr uint32_t biased = 1, relaxing = 0;

} // namespace

void launch_jacobi(StepLaunches &step)
{
  const uint32_t iterations = step.settings().iterations;
  MassSplit contacts = MassSplit::all_of(step);
  contacts.prepare();
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) {
    step.run(Kernel::integrate_velocities);
    contacts.warm_start();
    contacts.solve(biased, iterations);
    step.run(Kernel::integrate_positions);
    contacts.solve(relaxing, iterations);
  }
  if (step.has(FEATURE_RESTITUTION)) contacts.apply_restitution();
}

} // namespace tandem
