/* nncg.cpp - the solver `nncg`: conjugate gradients over the passes of pgs; see shared/solve/nncg.h. */
#include "host/pipeline/primitives.h"
#include "host/pipeline/solvers/joints.h"
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

/* The end of the constraints that have a colour; overflow constraints have an acceleration of their own
 * (shared/solve/mass_split.h). */
constexpr uint32_t colored = COLOR_START + COLOR_OVERFLOW;

void measure_change_of_joints(StepLaunches &step)
{
  step.run(Kernel::nncg_change_joints);
  reduce_real(step.launcher(), Reduction::sum, Buffer::nncg_joint_square, Buffer::nncg_joint_partial,
              Buffer::nncg_joint_sum, COUNT_JOINTS, step.plan().known[COUNT_JOINTS]);
}

void begin_direction(StepLaunches &step)
{
  step.run_range(Kernel::nncg_begin, COUNT_ZERO, colored);
  if (step.has(FEATURE_JOINTS)) step.run(Kernel::nncg_begin_joints);
}

void go_on_along_direction(StepLaunches &step, bool first)
{
  step.run_range(Kernel::nncg_change, COUNT_ZERO, colored);
  reduce_real(step.launcher(), Reduction::sum, Buffer::nncg_square, Buffer::nncg_partial, Buffer::nncg_sum, colored,
              step.plan().capacity_pairs);
  if (step.has(FEATURE_JOINTS)) measure_change_of_joints(step);
  step.run(Kernel::nncg_beta, {first ? 1u : 0u});
  step.for_each_color(Kernel::nncg_advance);
  step.for_each_joint_color(Kernel::nncg_advance_joints);
  step.run_overflow_joints(Kernel::nncg_advance_overflow_joints);
}

/* No direction step follows the last pass, so the impulses end within their cones. */
void launch_passes(StepLaunches &step, MassSplit &overflow, uint32_t pass)
{
  const uint32_t iterations = step.settings().iterations;
  if (iterations > 1) begin_direction(step);
  for (uint32_t iteration = 0; iteration < iterations; ++iteration) {
    launch_pgs_pass(step, overflow, pass);
    if (iteration + 1 < iterations) go_on_along_direction(step, iteration == 0);
  }
}

void launch_nncg_substep(StepLaunches &step, MassSplit &overflow, uint32_t substep)
{
  step.begin_substep(substep);
  warm_start_contacts(step, overflow);
  launch_passes(step, overflow, PASS_BIASED);
  step.move_bodies();
  step.run(Kernel::pgs_masses);
  launch_passes(step, overflow, PASS_LAST);
  follow_joints(step, substep);
}

} // namespace

void launch_nncg(StepLaunches &step)
{
  MassSplit overflow = MassSplit::overflow_of(step);
  overflow.prepare();
  begin_joints(step);
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep)
    launch_nncg_substep(step, overflow, substep);
  apply_restitution(step, overflow);
  bounce_joints(step);
}

} // namespace tandem
