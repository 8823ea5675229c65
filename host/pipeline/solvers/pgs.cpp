/* pgs.cpp - the solver `pgs`: projected Gauss-Seidel, with rows in the order of the talks; see shared/solve/pgs.h. */
#include "host/pipeline/solvers/joints.h"
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

void launch_pgs_substep(StepLaunches &step, MassSplit &overflow, uint32_t substep)
{
  const uint32_t iterations = step.settings().iterations;
  step.begin_substep(substep);
  warm_start_contacts(step, overflow);
  for (uint32_t iteration = 0; iteration < iterations; ++iteration) launch_pgs_pass(step, overflow, PASS_BIASED);
  step.move_bodies();
  step.run(Kernel::pgs_masses);
  for (uint32_t iteration = 0; iteration < iterations; ++iteration) launch_pgs_pass(step, overflow, PASS_LAST);
  follow_joints(step, substep);
}

} // namespace

void launch_pgs_pass(StepLaunches &step, MassSplit &overflow, uint32_t pass)
{
  for (uint32_t turn = 0; turn < overflow.turns(); ++turn) {
    solve_with_joints(step, Kernel::pgs_normals, pass, pass);
    if (step.has(FEATURE_FRICTION)) step.for_each_color(Kernel::pgs_friction);
    overflow.solve(pass, overflow_iterations);
  }
  solve_rolling(step);
}

void launch_pgs(StepLaunches &step)
{
  MassSplit overflow = MassSplit::overflow_of(step);
  overflow.prepare();
  begin_joints(step);
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_pgs_substep(step, overflow, substep);
  apply_restitution(step, overflow);
  bounce_joints(step);
}

} // namespace tandem
