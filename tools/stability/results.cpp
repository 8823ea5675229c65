/* results.cpp - see results.h. */
#include "tools/stability/results.h"

#include <cmath>

#include <fmt/format.h>

namespace tandem::stability {
namespace {

/* JSON has no NaN: a figure that is none is null. */
Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json result_json(const Result &result)
{
  const Outcome &outcome = result.outcome;
  Json checks = Json::array();
  for (const CheckResult &check : outcome.checks)
    checks.push_back({{"what", check.what}, {"figure", number(check.figure)}, {"bound", check.bound}, {"unit", check.unit}, {"passed", check.passed}});
  return {{"name", outcome.name},
          {"solver", outcome.solver},
          {"passed", outcome.passed},
          {"figure", number(outcome.headline.figure)},
          {"bound", outcome.headline.bound},
          {"unit", outcome.headline.unit},
          {"what", outcome.headline.what},
          {"group", result.which.group},
          {"settings", result.settings},
          {"steps", outcome.steps},
          {"ms", outcome.milliseconds_per_step},
          {"note", outcome.note},
          {"body_hash", hash_text(outcome.body_hash)},
          {"checks", checks}};
}

} // namespace

void Results::add(const Case &which, const Trial &trial, Outcome outcome)
{
  results.push_back({which, std::move(outcome), settings_text(trial.settings), trial.scene.bodies, trial.scene.shapes});
}

std::string series_csv(const Results &results)
{
  std::string text = "case,solver,figure,unit,time_s,value\n";
  for (const Result &result : results.results)
    for (const CheckResult &check : result.outcome.checks)
      for (const Sample &sample : check.series)
        text += fmt::format("{},{},{},{},{:.6g},{:.6g}\n", result.outcome.name, result.outcome.solver, check.what, check.unit, sample.time, sample.value);
  return text;
}

Json results_json(const Results &results)
{
  Json cases = Json::array();
  for (const Result &result : results.results) cases.push_back(result_json(result));
  return {{"backend", results.backend}, {"solvers", results.solvers}, {"quick", results.length == Length::quick}, {"cases", cases}};
}

} // namespace tandem::stability
