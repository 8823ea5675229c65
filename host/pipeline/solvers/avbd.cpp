/* avbd.cpp - the solver `avbd`: augmented vertex block descent, with bodies coloured; see shared/solve/avbd.h. */
#include <algorithm>

#include "host/pipeline/body_constraints.h"
#include "host/pipeline/solvers/joints.h"
#include "host/pipeline/solvers/solvers.h"

namespace tandem {
namespace {

void color_bodies(StepLaunches &step)
{
  const uint32_t rounds = step.plan().rounds;
  step.run(Kernel::body_color_begin);
  for (uint32_t round = 0; round < rounds; ++round) step.run(Kernel::body_color_round, {round});
  step.run(Kernel::body_color_keys, {rounds});
  step.sort(Buffer::sort_key, Buffer::sort_value, COUNT_BODIES, step.plan().bodies, 0, 8);
  step.run(Kernel::body_color_starts);
}

/* The number of body colours to launch: those of the last step and one more. Bodies of later colours are solved in
 * order by avbd_rest, with the same result. */
uint32_t body_colors(const StepPlan &plan)
{
  uint32_t colors = 0;
  for (uint32_t color = 0; color < COLOR_LIMIT; ++color)
    if (plan.known[BODY_COLOR_START + color + 1] > plan.known[BODY_COLOR_START + color]) colors = color + 2;
  return colors == 0 ? first_body_colors : std::min(colors, COLOR_LIMIT);
}

void launch_iteration(StepLaunches &step, uint32_t colors)
{
  for (uint32_t color = 0; color < colors; ++color)
    step.run_range(Kernel::avbd_bodies, BODY_COLOR_START + color, BODY_COLOR_START + color + 1);
  step.run(Kernel::avbd_rest, {colors});
  step.run(Kernel::avbd_duals);
  if (step.has(FEATURE_JOINTS)) step.run(Kernel::avbd_joint_duals);
}

void launch_avbd_substep(StepLaunches &step, uint32_t substep, uint32_t colors)
{
  step.begin_substep(substep);
  warm_start_rolling(step);
  step.run(Kernel::avbd_begin);
  if (step.has(FEATURE_JOINTS)) step.run(Kernel::avbd_begin_joints);
  for (uint32_t iteration = 0; iteration < step.settings().iterations; ++iteration) launch_iteration(step, colors);
  step.move_bodies();
  solve_rolling(step);
  follow_joints(step, substep);
}

} // namespace

void launch_avbd(StepLaunches &step)
{
  list_body_constraints(step.launcher(), step.plan(), 0);
  color_bodies(step);
  step.run(Kernel::avbd_prepare);
  if (step.has(FEATURE_JOINTS)) step.run(Kernel::avbd_prepare_joints);
  begin_joints(step);
  const uint32_t colors = body_colors(step.plan());
  for (uint32_t substep = 0; substep < step.settings().substeps; ++substep) launch_avbd_substep(step, substep, colors);
  bounce_at_end(step);
}

void commit_avbd(StepLaunches &step)
{
  step.run(Kernel::clear_cached, {2}, {Buffer::cached_penalty});
  step.run(Kernel::avbd_cache);
  if (step.has(FEATURE_JOINTS)) step.run(Kernel::avbd_cache_joints);
}

} // namespace tandem
