/* planted.h - runs of cases of `tandem stability` in which a test plants a wrong motion, which a figure must notice. */
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include "tools/stability/cases.h"

namespace tandem::stability {

inline const Case &case_named(const std::string &name)
{
  for (const Case &each : all_cases())
    if (each.name == name) return each;
  throw std::runtime_error("no case " + name);
}

inline Outcome run(const std::string &name, Trial trial)
{
  return run_trial(name, trial, choice_names<Solver>().front(), Placement{"serial", {}, false});
}
inline Outcome run(const std::string &name, Length length = Length::quick)
{
  return run(name, case_named(name).build(length));
}

/* The case, with a push to the named body before step `when`. */
inline Outcome run_pushed(const std::string &name, uint32_t body, const std::function<void(BodyState &)> &push,
                          uint64_t steps = 120, uint64_t when = 10, Length length = Length::quick)
{
  Trial trial = case_named(name).build(length);
  trial.steps = steps;
  trial.disturb = [=](World &world, uint64_t step) {
    if (step != when) return;
    BodyState state = world.bodies()[body];
    push(state);
    world.set_body_unchecked(body, state);
  };
  return run(name, std::move(trial));
}

inline bool failed(const Outcome &outcome, const std::string &what)
{
  for (const CheckResult &check : outcome.checks)
    if (check.what == what) return !check.passed;
  throw std::runtime_error("no figure '" + what + "'");
}

} // namespace tandem::stability
