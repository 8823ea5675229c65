/* cases_mass_ratio.cpp - the group of cases with large mass ratios, heavy on light and light on heavy, for which
 * iterative solvers converge worst. */
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/stability/cases.h"

namespace tandem::stability {
namespace {

/* The largest depth at which springs of the present stiffness hold the loads, beyond the slop, each relative to the
 * effective mass of its contact. */
double deepest_at_rest(const std::vector<float> &masses, const Settings &settings)
{
  double load = 0, worst = 0;
  for (size_t i = masses.size(); i-- > 0;) {
    load += double(masses[i]);
    const double effective = i ? 1 / (1 / double(masses[i]) + 1 / double(masses[i - 1])) : double(masses[i]);
    worst = std::max(worst, sink_under(load / effective, std::min(double(settings.contact_hertz), stiffest(settings))));
  }
  return double(settings.slop) + worst;
}

Trial column_trial(const std::vector<float> &masses, double depth, uint32_t substeps, const std::string &solver,
                   Length length)
{
  Trial trial = trial_of(column_of(masses), steps_for(length, 600, 600));
  if (substeps) trial.documented = with_substeps(substeps);
  trial.documented_solver = solver;
  add_standing(trial, {depth > 0 ? std::optional(depth) : std::nullopt, {}, {}, {}});
  return trial;
}

/* depth: 0 if only rounding bounds it. `substeps`, or `solver`: what the case needs beyond the defaults. */
Case column_case(const std::string &name, const std::string &what, const std::vector<float> &masses, double depth,
                 uint32_t substeps = 0, const std::string &solver = "")
{
  return {name, "mass ratio", what,
          fmt::format("stands 10 s: contacts at most {} deep, turned, moved and, at the end, at rest but for rounding",
                      depth > 0 ? fmt::format("{:.3g} m", depth) : "rounding"),
          [=](Length length) { return column_trial(masses, depth, substeps, solver, length); }};
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
  const double four_slops = 0.02;
  for (float ratio : {10.0f, 100.0f, 1000.0f, 10000.0f}) {
    const double depth =
        ratio > 10 ? four_slops : deepest_at_rest({1, ratio}, {}); /* heavier bodies overshoot their rest depth */
    cases.push_back(column_case(fmt::format("heavy-on-light-{:.0f}", ratio),
                                fmt::format("a cube of {:.0f} kg on one of 1 kg", ratio), {1, ratio}, depth,
                                ratio > 1000  ? 64
                                : ratio > 100 ? 16
                                              : 0));
  }
  cases.push_back(column_case("heavy-on-four-light-1000", "a cube of 1,000 kg on a column of four of 1 kg",
                              {1, 1, 1, 1, 1000}, four_slops, 32));
  cases.push_back(column_case("light-on-heavy-10000", "a cube of 1 kg on one of 10,000 kg", {10000, 1}, 0));
  cases.push_back(column_case("alternating-1000", "a column of ten cubes, 1 kg and 1,000 kg in turn",
                              {1, 1000, 1, 1000, 1, 1000, 1, 1000, 1, 1000}, four_slops, 32));
  cases.push_back(column_case("doubling-up",
                              "a column of 20 cubes, each twice as heavy as the one it stands on: 1 kg to 524 t",
                              doubling(true), 0.00005, 0, "direct"));
  cases.push_back(column_case("doubling-down",
                              "a column of 20 cubes, each half as heavy as the one it stands on: 524 t to 1 kg",
                              doubling(false), deepest_at_rest(doubling(false), {})));
}

} // namespace tandem::stability
