/* nncg.cpp - conjugate gradients over the sweeps of pgs; see shared/solve/nncg.h. */
#include "host/pipeline/primitives.h"
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

/* Of constraints that have a colour: those of the tail are accelerated in a way of their own
 * (shared/solve/mass_split.h). */
constexpr uint32_t colored = COLOR_START + COLOR_TAIL;

void go_on_along_direction(StepLaunches &step, bool first)
{
  step.run_range(Kernel::nncg_change, COUNT_ZERO, colored);
  reduce_real(step.launcher(), Reduction::sum, Buffer::nncg_square, Buffer::nncg_partial, Buffer::nncg_sum, colored,
              step.plan().capacity_pairs);
  step.run(Kernel::nncg_beta, {first ? 1u : 0u});
  step.for_each_color(Kernel::nncg_advance);
}

/* The last sweep is not followed by a direction, so the impulses end within their cones. */
void launch_sweeps(StepLaunches &step, MassSplit &tail, uint32_t pass)
{
  const uint32_t sweeps = step.settings().iterations;
  if (sweeps > 1) step.run_range(Kernel::nncg_begin, COUNT_ZERO, colored);
  for (uint32_t sweep = 0; sweep < sweeps; ++sweep) {
    launch_pgs_sweep(step, tail, pass);
    if (sweep + 1 < sweeps) go_on_along_direction(step, sweep == 0);
  }
}

void launch_nncg_substep(StepLaunches &step, MassSplit &tail, uint32_t substep)
{
  step.begin_substep(substep);
  warm_start_contacts(step, tail);
  launch_sweeps(step, tail, PASS_BIASED);
  step.run(Kernel::integrate_positions);
  step.run(Kernel::pgs_masses);
  launch_sweeps(step, tail, PASS_LAST);
}

} // namespace

void launch_nncg(StepLaunches &step)
{
  MassSplit tail = MassSplit::tail_of(step);
  tail.prepare();
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_nncg_substep(step, tail, substep);
  apply_restitution(step, tail);
}

} // namespace tandem
