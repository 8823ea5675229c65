/* table.cpp - writes the table as Markdown; see table.h. */
#include "tools/stability/table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/stability/counts.h"

namespace tandem::stability {
namespace {

/* A cell such as "deepest contact 0.00119 of 0.0058 m (4.9)"; the ratio is omitted if it is meaningless. */
std::string check_cell(const CheckResult &check)
{
  const std::string figure = std::isfinite(check.figure) ? fmt::format("{:.3g}", check.figure) : "no figure";
  const std::string why = !check.bound.derivation.empty() ? check.bound.source
                          : check.figure > 0              ? fmt::format("{:.2g} x", check.ratio())
                                                          : "exact";
  return fmt::format("{}: {} of {} ({}){}", check.what, figure, with_unit(check.bound.value, check.unit), why,
                     check.passed ? "" : " **fails**");
}

std::string verdict_text(const Result &result)
{
  const Outcome &outcome = result.outcome;
  if (outcome.pass() == Pass::by_default) return "pass";
  if (outcome.pass() == Pass::refused) return "refused";
  if (outcome.pass() == Pass::failed)
    return fmt::format("**fail** {} ({}){}", with_unit(outcome.headline.figure, outcome.headline.unit),
                       outcome.headline.what,
                       result.which.fails_because.empty() ? "" : "; " + result.which.fails_because);
  return "**with** " + with_what(outcome);
}

/* Whether anything is known of other engines, which then has a column. */
bool compared(const Results &results)
{
  return std::any_of(results.results.begin(), results.results.end(),
                     [](const Result &result) { return !result.which.elsewhere.empty(); });
}

bool has_theory(const Results &results)
{
  for (const Result &result : results.results)
    for (const CheckResult &check : result.outcome.checks)
      if (check.bound.source == "theory") return true;
  return false;
}

std::string row_of(const Results &results, size_t first)
{
  const Result &result = results.results[first];
  std::string checks, row;
  for (const CheckResult &check : result.outcome.checks) checks += (checks.empty() ? "" : "<br>") + check_cell(check);
  row = fmt::format("| {} | {} | {} |", result.outcome.name, result.which.what, checks);
  for (size_t k = first; k < results.results.size() && results.results[k].which.name == result.which.name; ++k)
    row += " " + verdict_text(results.results[k]) + " |";
  if (compared(results)) row += " " + result.which.elsewhere + " |";
  return row + "\n";
}

} // namespace

std::string markdown_of(const Results &results, const std::string &command)
{
  std::string text = fmt::format(
      "`{}` on {}.\nEach check: figure of bound, and how many times the figure the bound is (\"rounding\": the "
      "bound is derived from that of\nfloats;{} \"exact\": both are 0).\n\n",
      command, results.backend, has_theory(results) ? " \"theory\": from that of the method;" : "");
  for (const std::string &solver : results.solvers)
    text += fmt::format("- {}: {} (of {})\n", solver, text_of(counts_of(results, solver)),
                        counts_of(results, solver).all());
  text += fmt::format("\n| case | what | figures of {} | {} |{}\n|---|---|---|", results.solvers.front(),
                      fmt::join(results.solvers, " | "), compared(results) ? " elsewhere |" : "");
  for (size_t k = 0; k < results.solvers.size() + (compared(results) ? 1 : 0); ++k) text += "---|";
  text += "\n";
  for (size_t k = 0; k < results.results.size(); ++k)
    if (k == 0 || results.results[k].which.name != results.results[k - 1].which.name) text += row_of(results, k);
  return text;
}

} // namespace tandem::stability
