/* step_launches.h - the operations of which a step is written: launch a kernel, launch it for each colour, scan, sort.
 *
 * host/pipeline/step.cpp writes the pipeline with them, and each file of host/pipeline/solvers/ a solver. */
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
  Launcher &launcher() { return launcher_; }
  bool has(Features feature) const { return (plan_.features & feature) != 0; }

  /* A kernel over the items of its row; of groups only where the scene alone tells how many there are. */
  void run(Kernel kernel, const Values &values = {}, const Slots &slots = {});
  /* A kernel over [counts[first], counts[last]). */
  void run_range(Kernel kernel, uint32_t first, uint32_t last, const Values &values = {}, const Slots &slots = {});
  /* A kernel over the items of its row, whose number changes by more than the last step tells: for at most so many. */
  void run_at_most(Kernel kernel, uint32_t most, const Values &values = {}, const Slots &slots = {});
  /* A kernel over the pairs of its kind: their list, or all pairs where the scene has no lists. */
  void run_pairs(Kernel kernel, uint32_t pair_kind, const Values &values = {});
  /* The same, over those of kinds that follow each other. */
  void run_pairs(Kernel kernel, uint32_t first_kind, uint32_t last_kind, const Values &values);
  /* One launch a colour of constraints; those without a colour of their own are left to
   * host/pipeline/solvers/mass_split.h. */
  void for_each_color(Kernel kernel, const Values &values = {});
  /* The same, and `overflow` over those without a colour. */
  void for_each_color(Kernel kernel, Kernel overflow, const Values &values = {});
  /* What every substep starts with: the impulses of the one before are added up for the events, and forces act. */
  void begin_substep(uint32_t substep);
  /* From how many pairs each of so many finds to where its first goes, and to how many there are. */
  void scan_pairs(Buffer starts, uint32_t length = COUNT_BODIES);
  /* A kernel of an extension over the items of its row; no point: between steps. InputError says what does not fit. */
  void run_of_module(Kernel kernel, const Values &values, const Slots &slots, std::optional<StepPoint> point);
  /* What modules launch at this point of the step (Settings::extensions). */
  void run_extensions(StepPoint point);
  void sort(Buffer keys, Buffer values, uint32_t length, uint32_t capacity, unsigned first_bit, unsigned last_bit);

private:
  Launcher &launcher_;
  const StepPlan &plan_;
  const Settings &settings_;
};

} // namespace tandem
