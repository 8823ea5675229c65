/* cases_mass_ratio.cpp - heavy on light and light on heavy: where iterations that pass impulses from body to body converge worst. */
#include <cmath>

#include <fmt/format.h>

#include "tools/stability/cases.h"

namespace tandem::stability {
namespace {

const char *const stands = "stands 10 s: no cube turns by 0.05 rad or leaves by 5 cm, contacts at most 2 cm deep (4 x slop), at rest at the end";

Trial column_trial(const std::vector<float> &masses, uint32_t substeps, const std::string &solver, Length length)
{
  Trial trial = trial_of(column_of(masses), steps_for(length, 600, 600));
  if (substeps) trial.documented = with_substeps(substeps);
  trial.documented_solver = solver;
  add_standing(trial, {});
  return trial;
}

/* `substeps`, or `solver`: what the case needs beyond the defaults. */
Case column_case(const std::string &name, const std::string &what, const std::vector<float> &masses, uint32_t substeps = 0,
                 const std::string &solver = "")
{
  return {name, "mass ratio", what, stands, [=](Length length) { return column_trial(masses, substeps, solver, length); }};
}

std::vector<float> doubling(bool up)
{
  std::vector<float> masses;
  for (int i = 0; i < 20; ++i) masses.push_back(std::ldexp(1.0f, up ? i : 19 - i));
  return masses;
}

} // namespace

void add_mass_ratio_cases(std::vector<Case> &cases)
{
  for (float ratio : {10.0f, 100.0f, 1000.0f, 10000.0f})
    cases.push_back(column_case(fmt::format("heavy-on-light-{:.0f}", ratio), fmt::format("a cube of {:.0f} kg on one of 1 kg", ratio), {1, ratio},
                                ratio > 1000 ? 64 : ratio > 100 ? 16 : 0));
  cases.push_back(column_case("heavy-on-four-light-1000", "a cube of 1,000 kg on a column of four of 1 kg", {1, 1, 1, 1, 1000}, 32));
  cases.push_back(column_case("light-on-heavy-10000", "a cube of 1 kg on one of 10,000 kg", {10000, 1}));
  cases.push_back(column_case("alternating-1000", "a column of ten cubes, 1 kg and 1,000 kg in turn", {1, 1000, 1, 1000, 1, 1000, 1, 1000, 1, 1000}, 32));
  cases.push_back(
      column_case("doubling-up", "a column of 20 cubes, each twice as heavy as the one it stands on: 1 kg to 524 t", doubling(true), 0, "direct"));
  cases.push_back(column_case("doubling-down", "a column of 20 cubes, each half as heavy as the one it stands on: 524 t to 1 kg", doubling(false)));
}

} // namespace tandem::stability
