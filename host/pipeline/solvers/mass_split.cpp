/* mass_split.cpp - the launches of the split bodies' passes; see mass_split.h. */
#include "host/pipeline/solvers/mass_split.h"

#include "host/pipeline/body_constraints.h"
#include "host/pipeline/solvers/joints.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/solve/pass.h"

namespace tandem {
namespace {

constexpr uint32_t restitution_rounds = 8;

} // namespace

void MassSplit::prepare()
{
  if (!launched_) return;
  list_body_constraints(step_.launcher(), step_.plan(), first_color_);
  step_.run_range(Kernel::fill, COUNT_ZERO, COUNT_BODIES, {0}, {Buffer::split_static_constraints});
  run_rows(Kernel::split_count_static);
  run_rows(Kernel::split_masses);
}

void MassSplit::warm_start()
{
  if (!launched_) return;
  run_rows(Kernel::split_warm_start);
  join_parts();
}

void MassSplit::solve(uint32_t pass, uint32_t iterations)
{
  for (uint32_t iteration = 0; iteration < iterations; ++iteration) iterate(pass, iteration, iterations);
}

void MassSplit::iterate(uint32_t pass, uint32_t iteration, uint32_t iterations)
{
  if (!launched_) return;
  run_rows(Kernel::split_solve, {pass, iteration + 1 < iterations ? iteration : 0});
  join_parts();
}

void MassSplit::apply_restitution()
{
  if (!launched_) return;
  for (uint32_t round = 0; round < restitution_rounds; ++round) {
    run_rows(Kernel::split_restitution);
    join_parts();
  }
}

void MassSplit::run_rows(Kernel kernel, const Values &values)
{
  step_.run_range(kernel, COLOR_START + first_color_, COUNT_CONSTRAINTS, values);
}

/* Overflow constraints exist only if some body has more constraints than there are colours. */
void MassSplit::join_parts()
{
  const bool trees = step_.plan().colors > COLOR_LIMIT;
  if (trees)
    for (Kernel kernel : {Kernel::split_sum, Kernel::split_join})
      step_.run_range(kernel, COUNT_ZERO, body_constraint_count(first_color_));
  step_.run(Kernel::split_apply, {trees ? 1u : 0u});
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
