/* joints.cpp - see joints.h. */
#include "host/pipeline/solvers/joints.h"

namespace tandem {
namespace {

void solve_couplings(StepLaunches &step, uint32_t pass, bool further)
{
  if (!step.has(FEATURE_COUPLINGS)) return;
  step.for_each_coupling_color(further ? Kernel::solve_couplings_further : Kernel::solve_couplings, {pass});
  if (step.has(FEATURE_WORLDS)) step.run_overflow_couplings(Kernel::solve_overflow_couplings_by_world, {pass, further});
  else step.run_overflow_couplings(Kernel::solve_overflow_couplings, {pass});
}

/* Joints past the last colour, then couplings. */
void solve_rest(StepLaunches &step, uint32_t pass, bool further)
{
  if (step.has(FEATURE_WORLDS)) step.run_overflow_joints(Kernel::solve_overflow_joints_by_world, {pass, further});
  else step.run_overflow_joints(Kernel::solve_overflow_joints, {pass});
  solve_couplings(step, pass, further);
}

} // namespace

void begin_joints(StepLaunches &step)
{
  if (step.has(FEATURE_JOINT_BOUNCES)) step.run(Kernel::follow_limits, {1});
}

void warm_start_with_joints(StepLaunches &step)
{
  step.for_each_color_with_joints(Kernel::warm_start_joints, {}, Kernel::warm_start, {});
  step.run_overflow_joints(step.has(FEATURE_WORLDS) ? Kernel::warm_start_overflow_joints_by_world
                                                    : Kernel::warm_start_overflow_joints);
  warm_start_couplings(step);
}

void warm_start_couplings(StepLaunches &step)
{
  if (!step.has(FEATURE_COUPLINGS)) return;
  step.for_each_coupling_color(Kernel::warm_start_couplings);
  step.run_overflow_couplings(Kernel::warm_start_overflow_couplings);
}

void clear_joint_impulses(StepLaunches &step)
{
  if (step.has(FEATURE_JOINTS)) step.run(Kernel::clear_joints);
  if (step.has(FEATURE_COUPLINGS)) step.run(Kernel::clear_couplings);
}

void solve_with_joints(StepLaunches &step, Kernel constraints, uint32_t pass, uint32_t value, bool further)
{
  step.for_each_color_with_joints(further ? Kernel::solve_joints_further : Kernel::solve_joints, {pass}, constraints,
                                  {value});
  solve_rest(step, pass, further);
}

void solve_joints(StepLaunches &step, uint32_t pass)
{
  step.for_each_joint_color(Kernel::solve_joints, {pass});
  solve_rest(step, pass, false);
}

void solve_couplings(StepLaunches &step, uint32_t pass) { solve_couplings(step, pass, false); }

void follow_joints(StepLaunches &step, uint32_t substep)
{
  const bool last = substep + 1 == step.substeps();
  if (step.has(FEATURE_JOINT_BOUNCES)) step.run(Kernel::follow_limits, {0});
  if (step.has(FEATURE_JOINT_BREAKS)) step.run(Kernel::measure_joint_loads, {substep, last});
}

void bounce_joints(StepLaunches &step)
{
  if (!step.has(FEATURE_JOINT_BOUNCES)) return;
  step.for_each_joint_color(Kernel::bounce_at_limits);
  if (step.plan().joint_colors > COLOR_LIMIT) step.run(Kernel::bounce_at_overflow_limits);
}

} // namespace tandem
