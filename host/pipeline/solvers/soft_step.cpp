/* soft_step.cpp - the default solver: small substeps, in each of which soft constraints are solved, bodies moved and
 * the constraints relaxed; see shared/solve/soft_step.h. */
#include "host/pipeline/solvers/joints.h"
#include "host/pipeline/solvers/mass_split.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

/* further: of a batch, only worlds with overflow constraints take part. */
void solve(StepLaunches &step, MassSplit &overflow, uint32_t pass, bool further = false)
{
  solve_with_joints(step, Kernel::solve_contacts, pass, pass, further);
  step.for_each_link_color(further ? uint32_t{PASS_FURTHER} : pass);
  overflow.solve(pass, overflow_iterations);
  solve_rolling(step);
}

/* The first substep starts from the impulses of the last step's contacts and therefore gets one more pass. That reduces
 * the penetration of a pile by a quarter, for an eighth of the cost of another substep (docs/departures.md). */
uint32_t passes_of(const StepLaunches &step, uint32_t substep)
{
  return step.settings().iterations + (substep == 0 ? 1 : 0);
}

/* The further turns of overflow constraints are, of a batch of worlds, those of the worlds that have some. */
void solve_in_turns(StepLaunches &step, MassSplit &overflow, uint32_t passes)
{
  for (uint32_t pass = 0; pass < passes; ++pass) solve(step, overflow, PASS_BIASED);
  const bool in_batch = step.has(FEATURE_WORLDS);
  step.limit_to_worlds_with_overflow(in_batch);
  for (uint32_t pass = passes; pass < passes * overflow.turns(); ++pass) solve(step, overflow, PASS_BIASED, in_batch);
  step.limit_to_worlds_with_overflow(false);
}

/* Later substeps read the impulses of the colours from warm_start_impulse; the overflow constraints apply their own in
 * each substep. */
void launch_soft_step_substep(StepLaunches &step, MassSplit &overflow, uint32_t substep)
{
  if (substep == 0) step.for_each_link_color(PASS_WARM_STARTING); /* to links it is a force */
  step.begin_substep(substep);
  if (substep == 0) warm_start_with_joints(step);
  overflow.warm_start();
  warm_start_rolling(step);
  solve_in_turns(step, overflow, passes_of(step, substep));
  const bool last = substep + 1 == step.substeps();
  if (last && step.balances_trees()) step.run(Kernel::split_tree_balance);
  step.move_bodies();
  solve(step, overflow, last ? PASS_LAST : PASS_RELAXING);
  follow_joints(step, substep);
}

void list_tree_contacts(StepLaunches &step)
{
  if (!step.has_links()) return;
  step.run(Kernel::list_tree_contacts);
  step.run(Kernel::order_tree_contacts, {step.has_worlds_with_overflow()});
}

void launch_soft_step_substeps(StepLaunches &step)
{
  MassSplit overflow = MassSplit::overflow_of(step);
  overflow.prepare();
  list_tree_contacts(step);
  begin_joints(step);
  for (uint32_t substep = 0; substep < step.substeps(); ++substep) launch_soft_step_substep(step, overflow, substep);
  apply_restitution(step, overflow);
  if (step.has(FEATURE_RESTITUTION)) step.for_each_link_color(PASS_BOUNCING);
  step.balance_trees();
  bounce_joints(step);
}

/* The impulses of contacts stay those of one of the many substeps until their events are listed. */
void share_impulses_of_joints(StepLaunches &step, bool back)
{
  if (step.has(FEATURE_JOINTS)) step.run(Kernel::share_joint_impulses, {back});
  if (step.has(FEATURE_COUPLINGS)) step.run(Kernel::share_coupling_impulses, {back});
}

} // namespace

void share_impulses_of_contacts(StepLaunches &step, bool back)
{
  step.run(Kernel::share_contact_impulses, {back});
  if (step.has(FEATURE_ROLLING)) step.run(Kernel::share_rolling_impulses, {back});
}

/* The few are last, because kinematic bodies end where the last pass has them, and far from any load that is where they
 * would be without one. */
void launch_soft_step(StepLaunches &step)
{
  if (!step.plan().islands_apart) return launch_soft_step_substeps(step);
  const bool many = step.plan().classes & MANY_SUBSTEPS, few = step.plan().classes & FEW_SUBSTEPS;
  if (many) {
    share_impulses_of_contacts(step, false);
    share_impulses_of_joints(step, false);
    step.take_class(MANY_SUBSTEPS);
    launch_soft_step_substeps(step);
    share_impulses_of_joints(step, true);
  }
  if (many && few) step.run(Kernel::rewind_kinematics);
  if (few) {
    step.take_class(FEW_SUBSTEPS);
    launch_soft_step_substeps(step);
  }
  step.take_class(EVERY_CLASS);
}

} // namespace tandem
