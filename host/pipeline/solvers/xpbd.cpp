/* xpbd.cpp - the solver `xpbd`: positions first, then velocities, in small substeps; see shared/solve/xpbd.h. */
#include "host/pipeline/solvers/joints.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

/* One velocity pass removes the velocity that the position correction added, except a share M / (M + m) of it if a mass
 * m carries M. The rest moves the bodies and is corrected in the next substep: 200 kg of boxes on a slab of 20 kg
 * trembled with 0.4 J forever. Eight passes bring 450 kg on 20 kg to rest. A body with more contacts than there are
 * colours is assumed to carry such a load; other scenes keep the one pass of the paper. */
uint32_t velocity_passes(const StepLaunches &step) { return step.plan().colors > COLOR_LIMIT ? 8 : 1; }

void launch_xpbd_substep(StepLaunches &step, uint32_t substep)
{
  step.begin_substep(substep);
  warm_start_rolling(step);
  clear_joint_impulses(step);
  for (uint32_t iteration = 0; iteration < step.settings().iterations; ++iteration) {
    solve_with_joints(step, Kernel::xpbd_positions, PASS_BIASED, iteration == 0);
    if (step.plan().colors > COLOR_LIMIT) step.run(Kernel::xpbd_positions_overflow, {iteration == 0});
  }
  step.move_bodies();
  for (uint32_t iteration = 0; iteration < step.settings().iterations; ++iteration) solve_joints(step, PASS_LAST);
  for (uint32_t pass = 0; pass < velocity_passes(step); ++pass)
    step.for_each_color(Kernel::xpbd_velocities, Kernel::xpbd_velocities_overflow);
  solve_rolling(step);
  follow_joints(step, substep);
}

} // namespace

void launch_xpbd(StepLaunches &step)
{
  if (step.has(FEATURE_FRICTION)) step.run(Kernel::xpbd_prepare);
  begin_joints(step);
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_xpbd_substep(step, substep);
  bounce_at_end(step);
}

void commit_xpbd(StepLaunches &step)
{
  if (!step.has(FEATURE_FRICTION)) return;
  step.run(Kernel::clear_cached, {1}, {Buffer::cached_slip});
  step.run(Kernel::xpbd_cache);
}

} // namespace tandem
