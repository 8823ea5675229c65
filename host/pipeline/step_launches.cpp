/* step_launches.cpp - sizes launches from what the host knows of the counts; see step_launches.h. */
#include "host/pipeline/step_launches.h"

#include <stdexcept>
#include <string>

#include "host/pipeline/primitives.h"
#include "host/pipeline/scene_counts.h"
#include "shared/broadphase/sweep_limits.h"
#include "shared/midphase/pair_groups.h"
#include "shared/solve/pass.h"

namespace tandem {

void StepLaunches::run(Kernel kernel, const Values &values, const Slots &slots)
{
  const KernelRow &row = row_of(kernel);
  if (row.execution == Execution::group && !is_told_by_scene(row.items))
    throw std::logic_error(std::string(row.name) + " is launched for as many groups as the last step had");
  run_range(kernel, COUNT_ZERO, row.items, values, slots);
}

void StepLaunches::run_range(Kernel kernel, uint32_t first, uint32_t last, const Values &values, const Slots &slots)
{
  const uint32_t end = std::max(plan_.known[first], plan_.known[last]); /* a commit may not have been planned */
  launcher_.launch({kernel, slots, values, first, last, end - plan_.known[first]});
}

void StepLaunches::run_at_most(Kernel kernel, uint32_t most, const Values &values, const Slots &slots)
{
  launcher_.launch({kernel, slots, values, COUNT_ZERO, row_of(kernel).items, most});
}

void StepLaunches::run_pairs(Kernel kernel, uint32_t pair_kind, const Values &values, uint32_t branch)
{
  run_pairs(kernel, pair_kind, pair_kind, values, branch);
}

void StepLaunches::run_pairs(Kernel kernel, uint32_t first_kind, uint32_t last_kind, const Values &values,
                             uint32_t branch)
{
  const bool listed = has(FEATURE_PAIR_KINDS);
  const uint32_t first = listed ? KIND_START + first_kind : uint32_t{COUNT_ZERO};
  const uint32_t last = listed ? KIND_START + last_kind + 1 : uint32_t{COUNT_PAIRS};
  const uint32_t expected = row_of(kernel).execution == Execution::group
                                ? pair_group_items(plan_.capacity_pairs, FOLLOW_PAIRS)
                                : plan_.known[last] - plan_.known[first];
  launcher_.launch({kernel, {}, values, first, last, expected, branch});
}

/* A contact of a link is solved by solve_tree_contacts or for_each_link_color. */
void StepLaunches::launch_color(Kernel kernel, uint32_t color, const Values &values)
{
  if (substep_class_ != EVERY_CLASS)
    return launch_contacts(kernel, COLOR_START + color, MANY_COLOR_START + color, COLOR_START + color + 1, values);
  if (has_links() && plan_.links_alone) return;
  const uint32_t first = COLOR_START + color, begins = limited_ ? WORLD_COLOR_START + color : first;
  const uint32_t end = has_links() ? LINK_COLOR_START + color : first + 1;
  launcher_.launch({kernel, {}, values, begins, end, plan_.known[end] - plan_.known[first]});
}

/* Of contacts, those of many substeps from `middle` on. What is known may be of a step that parted none. */
void StepLaunches::launch_contacts(Kernel kernel, uint32_t first, uint32_t middle, uint32_t end, const Values &values,
                                   const Slots &slots)
{
  const uint32_t all = plan_.known[end] - plan_.known[first];
  if (substep_class_ == MANY_SUBSTEPS) first = middle;
  else if (substep_class_ == FEW_SUBSTEPS) end = middle;
  launcher_.launch({kernel, slots, values, first, end, std::min(all, plan_.known[end] - plan_.known[first])});
}

void StepLaunches::run_overflow(Kernel kernel, const Values &values, const Slots &slots)
{
  launch_contacts(kernel, COLOR_START + COLOR_OVERFLOW, MANY_COLOR_START + COLOR_OVERFLOW, COUNT_CONSTRAINTS, values,
                  slots);
}

void StepLaunches::run_contacts(Kernel kernel, const Values &values)
{
  if (substep_class_ == EVERY_CLASS) return run(kernel, values);
  for_each_color(kernel, values);
  if (plan_.colors > COLOR_LIMIT) run_overflow(kernel, values);
}

void StepLaunches::take_class(uint32_t substep_class)
{
  substep_class_ = substep_class;
  run(Kernel::take_parameters, {substep_class});
}

void StepLaunches::for_each_color(Kernel kernel, const Values &values)
{
  for (uint32_t color = 0; color < std::min(plan_.colors, COLOR_LIMIT); ++color) launch_color(kernel, color, values);
}

void StepLaunches::for_each_color_with_joints(Kernel joints, const Values &of_joints, Kernel constraints,
                                              const Values &of_constraints)
{
  for (uint32_t color = 0; color < std::min(std::max(plan_.colors, plan_.joint_colors), COLOR_LIMIT); ++color) {
    if (color < plan_.joint_colors)
      run_range(joints, JOINT_COLOR_START + color, JOINT_COLOR_START + color + 1, of_joints);
    if (color < plan_.colors) launch_color(constraints, color, of_constraints);
  }
}

void StepLaunches::solve_link_joints(uint32_t pass)
{
  for (uint32_t color = 0; color < std::min(plan_.link_joint_colors, COLOR_LIMIT); ++color)
    run_range(Kernel::solve_link_joints, LINK_JOINT_COLOR_START + color, LINK_JOINT_COLOR_START + color + 1, {pass});
  if (plan_.link_joint_colors > COLOR_LIMIT) run(Kernel::solve_link_joints_in_order, {pass});
}

/* Trees of which a contact has another body that moves, or no colour: shared/articulations/tree_contacts.h. */
void StepLaunches::solve_mixed_trees(uint32_t pass)
{
  if (plan_.trees_apart && plan_.colors <= LINK_COLORS) return;
  for (uint32_t color = 0; color < std::min(plan_.colors, LINK_COLORS); ++color)
    run_range(Kernel::solve_link_contacts, LINK_COLOR_START + color, COLOR_START + color + 1, {pass});
  if (plan_.colors > LINK_COLORS) run(Kernel::solve_link_contacts_in_order, {pass});
}

/* Trees that have their contacts for themselves: shared/articulations/tree_contacts.h. */
void StepLaunches::solve_unmixed_trees(uint32_t pass)
{
  if (pass != PASS_WARM_STARTING) {
    run(Kernel::prepare_tree_paths, {pass});
    run(Kernel::project_tree_contacts, {pass});
    run(Kernel::solve_tree_contacts, {pass});
  }
  if (pass == PASS_WARM_STARTING || pass == PASS_RELAXING) run(Kernel::warm_start_tree_contacts);
}

void StepLaunches::push_links(uint32_t pass)
{
  if (pass != PASS_BOUNCING) solve_link_joints(pass);
  solve_unmixed_trees(pass);
  solve_mixed_trees(pass);
}

void StepLaunches::for_each_link_color(uint32_t pass)
{
  if (!has_links()) return;
  push_links(pass);
  if (pass != PASS_WARM_STARTING) run(Kernel::solve_articulations, {pass});
  if (has(FEATURE_TREE_COUPLINGS) && pass != PASS_BOUNCING) run(Kernel::solve_tree_couplings, {pass});
}

/* A pass that starts a step gathers all impulses of contacts and joints as forces on links. */
void StepLaunches::balance_trees()
{
  if (!balances_trees()) return;
  push_links(PASS_WARM_STARTING);
  run(Kernel::sum_tree_balance);
}

void StepLaunches::for_each_joint_color(Kernel joints, const Values &values)
{
  for (uint32_t color = 0; color < std::min(plan_.joint_colors, COLOR_LIMIT); ++color)
    run_range(joints, JOINT_COLOR_START + color, JOINT_COLOR_START + color + 1, values);
}

void StepLaunches::run_overflow_joints(Kernel kernel, const Values &values)
{
  if (plan_.joint_colors <= COLOR_LIMIT) return;
  if (has(FEATURE_WORLDS)) run_range(kernel, JOINT_COLOR_START + COLOR_OVERFLOW, LINK_JOINT_COLOR_START, values);
  else run(kernel, values);
}

void StepLaunches::for_each_coupling_color(Kernel kernel, const Values &values)
{
  for (uint32_t color = 0; color < std::min(plan_.coupling_colors, COLOR_LIMIT); ++color)
    run_range(kernel, COUPLING_COLOR_START + color, COUPLING_COLOR_START + color + 1, values);
}

void StepLaunches::run_overflow_couplings(Kernel kernel, const Values &values)
{
  if (plan_.coupling_colors <= COLOR_LIMIT) return;
  if (row_of(kernel).items != items_given) run(kernel, values);
  else run_range(kernel, COUPLING_COLOR_START + COLOR_OVERFLOW, COUNT_COUPLINGS, values);
}

void StepLaunches::for_each_color(Kernel kernel, Kernel overflow, const Values &values)
{
  for_each_color(kernel, values);
  if (plan_.colors > COLOR_LIMIT) run(overflow, values);
}

void StepLaunches::begin_substep(uint32_t substep)
{
  if (has(FEATURE_EVENTS)) run_contacts(Kernel::sum_impulses, {substep});
  if (plan_.forces) run(Kernel::begin_forces);
  run_extensions(StepPoint::forces);
  if (plan_.forces) run(Kernel::apply_forces);
  run(Kernel::integrate_velocities, {substep == 0 && !has_links()});
  if (balances_trees() && substep + 1 == substeps()) run(Kernel::begin_tree_balance, {plan_.forces});
  if (has_links()) run(Kernel::accelerate_articulations, {plan_.forces});
  if (has(FEATURE_MAX_SPEED)) run(Kernel::clamp_speeds);
}

void StepLaunches::move_bodies()
{
  run(Kernel::integrate_positions);
  if (has(FEATURE_LOCKS) && has(FEATURE_GYROSCOPIC)) run(Kernel::lock_bodies);
  if (plan_.forces) run(Kernel::follow_forces);
  if (has_links()) run(Kernel::move_articulations); /* last, because links are where their trees have them */
}

void StepLaunches::scan_pairs(Buffer starts, uint32_t length)
{
  const uint32_t capacity = length == COUNT_BODIES ? plan_.bodies : SWEEP_SHARES * plan_.bodies;
  exclusive_scan(launcher_, starts, starts, Buffer::scan_sums, length, capacity);
  run_range(Kernel::count_pairs, COUNT_ZERO, COUNT_ONE, {length}, {starts});
}

void StepLaunches::sort(Buffer keys, Buffer values, uint32_t length, uint32_t capacity, unsigned first_bit,
                        unsigned last_bit)
{
  sort_pairs(launcher_, keys, values, Buffer::sort_key_other, Buffer::sort_value_other, Buffer::sort_histogram,
             Buffer::scan_sums, length, capacity, first_bit, last_bit);
}

} // namespace tandem
