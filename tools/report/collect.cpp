/* collect.cpp - plans, runs and evaluates the scenes of a report; see collect.h. */
#include "tools/report/collect.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/info.h>

#include "host/catalog/catalog.h"
#include "host/runtime/make_backend.h"
#include "tools/command/parallel.h"
#include "tools/command/progress.h"
#include "tools/report/contact_curves.h"
#include "tools/report/estimate.h"

namespace tandem {
namespace {

constexpr size_t most_picks = 4;

std::string machine_text()
{
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name"))
      return fmt::format("{}, {} threads", line.substr(line.find(':') + 2), tbb::info::default_concurrency());
  return fmt::format("{} threads", tbb::info::default_concurrency());
}

std::string date_text()
{
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

/* Counts progress in estimated milliseconds, so that the bar weighs long runs more than short ones. */
class Work {
public:
  explicit Work(double seconds) : progress_("reporting", milliseconds(seconds)) {}
  void done(double seconds) { progress_.update(done_ += milliseconds(seconds)); }

private:
  static uint64_t milliseconds(double seconds) { return static_cast<uint64_t>(1000 * seconds) + 1; }

  Progress progress_;
  uint64_t done_ = 0;
};

uint32_t refinement_of(const ReportCase &source, bool quick)
{
  return quick ? std::min(source.refinement, 16u) : source.refinement;
}

/* A planned scene, with the estimated cost of its runs. */
struct Planned {
  SceneReport report;
  uint32_t refinement;
  std::vector<Settings> settings;
  SceneEstimate estimate;

  double run_seconds() const
  {
    double sum = 0;
    for (size_t backend = 0; backend < estimate.backends.size(); ++backend)
      for (const Settings &each : settings) sum += estimate.run_seconds(backend, each, report.duration);
    return sum;
  }
};

Planned plan_scene(const ReportCase &source, const ReportRequest &request)
{
  Planned plan;
  SceneReport &report = plan.report;
  report.source = &source;
  report.specification = request.quick ? source.quick_scene : source.scene;
  report.scene = load_scene(report.specification);
  report.duration = request.quick ? source.quick_duration : source.duration;
  report.metric = request.metric.value_or(source.metric);
  plan.refinement = refinement_of(source, request.quick);
  for (const std::string &solver : request.solvers)
    for (const Settings &settings : settings_grid(solver, request.quick ? Grid::quick : source.grid))
      plan.settings.push_back(settings);
  plan.estimate = estimate_scene(report.scene, report.duration, plan.refinement, request.backends, request.solvers);
  return plan;
}

std::vector<Planned> plan_scenes(const ReportRequest &request)
{
  std::vector<Planned> plans;
  for (const ReportCase *source : request.cases) plans.push_back(plan_scene(*source, request));
  return plans;
}

/* Nothing is timed during these runs, so all reference solutions are computed at once. */
double truth_seconds(const std::vector<Planned> &plans)
{
  double sum = 0, longest = 0;
  for (const Planned &plan : plans) {
    sum += plan.estimate.truth_seconds;
    longest = std::max(longest, plan.estimate.longest_truth_seconds);
  }
  return std::max(longest, sum / static_cast<double>(processor_count()));
}

double total_seconds(const std::vector<Planned> &plans)
{
  double sum = truth_seconds(plans);
  for (const Planned &plan : plans) sum += plan.run_seconds();
  return sum;
}

void find_truths(std::vector<Planned> &plans)
{
  in_parallel(plans.size(), processor_count(), [&](size_t k) {
    SceneReport &report = plans[k].report;
    if (plans[k].refinement > 0) report.truth = find_truth(report.scene, report.duration, plans[k].refinement);
  });
}

/* The errors are computed on the fastest backend, the time on each. */
void run_scene(Planned &plan, const ReportRequest &request, Work &work)
{
  SceneReport &report = plan.report;
  for (const std::string &backend : request.backends) report.backends.push_back({backend, {}, {}});
  const size_t observer = plan.estimate.fastest_backend();
  for (const Settings &settings : plan.settings) {
    const Run observed =
        run_experiment(report.scene, report.duration, report.truth, settings, request.backends[observer]);
    for (size_t k = 0; k < request.backends.size(); ++k) {
      report.backends[k].runs.push_back(
          k == observer ? observed
                        : time_experiment(report.scene, report.duration, report.truth, observed, request.backends[k]));
      work.done(plan.estimate.run_seconds(k, settings, report.duration));
    }
  }
}

void evaluate(SceneReport &report)
{
  std::vector<std::vector<Run>> by_backend;
  for (BackendRuns &each : report.backends) {
    each.picks = pick_settings(each.runs, report.metric, report.uncertainty());
    by_backend.push_back(each.runs);
  }
  report.equal_errors = equal_errors(by_backend, report.metric, report.uncertainty());
}

std::vector<SceneReport> run_scenes(std::vector<Planned> plans, const ReportRequest &request)
{
  Work work(total_seconds(plans));
  find_truths(plans);
  work.done(truth_seconds(plans));
  std::vector<SceneReport> scenes;
  for (Planned &plan : plans) {
    run_scene(plan, request, work);
    evaluate(plan.report);
    scenes.push_back(std::move(plan.report));
  }
  return scenes;
}

std::string estimate_text(const std::vector<Planned> &plans, const ReportRequest &request)
{
  size_t runs = 0;
  for (const Planned &plan : plans) runs += plan.settings.size() * request.backends.size();
  std::string text = fmt::format("{} runs of {} scenes on {}: about {}", runs, plans.size(),
                                 fmt::join(request.backends, ", "), duration_text(total_seconds(plans)));
  for (const Planned &plan : plans)
    text += fmt::format(", {} {}", plan.report.source->name, duration_text(plan.run_seconds()));
  return text + fmt::format(", truths {}", duration_text(truth_seconds(plans)));
}

Scene moved(Scene scene, double far)
{
  for (Body &body : scene.bodies) body.position[0] += far;
  return scene;
}

void collect_rounding(Report &report)
{
  RoundingReport &rounding = report.rounding;
  rounding.scene = report.request.quick ? "mixed:n=20" : "mixed:n=100";
  rounding.far = 20000;
  RoundingRequest request;
  request.steps = report.request.quick ? 60 : 120;
  request.every = report.request.quick ? 30 : 20;
  const Scene scene = load_scene(rounding.scene);
  rounding.candidate_table = measure_rounding(scene, request);
  rounding.far_table = measure_rounding(moved(scene, rounding.far), request);
}

/* A target error in readable form: "1 mm", "0.001 rad", "1e-06". */
std::string amount_text(double value, const std::string &unit)
{
  if (unit != "m") return unit == "relative" ? fmt::format("{:.3g}", value) : fmt::format("{:.3g} {}", value, unit);
  if (value >= 1) return fmt::format("{:.3g} m", value);
  if (value >= 0.999e-3) return fmt::format("{:.3g} mm", value * 1e3);
  if (value >= 0.999e-6) return fmt::format("{:.3g} um", value * 1e6);
  return fmt::format("{:.3g} nm", value * 1e9);
}

/* "RMS" is pronounced letter by letter, so it takes "an". */
const char *article_of(const std::string &label)
{
  return std::string("aeiouR").find(label.front()) == std::string::npos ? "a" : "an";
}

} // namespace

double SceneReport::uncertainty() const
{
  if (metric == Metric::position) return truth.uncertainty_position();
  if (metric == Metric::rotation) return truth.uncertainty_rotation();
  return 0;
}

std::vector<Pick> pick_settings(std::vector<Run> &runs, Metric metric, double uncertainty)
{
  std::vector<Tradeoff> points;
  for (const Run &run : runs) points.push_back({run.cost(), run.error(metric)});
  for (Run &run : runs) run.front = false;
  for (const size_t i : pareto_front(points)) runs[i].front = true;
  std::vector<Pick> picks;
  for (const double target_error : sensible_wishes(points, most_picks)) {
    const auto run = cheapest_within(points, target_error);
    if (target_error < uncertainty || !run) continue;
    if (!picks.empty() && picks.back().run == *run) picks.pop_back(); /* the same setting also keeps the finer error */
    picks.push_back({target_error, *run});
  }
  return picks;
}

std::string pick_sentence(const std::vector<Run> &runs, const std::vector<Pick> &picks, Metric metric)
{
  const MetricName &name = name_of(metric);
  if (picks.empty()) return "No setting gives a finite error here: there is nothing to pick.";
  std::string sentence;
  for (size_t k = 0; k < picks.size(); ++k) {
    const Run &run = runs[picks[k].run];
    const std::string choice =
        fmt::format("{} with {} ({:.3g} ms for 1/60 s)", run.solver, short_text(run.settings), run.cost());
    sentence += k == 0 ? fmt::format("For {} {} of at most {} take {}", article_of(name.label), name.label,
                                     amount_text(picks[k].target_error, name.unit), choice)
                       : fmt::format("; for {} {}", amount_text(picks[k].target_error, name.unit), choice);
  }
  return sentence + ".";
}

std::string run_command_of(const SceneReport &scene, const Run &run)
{
  std::string command =
      fmt::format("tandem run {} --on {} --solver {} --substeps {} --iterations {} --steps {}", scene.specification,
                  run.backend, run.solver, run.settings.substeps, run.settings.iterations, run.steps);
  return run.settings.step == base_step ? command : command + " --dt " + step_text(run.settings);
}

size_t Report::unequal() const
{
  size_t count = 0;
  for (const SceneReport &scene : scenes)
    for (const BackendRuns &each : scene.backends)
      count += static_cast<size_t>(std::ranges::count_if(each.runs, &Run::unequal));
  return count;
}

std::vector<SceneReport> collect_scenes(const ReportRequest &request)
{
  return run_scenes(plan_scenes(request), request);
}

Report collect_report(const ReportRequest &request)
{
  Report report;
  report.request = request;
  report.machine = machine_text();
  report.date = date_text();
  for (const std::string &backend : request.backends)
    make_backend(backend); /* reports a bad name before anything runs */
  std::vector<Planned> plans = plan_scenes(request);
  report.estimate = estimate_text(plans, request);
  if (!plans.empty()) fmt::print(stderr, "{}\n", report.estimate);
  report.scenes = run_scenes(std::move(plans), request);
  if (request.with_problems)
    report.contact_curves = contact_curves(request.problems, request.backends.front(), request.quick);
  if (request.with_joints) report.joints = joint_curves(request.backends.front(), request.quick);
  if (request.with_rounding) collect_rounding(report);
  return report;
}

} // namespace tandem
