/* counts.cpp - counts outcomes by kind and formats bounds; see counts.h. */
#include "tools/stability/counts.h"

#include <cmath>

#include <fmt/format.h>

namespace tandem::stability {

Counts counts_of(const Results &results, const std::string &solver)
{
  Counts counts;
  for (const Result &result : results.results) {
    if (result.outcome.solver != solver) continue;
    switch (result.outcome.pass()) {
    case Pass::by_default: ++counts.by_default; break;
    case Pass::with_setting: ++counts.with_setting; break;
    case Pass::with_solver: ++counts.with_solver; break;
    case Pass::failed: ++counts.failed; break;
    case Pass::refused: ++counts.refused; break;
    }
  }
  return counts;
}

std::string text_of(const Counts &counts)
{
  return fmt::format("{} pass by default, {} only with a documented setting, {} with a documented solver, {} fail{}",
                     counts.by_default, counts.with_setting, counts.with_solver, counts.failed,
                     counts.refused > 0 ? fmt::format(", {} are refused", counts.refused) : "");
}

std::string verdict_of(const Outcome &outcome)
{
  switch (outcome.pass()) {
  case Pass::by_default: return "pass";
  case Pass::failed: return "FAIL";
  case Pass::refused: return "refused";
  default: return "with " + outcome.settings;
  }
}

std::string with_what(const Outcome &outcome)
{
  if (!outcome.by_default) return "";
  const CheckResult &failed = *outcome.by_default;
  return fmt::format("{}; by default FAIL {} ({})", outcome.settings, with_unit(failed.figure, failed.unit),
                     failed.what);
}

std::string ratio_text(const CheckResult &check)
{
  if (!std::isnan(check.ratio())) return fmt::format("{:.3g}", check.ratio());
  return check.passed ? "exact" : "none";
}

std::string bounds_text(const Results &results)
{
  std::string text;
  for (const Result &result : results.results)
    for (const CheckResult &check : result.outcome.checks)
      text += fmt::format("{:28} {:10} {:36} {:>12} of {:>12}  ratio {:<9} {}{}\n", result.outcome.name,
                          result.outcome.solver, check.what, with_unit(check.figure, check.unit),
                          with_unit(check.bound.value, check.unit), ratio_text(check), check.loose() ? "LOOSE " : "",
                          check.passed ? check.bound.derivation : "FAIL");
  return text;
}

size_t loose_bounds(const Results &results, const std::string &solver)
{
  size_t count = 0;
  for (const Result &result : results.results)
    for (const CheckResult &check : result.outcome.checks) count += result.outcome.solver == solver && check.loose();
  return count;
}

} // namespace tandem::stability
