/* mass_split.h - passes over constraints that are solved all at once; see shared/solve/mass_split.h.
 *
 * The solver `jacobi` solves every constraint so, the others their overflow constraints, after the last colour of each
 * pass:
 *
 *   MassSplit overflow = MassSplit::overflow_of(step);   nothing is launched where every constraint has a colour
 *   overflow.prepare();                              once a step
 *   step.for_each_color(Kernel::warm_start);
 *   overflow.warm_start();
 */
#pragma once

#include "host/pipeline/step_launches.h"

namespace tandem {

/* Passes over the overflow constraints after each over the colours. */
constexpr uint32_t overflow_iterations = 4;

class MassSplit {
public:
  static MassSplit all_of(StepLaunches &step) { return {step, 0, true}; }
  static MassSplit overflow_of(StepLaunches &step) { return {step, COLOR_OVERFLOW, step.plan().colors > COLOR_LIMIT}; }

  /* How often colours and overflow constraints shall take turns in an iteration. What rests on a body of many contacts
   * is spread over both, and one turn leaves them at odds: 200 kg of boxes on a slab of 20 kg then jitter for ever, at
   * twice the depth. */
  uint32_t turns() const { return launched_ ? 2 : 1; }

  /* Lists and masses; before any other pass. */
  void prepare();
  void warm_start();
  /* pass: of shared/solve/pass.h. */
  void solve(uint32_t pass, uint32_t iterations);
  /* In rounds: a bouncing part is stopped by the others of its body. */
  void apply_restitution();

private:
  MassSplit(StepLaunches &step, uint32_t first_color, bool launched)
      : step_(step), first_color_(first_color), launched_(launched)
  {}
  void run_rows(Kernel kernel, const Values &values = {});
  void join_parts();

  StepLaunches &step_;
  uint32_t first_color_;
  bool launched_;
};

} // namespace tandem
