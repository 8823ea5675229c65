/* mass_split.h - passes over constraints that are solved all at once; see shared/solve/mass_split.h.
 *
 * The solver `jacobi` solves every constraint and every joint in this way (shared/joints/mass_split.h); the other
 * solvers solve their overflow constraints so, after the last colour of each pass:
 *
 *   MassSplit overflow = MassSplit::overflow_of(step);   nothing is launched if every constraint has a colour
 *   overflow.prepare();                              once a step
 *   step.for_each_color(Kernel::warm_start);
 *   overflow.warm_start();
 */
#pragma once

#include "host/pipeline/step_launches.h"

namespace tandem {

/* The number of passes over the overflow constraints after each pass over the colours. */
constexpr uint32_t overflow_iterations = 4;

class MassSplit {
public:
  /* With the joints that are awake, which are solved at the same time. */
  static MassSplit all_of(StepLaunches &step)
  {
    return {step, 0, true, step.has(FEATURE_SPLIT_JOINTS) && step.plan().joint_colors > 0};
  }
  static MassSplit overflow_of(StepLaunches &step)
  {
    return {step, COLOR_OVERFLOW, step.plan().colors > COLOR_LIMIT, false};
  }

  /* How often colours and overflow constraints alternate in an iteration. The load on a body with many contacts is
   * distributed over both, and after one turn they disagree: 200 kg of boxes on a slab of 20 kg then jitter forever, at
   * twice the penetration. */
  uint32_t turns() const { return launched_ ? 2 : 1; }

  /* Makes the lists and masses; must precede all passes. */
  void prepare();
  void warm_start();
  /* pass: of shared/solve/pass.h. */
  void solve(uint32_t pass, uint32_t iterations);
  /* One of so many iterations, for a solver that does something between them. */
  void iterate(uint32_t pass, uint32_t iteration, uint32_t iterations);
  /* After the last iteration of a pass: where joints and contacts contradict each other, contacts have the last
   * word, as in passes over colours. So no joint pulls a body into the ground. */
  void end_pass(uint32_t pass);
  /* Runs in rounds, because a part with restitution is slowed by the other parts of its body. Joints take no part. */
  void apply_restitution();

private:
  MassSplit(StepLaunches &step, uint32_t first_color, bool launched, bool has_joints)
      : step_(step), first_color_(first_color), launched_(launched), has_joints_(has_joints)
  {}
  void run_rows(Kernel kernel, const Values &values = {}, const Slots &slots = {});
  void split_among_joints();
  uint32_t rounds_of_iteration() const;
  void solve_round(uint32_t pass, uint32_t momentum);
  void sum_long_lists();
  void join_parts();
  void join_parts_with_joints();

  StepLaunches &step_;
  uint32_t first_color_;
  bool launched_, has_joints_;
};

} // namespace tandem
