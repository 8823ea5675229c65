/* report_page.cpp - composes the page of a report; see report_page.h. */
#include "tools/report/report_page.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/command/output.h"
#include "tools/plot/page.h"

namespace tandem {
namespace {

std::string axis_text(Metric metric) { return fmt::format("{}, {}", name_of(metric).label, name_of(metric).unit); }

std::string note_of(const Run &run)
{
  return fmt::format("{} on {}: {:.3g} ms per step", short_text(run.settings), run.backend, run.step_milliseconds);
}

/* The line of a solver joins only the points of its own front, because the others would make it zigzag. */
ChartSeries series_of(const std::string &name, const std::vector<const Run *> &runs, Metric metric)
{
  std::vector<Tradeoff> points;
  for (const Run *run : runs) points.push_back({run->cost(), run->error(metric)});
  const std::vector<size_t> own = pareto_front(points);
  ChartSeries series{name};
  std::vector<bool> joined(runs.size());
  for (const size_t i : own) {
    joined[i] = true;
    series.points.push_back({points[i].cost, points[i].error, note_of(*runs[i]), true, runs[i]->front});
  }
  for (size_t i = 0; i < runs.size(); ++i)
    if (!joined[i]) series.points.push_back({points[i].cost, points[i].error, note_of(*runs[i]), false, false});
  return series;
}

template <class Key> std::vector<ChartSeries> series_by(const std::vector<Run> &runs, Metric metric, Key key)
{
  std::vector<std::string> names;
  std::map<std::string, std::vector<const Run *>> groups;
  for (const Run &run : runs) {
    if (!groups.contains(key(run))) names.push_back(key(run));
    groups[key(run)].push_back(&run);
  }
  std::vector<ChartSeries> series;
  for (const std::string &name : names) series.push_back(series_of(name, groups[name], metric));
  return series;
}

/* All diagrams of a scene have the same time axis, so that backends can be compared by eye. */
ChartAxis time_axis(const SceneReport &scene)
{
  ChartAxis axis{"ms for 1/60 s of simulated time", AxisScale::logarithmic};
  for (const BackendRuns &each : scene.backends)
    for (const Run &run : each.runs) {
      if (!(run.cost() > 0) || !std::isfinite(run.error(scene.metric))) continue;
      axis.lowest = std::min(axis.lowest.value_or(run.cost()), run.cost());
      axis.highest = std::max(axis.highest.value_or(run.cost()), run.cost());
    }
  return axis;
}

Chart scene_chart(const SceneReport &scene, const BackendRuns &on)
{
  Chart chart{fmt::format("{} on {}", scene.specification, on.backend),
              time_axis(scene),
              {axis_text(scene.metric), AxisScale::logarithmic}};
  chart.series = series_by(on.runs, scene.metric, [](const Run &run) { return run.solver; });
  if (scene.uncertainty() > 0) chart.levels.push_back({scene.uncertainty(), "the truth is known to this"});
  return chart;
}

std::vector<PageCell> run_cells(const Run &run)
{
  std::vector<PageCell> cells = {run.backend,
                                 run.solver,
                                 {fmt::format("{}", run.settings.substeps), double(run.settings.substeps)},
                                 {fmt::format("{}", run.settings.iterations), double(run.settings.iterations)},
                                 {step_text(run.settings), double{run.settings.step}},
                                 run.step_milliseconds,
                                 run.cost()};
  for (const double error : run.errors) cells.emplace_back(error);
  cells.emplace_back(run.front ? "front" : "");
  if (run.unequal) cells.back() = PageCell("not the same bits: " + run.failure);
  else if (!run.failure.empty()) cells.back() = PageCell("broke down: " + run.failure);
  else if (run.quarantined > 0) cells.back() = PageCell(fmt::format("{} bodies not finite", run.quarantined));
  if (run.unequal) cells.back().mark = "bad";
  return cells;
}

std::vector<std::string> run_header()
{
  std::vector<std::string> header = {"backend", "solver",      "substeps",     "iterations",
                                     "dt, s",   "ms per step", "ms per 1/60 s"};
  for (const MetricName &metric : metric_names()) header.push_back(fmt::format("{}, {}", metric.label, metric.unit));
  header.push_back("note");
  return header;
}

PageTable equal_error_table(const SceneReport &scene)
{
  PageTable table{"ms per step at equal error: for 1/60 s, with the fastest setting that keeps it; - where none of "
                  "those tried does",
                  {fmt::format("{}, at most", axis_text(scene.metric)), "solver"}};
  for (const BackendRuns &each : scene.backends) {
    table.header.push_back("ms on " + each.backend);
    table.header.push_back("with");
  }
  for (const EqualError &row : scene.equal_errors) {
    std::vector<PageCell> cells = {row.error, row.solver};
    for (size_t k = 0; k < row.runs.size(); ++k) {
      const Run *run = row.runs[k] ? &scene.backends[k].runs[*row.runs[k]] : nullptr;
      cells.push_back(run ? PageCell(run->cost()) : PageCell("-"));
      cells.push_back(run ? short_text(run->settings) : "");
    }
    table.rows.push_back(cells);
  }
  return table;
}

std::string truth_text(const SceneReport &scene)
{
  const Truth &truth = scene.truth;
  if (!truth.known()) return "Too large for a reference in double: judged by what needs no truth.";
  std::string text = truth.closed_form ? "Truth: closed form for the positions; the rest is the reference in double"
                                       : "Truth: the reference in double";
  text += fmt::format(" at {} steps for each 1/60 s. ", truth.refinements[2]);
  if (truth.chaotic)
    text += fmt::format("The scene is chaotic: starts {:.2g} m apart are {:g} times as far apart after {:.2f} s; past "
                        "that trajectories say nothing "
                        "and only the rest is compared, at {:g} s. ",
                        truth.nudge, horizon_growth, truth.horizon, scene.duration);
  else
    text += fmt::format("Starts {:.2g} m apart stay within {:g} times that for all of its {:g} s. ", truth.nudge,
                        horizon_growth, scene.duration);
  if (!truth.resolved)
    text += fmt::format("Only up to {:.2f} s is the reference known to {:g} m; trajectories are compared up to there. ",
                        static_cast<double>(truth.comparable_frames) * frame_time, resolved_bound);
  const auto error = [&](int k) {
    return fmt::format("{:.2g} m and {:.2g} rad at {}", truth.refinement_errors[k].position_rms(),
                       truth.refinement_errors[k].angle_rms(), truth.refinements[k]);
  };
  text += fmt::format("The reference is away from it by {}, {}", error(0), error(1));
  if (truth.closed_form) text += ", " + error(2);
  text += truth.order ? fmt::format("; order of convergence {:.2f}.", *truth.order) : "; its runs agree to rounding.";
  return text;
}

/* On which backend errors were computed, and whether all other backends agree with it. */
std::string equality_text(const SceneReport &scene)
{
  size_t equal = 0, unequal = 0;
  std::set<std::string> observers;
  for (const BackendRuns &each : scene.backends)
    for (const Run &run : each.runs) {
      if (!run.observed_on.empty()) observers.insert(run.observed_on);
      equal += !run.observed_on.empty() && run.observed_on != run.backend;
      unequal += run.unequal;
    }
  std::string text = fmt::format("Errors are computed on {}", fmt::join(observers, ", "));
  if (equal + unequal > 0)
    text += fmt::format("; of {} runs on other backends {} end with its hash of all bodies, bit for bit",
                        equal + unequal, equal);
  return text + (unequal > 0 ? fmt::format("; {} DO NOT: a defect, see the notes in the table", unequal) : "") + ".";
}

void add_scene(Page &page, const SceneReport &scene)
{
  page.section(scene.source->name);
  page.paragraph(std::string(scene.source->what) + ".");
  for (const BackendRuns &each : scene.backends) {
    page.paragraph(fmt::format("On {}: {}", each.backend, pick_sentence(each.runs, each.picks, scene.metric)), "pick");
    page.chart(scene_chart(scene, each));
  }
  page.paragraph(equality_text(scene));
  page.table(equal_error_table(scene));
  page.paragraph(truth_text(scene));
  PageTable table{fmt::format("{}, {:g} s", scene.specification, scene.duration), run_header()};
  std::vector<std::string> commands;
  for (const BackendRuns &each : scene.backends)
    for (const Run &run : each.runs) {
      table.rows.push_back(run_cells(run));
      if (run.front) commands.push_back(run_command_of(scene, run));
    }
  page.table(table);
  page.commands(commands);
}

void add_summary(Page &page, const Report &report)
{
  page.section("What to pick");
  PageTable table{"the cheapest setting that keeps a wished error",
                  {"scene", "backend", "error", "wished", "solver", "setting", "error kept", "ms per 1/60 s"}};
  for (const SceneReport &scene : report.scenes)
    for (const BackendRuns &each : scene.backends)
      for (const Pick &pick : each.picks) {
        const Run &run = each.runs[pick.run];
        table.rows.push_back({scene.source->name, each.backend, axis_text(scene.metric), pick.target_error, run.solver,
                              short_text(run.settings), run.error(scene.metric), run.cost()});
      }
  page.table(table);
}

void add_contact_problems(Page &page, const Report &report)
{
  if (report.contact_curves.empty()) return;
  page.section("Contact problems");
  page.paragraph("Frictional contact problems by themselves (docs/contact-problems.md): relative natural-map residual "
                 "after each sweep against time.");
  std::map<std::string, Chart> charts;
  for (const ContactCurve &curve : report.contact_curves) {
    Chart &chart = charts
                       .try_emplace(curve.problem, Chart{curve.problem,
                                                         {"ms", AxisScale::logarithmic},
                                                         {"natural-map residual, relative", AxisScale::logarithmic}})
                       .first->second;
    ChartSeries series{curve.solver};
    for (const ContactCurve::Point &point : curve.points)
      series.points.push_back({point.milliseconds, point.residual, point.note});
    chart.series.push_back(series);
  }
  for (const auto &[problem, chart] : charts) page.chart(chart);
}

/* A line of first order through the first point of a curve. */
ChartSeries first_order_beside(const JointCurve &curve)
{
  ChartSeries line{"first order"};
  line.markers = false;
  line.dashed = true;
  const JointCurve::Point &first = curve.points.front(), &last = curve.points.back();
  line.points = {{first.substep(), first.error}, {last.substep(), first.error * last.substep() / first.substep()}};
  return line;
}

void add_joints(Page &page, const JointReport &joints)
{
  page.section("Trees of links");
  page.paragraph(fmt::format(
      "The same tree in reduced coordinates, in maximal coordinates with joints of a quarter of the substeps' rate, "
      "and as a dense system of equations in double, known to {:.1g} m: distances of all links, root mean square.",
      joints.uncertainty));
  std::map<std::string, Chart> charts;
  for (const JointCurve &curve : joints.curves) {
    const auto [at, is_new] = charts.try_emplace(
        curve.scene,
        Chart{curve.scene, {"substep, s", AxisScale::logarithmic}, {"distance, m", AxisScale::logarithmic}});
    if (is_new) at->second.series.push_back(first_order_beside(curve));
    ChartSeries series{curve.method};
    for (const JointCurve::Point &point : curve.points)
      series.points.push_back({point.substep(), point.error, fmt::format("{} substeps", point.substeps)});
    at->second.series.push_back(series);
  }
  for (const auto &[scene, chart] : charts) page.chart(chart);
  for (const JointCurve &curve : joints.curves)
    page.paragraph(fmt::format("{} in {}: {}.", curve.scene, curve.method, order_sentence(curve)));
}

using RoundingKey = std::tuple<Kernel, Buffer, std::string>;

std::map<RoundingKey, const RoundingRow *> rows_by_key(const RoundingTable &table)
{
  std::map<RoundingKey, const RoundingRow *> rows;
  for (const RoundingRow &row : table.rows) rows[{row.kernel, row.buffer, row.field}] = &row;
  return rows;
}

void add_rounding(Page &page, const RoundingReport &rounding)
{
  page.section("Rounding, stage by stage");
  page.paragraph(fmt::format(
      "Every launch of {} in float, and the same launch on the same input in double: distance in units of the last "
      "place of a "
      "float (0.5 is a perfect rounding), of a float as large as the field's largest number, relative and absolute. "
      "Moved: the same scene {:g} km from the origin. Numbers near 0 that "
      "are differences of large ones have few digits left, which the ulps show and the absolute error does not.",
      rounding.scene, rounding.far / 1000));
  const auto moved = rows_by_key(rounding.far_table);
  PageTable table{fmt::format("{} launches", rounding.candidate_table.launches),
                  {"kernel", "buffer", "field", "numbers", "median ulps", "99.9% ulps", "max ulps",
                   "max ulps of the field", "max relative", "max absolute", "moved: median ulps", "moved: max ulps",
                   "moved: max absolute"}};
  for (const RoundingRow &row : rounding.candidate_table.rows) {
    const auto far = moved.find({row.kernel, row.buffer, row.field});
    const RoundingRow *other = far == moved.end() ? nullptr : far->second;
    table.rows.push_back({row_of(row.kernel).name, row_of(row.buffer).name, row.field, double(row.numbers),
                          row.median_ulps, row.high_ulps, row.max_ulps, row.max_field_ulps, row.max_relative,
                          row.max_absolute, other ? other->median_ulps : NAN, other ? other->max_ulps : NAN,
                          other ? other->max_absolute : NAN});
  }
  page.table(table);
  PageTable decisions{"whole numbers: keys, indices, flags; where they differ a decision fell otherwise in double",
                      {"kernel", "buffer", "numbers", "differing", "moved: differing"}};
  std::map<std::pair<Kernel, Buffer>, double> far;
  for (const DecisionRow &row : rounding.far_table.decisions) far[{row.kernel, row.buffer}] = double(row.differing);
  for (const DecisionRow &row : rounding.candidate_table.decisions)
    decisions.rows.push_back({row_of(row.kernel).name, row_of(row.buffer).name, double(row.numbers),
                              double(row.differing),
                              far.contains({row.kernel, row.buffer}) ? far[{row.kernel, row.buffer}] : NAN});
  page.table(decisions);
}

/* The scenes, solvers and parts that the request omits, so that the page says what is missing. */
std::vector<std::string> left_out_of(const ReportRequest &request)
{
  std::vector<std::string> names;
  for (const ReportCase &known : report_cases())
    if (std::find(request.cases.begin(), request.cases.end(), &known) == request.cases.end())
      names.push_back(known.name);
  for (const std::string &solver : choice_names<Solver>())
    if (std::find(request.solvers.begin(), request.solvers.end(), solver) == request.solvers.end())
      names.push_back(solver);
  if (!request.with_problems) names.push_back("contact problems");
  if (!request.with_joints) names.push_back("joints");
  if (!request.with_rounding) names.push_back("rounding");
  return names;
}

} // namespace

std::string report_page(const Report &report)
{
  Page page("Tandem: error against run time",
            fmt::format("{}. Made on {} with {}; backends: {}; solvers: {}. Times are medians of whole steps, for 1/60 "
                        "s of simulated time so that time steps "
                        "of all sizes compare; the first quarter of each run is warm-up. Errors are defined in "
                        "docs/metrics.md. Click a column to sort by it; "
                        "hold the pointer over a point to read it.",
                        report.request.quick ? "A quick look: small scenes, few settings" : "Work-precision diagrams",
                        report.date, report.machine, fmt::join(report.request.backends, ", "),
                        fmt::join(report.request.solvers, ", ")));
  if (!report.scenes.empty()) add_summary(page, report);
  for (const SceneReport &scene : report.scenes) add_scene(page, scene);
  add_contact_problems(page, report);
  if (report.request.with_joints) add_joints(page, report.joints);
  if (report.request.with_rounding) add_rounding(page, report.rounding);
  page.section("Made by");
  page.commands({report.request.command});
  if (!report.scenes.empty()) page.paragraph("Estimated before it started: " + report.estimate + ".");
  const std::vector<std::string> left_out = left_out_of(report.request);
  if (!left_out.empty()) page.paragraph(fmt::format("Not run: {}.", fmt::join(left_out, ", ")));
  return page.text();
}

} // namespace tandem
