/* step_launches.h - the operations from which a step is composed: launch a kernel, launch it for each colour, scan,
 * sort.
 *
 * host/pipeline/step.cpp composes the pipeline of them, and each file of host/pipeline/solvers/ a solver. */
#pragma once

#include <optional>

#include "host/pipeline/step.h"

namespace tandem {

class StepLaunches {
public:
  StepLaunches(Launcher &launcher, const StepPlan &plan, const Settings &settings)
      : launcher_(launcher), plan_(plan), settings_(settings)
  {}

  const StepPlan &plan() const { return plan_; }
  const Settings &settings() const { return settings_; }
  /* Of the bodies that passes move. */
  uint32_t substeps() const { return substep_class_ == MANY_SUBSTEPS ? plan_.substeps.now : settings_.substeps; }
  Launcher &launcher() { return launcher_; }
  bool has(Features feature) const { return (plan_.features & feature) != 0; }
  /* A scene may lack articulations though every feature is built. */
  bool has_links() const { return has(FEATURE_ARTICULATIONS) && plan_.known[COUNT_ARTICULATIONS] > 0; }
  /* Whether the forces of the joints of trees are wanted: shared/articulations/joint_forces.h. */
  bool balances_trees() const { return has(FEATURE_TREE_JOINT_FORCES) && has_links(); }

  /* Whether this is a batch of worlds of which some may have overflow constraints, which take further passes. */
  bool has_worlds_with_overflow() const { return has(FEATURE_WORLDS) && plan_.colors > COLOR_LIMIT; }

  /* Launches a kernel over the items of its row; a kernel of groups only if the scene alone determines their number. */
  void run(Kernel kernel, const Values &values = {}, const Slots &slots = {});
  /* Launches a kernel over [counts[first], counts[last]). */
  void run_range(Kernel kernel, uint32_t first, uint32_t last, const Values &values = {}, const Slots &slots = {});
  /* Launches a kernel over the items of its row, of which there are at most `most`; for numbers that the last step does
   * not predict. */
  void run_at_most(Kernel kernel, uint32_t most, const Values &values = {}, const Slots &slots = {});
  /* Launches a kernel over the pairs of its kind: their list, or all pairs if the scene has no lists. branch: as Launch
   * has it. */
  void run_pairs(Kernel kernel, uint32_t pair_kind, const Values &values, uint32_t branch = 0);
  /* Launches a kernel over the pairs of consecutive kinds. */
  void run_pairs(Kernel kernel, uint32_t first_kind, uint32_t last_kind, const Values &values, uint32_t branch = 0);
  /* Launches a kernel once for each colour of constraints; constraints without a colour are left to
   * host/pipeline/solvers/mass_split.h. */
  void for_each_color(Kernel kernel, const Values &values = {});
  /* Launches a kernel of joints and one of constraints once for each colour, joints first. A scene without joints has
   * those of constraints alone. */
  void for_each_color_with_joints(Kernel joints, const Values &of_joints, Kernel constraints,
                                  const Values &of_constraints);
  /* Launches a kernel of joints alone once for each colour. */
  void for_each_joint_color(Kernel joints, const Values &values = {});
  /* Solves the joints that hold links and the contacts of links, colour by colour, then the rows of their trees. */
  void for_each_link_color(uint32_t pass);
  /* After the last pass of a step: the forces of the joints of trees, if they are wanted. */
  void balance_trees();
  /* Launches a kernel over the overflow joints, if there are some: in a batch, an item starts at each of them. */
  void run_overflow_joints(Kernel kernel, const Values &values = {});
  /* Launches a kernel of couplings once for each of their colours. */
  void for_each_coupling_color(Kernel kernel, const Values &values = {});
  /* Launches a kernel over the couplings past the last colour, if there are some: over each, or one item for all. */
  void run_overflow_couplings(Kernel kernel, const Values &values = {});
  /* Launches a kernel over the constraints of the bodies that passes move, or over those of them without a colour. */
  void run_contacts(Kernel kernel, const Values &values = {});
  void run_overflow(Kernel kernel, const Values &values = {}, const Slots &slots = {});
  /* From now on, passes move the bodies of this class: shared/substep_classes.h. */
  void take_class(uint32_t substep_class);
  /* From now on, the colours of a batch of worlds are the constraints of those worlds that have overflow constraints,
   * or all again. */
  void limit_to_worlds_with_overflow(bool limited) { limited_ = limited; }
  /* Does the same, and launches `overflow` over the constraints without a colour. */
  void for_each_color(Kernel kernel, Kernel overflow, const Values &values = {});
  /* Starts a substep: the impulses of the previous one are added up for the events, and forces are applied. */
  void begin_substep(uint32_t substep);
  /* Moves the bodies over a substep. */
  void move_bodies();
  /* Scans the numbers of pairs that items have found, so that `starts` holds the index of each item's first pair, and
   * sets the total. */
  void scan_pairs(Buffer starts, uint32_t length = COUNT_BODIES);
  /* Launches a kernel of an extension over the items of its row; without a point, between steps. Throws InputError if
   * an argument does not fit. */
  void run_of_module(Kernel kernel, const Values &values, const Slots &slots, std::optional<StepPoint> point);
  /* Launches what modules launch at this point of the step (Settings::extensions). */
  void run_extensions(StepPoint point);
  void sort(Buffer keys, Buffer values, uint32_t length, uint32_t capacity, unsigned first_bit, unsigned last_bit);

private:
  void launch_color(Kernel kernel, uint32_t color, const Values &values);
  void launch_contacts(Kernel kernel, uint32_t first, uint32_t middle, uint32_t end, const Values &values,
                       const Slots &slots = {});
  void push_links(uint32_t pass);
  void solve_link_joints(uint32_t pass);
  void solve_unmixed_trees(uint32_t pass);
  void solve_mixed_trees(uint32_t pass);

  Launcher &launcher_;
  const StepPlan &plan_;
  const Settings &settings_;
  bool limited_ = false;
  uint32_t substep_class_ = EVERY_CLASS;
};

} // namespace tandem
