/* mass_split.cpp - the launches of the split bodies' passes; see mass_split.h. */
#include "host/pipeline/solvers/mass_split.h"

#include "host/pipeline/body_constraints.h"
#include "host/pipeline/solvers/joints.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

constexpr uint32_t restitution_rounds = 8;
/* Of contacts alone. Without any, people who fell on one another from 20 m were pressed into the ground by 6 cm;
 * after one by 5 mm, and after two not at all. */
constexpr uint32_t last_iterations = 2;
/* Springs and motors may ask for all of their way in one substep, of which a round on parts of bodies does about
 * half of what a pass over colours does; what is left grows from substep to substep. */
constexpr uint32_t rounds_with_axes = 2;

} // namespace

void MassSplit::prepare()
{
  if (!launched_) return;
  list_body_constraints(step_.launcher(), step_.plan(), first_color_);
  step_.run_range(Kernel::fill, COUNT_ZERO, COUNT_BODIES, {0}, {Buffer::split_static_constraints});
  run_rows(Kernel::split_count_static);
  run_rows(Kernel::split_masses);
  if (has_joints_) split_among_joints();
}

void MassSplit::split_among_joints()
{
  step_.run(Kernel::split_count_static_joints);
  step_.run(Kernel::split_parts_of_joints, {step_.settings().iterations * rounds_of_iteration()});
  run_rows(Kernel::split_masses_with_joints);
}

void MassSplit::warm_start()
{
  if (!launched_) return;
  run_rows(Kernel::split_warm_start);
  if (has_joints_) step_.run(Kernel::split_warm_start_joints);
  join_parts_with_joints();
}

void MassSplit::solve(uint32_t pass, uint32_t iterations)
{
  for (uint32_t iteration = 0; iteration < iterations; ++iteration) iterate(pass, iteration, iterations);
}

/* A pass of one round alone would not let a net of joints come to rest. */
uint32_t MassSplit::rounds_of_iteration() const
{
  if (!has_joints_) return 1;
  return step_.plan().joint_axes > 0 || step_.settings().iterations == 1 ? rounds_with_axes : 1;
}

void MassSplit::iterate(uint32_t pass, uint32_t iteration, uint32_t iterations)
{
  if (!launched_) return;
  const uint32_t rounds = rounds_of_iteration();
  for (uint32_t round = iteration * rounds; round < (iteration + 1) * rounds; ++round)
    solve_round(pass, round + 1 < iterations * rounds ? round : 0);
}

void MassSplit::solve_round(uint32_t pass, uint32_t momentum)
{
  run_rows(Kernel::split_solve, {pass, momentum}, {has_joints_ ? Buffer::split_mass_with_joints : Buffer::split_mass});
  if (has_joints_) step_.run(Kernel::split_solve_joints, {pass, momentum});
  join_parts_with_joints();
}

void MassSplit::end_pass(uint32_t pass)
{
  if (!has_joints_) return;
  for (uint32_t iteration = 0; iteration < last_iterations; ++iteration) {
    run_rows(Kernel::split_solve, {pass, 0}, {Buffer::split_mass});
    join_parts();
  }
}

void MassSplit::apply_restitution()
{
  if (!launched_) return;
  for (uint32_t round = 0; round < restitution_rounds; ++round) {
    run_rows(Kernel::split_restitution);
    join_parts();
  }
}

void MassSplit::run_rows(Kernel kernel, const Values &values, const Slots &slots)
{
  if (first_color_ == COLOR_OVERFLOW) step_.run_overflow(kernel, values, slots);
  else step_.run_range(kernel, COLOR_START + first_color_, COUNT_CONSTRAINTS, values, slots);
}

void MassSplit::sum_long_lists()
{
  for (Kernel kernel : {Kernel::split_sum, Kernel::split_join})
    step_.run_range(kernel, COUNT_ZERO, body_constraint_count(first_color_));
}

/* Overflow constraints exist only if some body has more constraints than there are colours. */
void MassSplit::join_parts()
{
  const bool trees = step_.plan().colors > COLOR_LIMIT;
  if (trees) sum_long_lists();
  step_.run(Kernel::split_apply, {trees ? 1u : 0u});
}

/* A body with more joints than are added directly has overflow joints, too. */
void MassSplit::join_parts_with_joints()
{
  if (!has_joints_) return join_parts();
  const bool trees = step_.plan().colors > COLOR_LIMIT, joint_trees = step_.plan().joint_colors > COLOR_LIMIT;
  if (trees) sum_long_lists();
  if (joint_trees)
    for (Kernel kernel : {Kernel::split_sum_joints, Kernel::split_join_joints}) step_.run(kernel);
  step_.run(Kernel::split_apply_with_joints, {trees ? 1u : 0u, joint_trees ? 1u : 0u});
}

void warm_start_contacts(StepLaunches &step, MassSplit &overflow)
{
  warm_start_with_joints(step);
  overflow.warm_start();
  warm_start_rolling(step);
}

void apply_restitution(StepLaunches &step, MassSplit &overflow)
{
  if (!step.has(FEATURE_RESTITUTION)) return;
  step.for_each_color(Kernel::apply_restitution);
  overflow.apply_restitution();
}

void bounce_at_end(StepLaunches &step)
{
  if (step.has(FEATURE_RESTITUTION)) {
    MassSplit overflow = MassSplit::overflow_of(step);
    overflow.prepare();
    apply_restitution(step, overflow);
  }
  bounce_joints(step);
}

} // namespace tandem
