/* results.cpp - writes the results as JSON, CSV and a page; see results.h. */
#include "tools/stability/results.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/plot/page.h"
#include "tools/stability/counts.h"
#include "tools/stability/picture.h"

namespace tandem::stability {
namespace {

/* JSON has no NaN, so a figure that is not finite becomes null. */
Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json check_json(const CheckResult &check)
{
  return {{"what", check.what},
          {"figure", number(check.figure)},
          {"bound", check.bound.value},
          {"ratio", number(check.ratio())},
          {"unit", check.unit},
          {"passed", check.passed},
          {"derivation", check.bound.derivation}};
}

Json counts_json(const Counts &counts)
{
  return {{"by_default", counts.by_default},
          {"with_setting", counts.with_setting},
          {"with_solver", counts.with_solver},
          {"failed", counts.failed},
          {"refused", counts.refused}};
}

const char *word_of(Pass pass)
{
  switch (pass) {
  case Pass::by_default: return "default";
  case Pass::with_setting: return "documented setting";
  case Pass::with_solver: return "documented solver";
  case Pass::refused: return "refused";
  default: return "failed";
  }
}

Json result_json(const Result &result)
{
  const Outcome &outcome = result.outcome;
  Json checks = Json::array();
  for (const CheckResult &check : outcome.checks) checks.push_back(check_json(check));
  return {{"name", outcome.name},
          {"solver", outcome.solver},
          {"passed", outcome.passed},
          {"figure", number(outcome.headline.figure)},
          {"bound", outcome.headline.bound.value},
          {"unit", outcome.headline.unit},
          {"what", outcome.headline.what},
          {"group", result.which.group},
          {"settings", outcome.settings},
          {"pass", word_of(outcome.pass())},
          {"by_default", outcome.by_default ? check_json(*outcome.by_default) : Json(nullptr)},
          {"steps", outcome.steps},
          {"ms", outcome.milliseconds},
          {"ms_per_step", outcome.milliseconds_per_step},
          {"note", outcome.note},
          {"fails_because", result.which.fails_because},
          {"elsewhere", result.which.elsewhere},
          {"body_hash", hash_text(outcome.body_hash)},
          {"checks", checks}};
}

PageCell verdict_cell(const Result &result)
{
  const Outcome &outcome = result.outcome;
  if (outcome.refused) return PageCell("refused");
  const std::string settings = outcome.by_default ? ", only with " + with_what(outcome) : "";
  PageCell cell(fmt::format("{} {}{}", outcome.passed ? "pass" : "FAIL",
                            with_unit(outcome.headline.figure, outcome.headline.unit), settings),
                outcome.headline.figure);
  cell.mark = outcome.passed ? "good" : "bad";
  return cell;
}

/* The results of one case, solver by solver. */
using CaseResults = std::vector<const Result *>;

std::vector<CaseResults> by_case(const Results &results)
{
  std::vector<CaseResults> grouped;
  for (const Result &result : results.results) {
    if (grouped.empty() || grouped.back().front()->which.name != result.which.name) grouped.emplace_back();
    grouped.back().push_back(&result);
  }
  return grouped;
}

PageTable table_of(const Results &results)
{
  PageTable table{"Each cell: the figure that failed, or else the case's first", {"case", "group", "bound"}, {}};
  for (const std::string &solver : results.solvers) table.header.push_back(solver);
  for (const CaseResults &each : by_case(results)) {
    const CheckResult &check = each.front()->outcome.headline;
    std::vector<PageCell> row{
        each.front()->outcome.name, each.front()->which.group,
        PageCell(fmt::format("{} at most {}", check.what, with_unit(check.bound.value, check.unit)),
                 check.bound.value)};
    for (const Result *result : each) row.push_back(verdict_cell(*result));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/* At most about 150 points, because the page contains many charts. */
ChartSeries series_of(const std::string &name, const std::vector<Sample> &samples)
{
  ChartSeries series{name, {}, false};
  const size_t stride = std::max<size_t>(1, samples.size() / 150);
  for (size_t i = 0; i < samples.size(); i += stride) series.points.push_back({samples[i].time, samples[i].value});
  if (!samples.empty() && (samples.size() - 1) % stride)
    series.points.push_back({samples.back().time, samples.back().value});
  return series;
}

/* The figure by which the first solver is judged, for all solvers. The axis is logarithmic if the values differ too
 * much for a linear chart. */
Chart chart_of(const CaseResults &results)
{
  const CheckResult &check = results.front()->outcome.headline;
  Chart chart;
  chart.title = check.what;
  chart.x.label = "time, s";
  chart.y.label = check.unit.empty() ? check.what : check.what + ", " + check.unit;
  chart.width = 560;
  chart.height = 240;
  double largest = 0;
  for (const Result *result : results)
    for (const CheckResult &same : result->outcome.checks)
      if (same.what == check.what) {
        chart.series.push_back(series_of(result->outcome.solver, same.series));
        for (const Sample &sample : same.series)
          if (std::isfinite(sample.value)) largest = std::max(largest, sample.value);
      }
  if (check.bound.value > 0 && largest > 20 * check.bound.value) {
    chart.y.scale = AxisScale::logarithmic;
    chart.y.lowest = check.bound.value / 100;
  } else chart.y.lowest = 0;
  chart.y.highest = std::max(largest, 1.1 * check.bound.value);
  if (*chart.y.highest <= 0) chart.y.highest = 1;
  chart.levels = {{check.bound.value, "bound"}};
  return chart;
}

PageTable checks_of(const CaseResults &results)
{
  PageTable table{
      "",
      {"solver", "figure", "value", "bound", "bound / value", "bound is from", "passed", "ms a step", "ms in all"},
      {}};
  for (const Result *result : results)
    for (const CheckResult &check : result->outcome.checks) {
      PageCell passed(check.passed ? "yes" : "NO");
      passed.mark = check.passed ? "good" : "bad";
      table.rows.push_back({result->outcome.solver, check.what,
                            PageCell(with_unit(check.figure, check.unit), check.figure),
                            PageCell(with_unit(check.bound.value, check.unit), check.bound.value),
                            PageCell(check.ratio()), check.bound.derivation, passed,
                            PageCell(result->outcome.milliseconds_per_step), PageCell(result->outcome.milliseconds)});
    }
  return table;
}

std::string captioned(const std::string &picture, const std::string &caption)
{
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", picture, caption);
}

void add_case(Page &page, const CaseResults &results)
{
  const Result &first = *results.front();
  page.subsection(first.outcome.name);
  page.paragraph(fmt::format("{}. Passes if: {}. Settings: {}; {} steps.", first.which.what, first.which.criterion,
                             first.outcome.settings, first.outcome.steps));
  if (!first.which.fails_because.empty()) page.paragraph(fmt::format("Fails: {}.", first.which.fails_because));
  if (!first.which.elsewhere.empty()) page.paragraph(fmt::format("Elsewhere: {}.", first.which.elsewhere));
  for (const Result *result : results)
    if (!result->outcome.note.empty())
      page.paragraph(fmt::format("{}: {}", result->outcome.solver, result->outcome.note));
  const Window window = window_of(first.shapes, first.start, first.outcome.end);
  page.html("<div class=\"scenes\">" +
            captioned(svg_of(first.shapes, first.start, states_of(first.start), window, "start"), "start"));
  if (!first.outcome.end.empty())
    page.html(captioned(svg_of(first.shapes, first.start, first.outcome.end, window, "end"),
                        fmt::format("end, {}", first.outcome.solver)));
  page.html("</div>\n");
  page.chart(chart_of(results));
  page.table(checks_of(results));
}

const char *const picture_style = R"(<style>
.scenes { display: flex; flex-wrap: wrap; align-items: end; }
.scenes figure { margin: 0 1em 0.5em 0; }
.scenes figcaption { font-size: 0.8em; opacity: 0.7; }
svg.scene { margin: 0.3em 0.6em 0.3em 0; border: 1px solid #8886; vertical-align: top; }
svg.scene .moving { fill: #56b4e9aa; stroke: currentColor; stroke-width: 0.4; }
svg.scene .fixed { fill: #8884; stroke: currentColor; stroke-width: 0.4; }
svg.scene .ground { stroke: currentColor; stroke-width: 1; }
</style>
)";

/* The time of each solver, and the longest runs. */
void add_times(Page &page, const Results &results)
{
  page.section("Time");
  page.paragraph(
      fmt::format("{:.1f} s in all, summed over runs of which {} went side by side: worlds made, steps and figures.",
                  1e-3 * results.total_milliseconds(), results.at_once));
  PageTable table{"seconds by solver, and its longest case", {"solver", "s", "longest case", "s of it"}};
  for (const std::string &solver : results.solvers) {
    double sum = 0;
    const Outcome *longest = nullptr;
    for (const Result &result : results.results) {
      if (result.outcome.solver != solver) continue;
      sum += result.outcome.milliseconds;
      if (!longest || result.outcome.milliseconds > longest->milliseconds) longest = &result.outcome;
    }
    if (longest) table.rows.push_back({solver, 1e-3 * sum, longest->name, 1e-3 * longest->milliseconds});
  }
  page.table(table);
}

} // namespace

std::string results_page(const Results &results, const std::string &command)
{
  std::string counts;
  for (const std::string &solver : results.solvers)
    counts += fmt::format("{}: {}. ", solver, text_of(counts_of(results, solver)));
  Page page("Stability: stiff and extreme cases",
            fmt::format("{} runs on {}. {}What passes only with a setting or a solver that its case documents says "
                        "what failed without. A case states what passing means in figures, with their bounds; what a "
                        "figure is compared with is a closed "
                        "form, a conserved quantity, the start of the scene or a bound on energy. docs/stability.md "
                        "says how a case is defined.{}",
                        results.results.size(), results.backend, counts,
                        results.length == Length::quick
                            ? " Quick run: cases named -short are shorter or smaller than the whole ones."
                            : ""));
  page.html(picture_style);
  page.section("All cases");
  page.table(table_of(results));
  std::string group;
  for (const CaseResults &each : by_case(results)) {
    if (each.front()->which.group != group) page.section(group = each.front()->which.group);
    add_case(page, each);
  }
  add_times(page, results);
  page.section("How it was made");
  page.commands({command});
  return page.text();
}

std::string with_unit(double figure, const std::string &unit)
{
  const std::string text = std::isfinite(figure) ? fmt::format("{:.3g}", figure) : "no figure";
  return unit.empty() ? text : text + " " + unit;
}

double Results::total_milliseconds() const
{
  double sum = 0;
  for (const Result &result : results) sum += result.outcome.milliseconds;
  return sum;
}

void Results::add(const Case &which, const Scene &scene, Outcome outcome, size_t place)
{
  const auto after =
      std::find_if(results.begin(), results.end(), [&](const Result &other) { return other.place > place; });
  results.insert(after, {which, std::move(outcome), scene.bodies, scene.shapes, place});
}

std::string series_csv(const Results &results)
{
  std::string text = "case,solver,figure,unit,time_s,value\n";
  for (const Result &result : results.results)
    for (const CheckResult &check : result.outcome.checks)
      for (const Sample &sample : check.series)
        text += fmt::format("{},{},{},{},{:.6g},{:.6g}\n", result.outcome.name, result.outcome.solver, check.what,
                            check.unit, sample.time, sample.value);
  return text;
}

Json results_json(const Results &results)
{
  Json cases = Json::array(), counts = Json::object();
  for (const Result &result : results.results) cases.push_back(result_json(result));
  for (const std::string &solver : results.solvers) counts[solver] = counts_json(counts_of(results, solver));
  return {{"backend", results.backend},
          {"solvers", results.solvers},
          {"quick", results.length == Length::quick},
          {"complete", results.complete()},
          {"ms", results.total_milliseconds()},
          {"counts", counts},
          {"cases", cases}};
}

} // namespace tandem::stability
