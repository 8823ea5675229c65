/* collect.cpp - see collect.h. */
#include "tools/report/collect.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/info.h>

#include "host/scene_catalog.h"
#include "tools/progress.h"
#include "tools/report/contact_curves.h"

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

/* Counts runs and frames of truths; a frame of the truth weighs about as much as a run. */
class Work {
public:
  explicit Work(uint64_t total) : progress_("reporting", total) {}
  void done() { progress_.update(++done_); }

private:
  Progress progress_;
  uint64_t done_ = 0;
};

double duration_of(const ReportCase &source, bool quick) { return quick ? source.quick_duration : source.duration; }
uint32_t refinement_of(const ReportCase &source, bool quick) { return quick ? 16 : source.refinement; }

std::vector<Settings> all_settings(const ReportRequest &request)
{
  std::vector<Settings> all;
  for (const std::string &solver : request.solvers)
    for (const Settings &settings : settings_grid(solver, request.quick)) all.push_back(settings);
  return all;
}

/* The scene that compares backends: the last of those reported with many contacts, else the last. */
const SceneReport *scene_for_backends(const std::vector<SceneReport> &scenes)
{
  for (const char *wanted : {"box-grid", "pyramid", "mixed"})
    for (const SceneReport &scene : scenes)
      if (scene.source->name == std::string(wanted)) return &scene;
  return scenes.empty() ? nullptr : &scenes.back();
}

uint64_t work_of(const ReportRequest &request)
{
  uint64_t work = request.backends.size() * settings_grid(request.solvers.front(), request.quick).size() + 2;
  for (const ReportCase *source : request.cases) work += 4 * frames_in(duration_of(*source, request.quick)) + all_settings(request).size();
  return work;
}

SceneReport collect_scene(const ReportCase &source, const ReportRequest &request, Work &work)
{
  SceneReport report;
  report.source = &source;
  report.specification = request.quick ? source.quick_scene : source.scene;
  report.scene = load_scene(report.specification);
  report.duration = duration_of(source, request.quick);
  report.metric = request.metric.value_or(source.metric);
  report.truth = find_truth(report.scene, report.duration, refinement_of(source, request.quick), [&] { work.done(); });
  for (const Settings &settings : all_settings(request)) {
    report.runs.push_back(run_experiment(report.scene, report.duration, report.truth, settings, request.backends.front()));
    work.done();
  }
  report.picks = pick_settings(report.runs, report.metric, report.uncertainty());
  return report;
}

void collect_backends(Report &report, Work &work)
{
  const SceneReport *scene = scene_for_backends(report.scenes);
  if (!scene || report.request.backends.size() < 2) return;
  report.backend_scene = scene->specification;
  report.backend_metric = scene->metric;
  for (const std::string &backend : report.request.backends)
    for (const Settings &settings : settings_grid(report.request.solvers.front(), report.request.quick)) {
      report.by_backend.push_back(run_experiment(scene->scene, scene->duration, scene->truth, settings, backend));
      work.done();
    }
}

Scene moved(Scene scene, double far)
{
  for (Body &body : scene.bodies) body.position[0] = static_cast<float>(double{body.position[0]} + far);
  return scene;
}

void collect_rounding(Report &report, Work &work)
{
  RoundingReport &rounding = report.rounding;
  rounding.scene = report.request.quick ? "mixed:n=20" : "mixed:n=100";
  rounding.far = 20000;
  RoundingRequest request;
  request.steps = report.request.quick ? 60 : 120;
  request.every = report.request.quick ? 30 : 20;
  const Scene scene = load_scene(rounding.scene);
  rounding.near_table = measure_rounding(scene, request);
  work.done();
  rounding.far_table = measure_rounding(moved(scene, rounding.far), request);
  work.done();
}

/* "1 mm", "0.001 rad", "1e-06": a wished error as one says it. */
std::string amount_text(double value, const std::string &unit)
{
  if (unit != "m") return unit == "relative" ? fmt::format("{:.3g}", value) : fmt::format("{:.3g} {}", value, unit);
  if (value >= 1) return fmt::format("{:.3g} m", value);
  if (value >= 0.999e-3) return fmt::format("{:.3g} mm", value * 1e3);
  if (value >= 0.999e-6) return fmt::format("{:.3g} um", value * 1e6);
  return fmt::format("{:.3g} nm", value * 1e9);
}

/* "RMS" is read letter by letter: an R. */
const char *article_of(const std::string &label) { return std::string("aeiouR").find(label.front()) == std::string::npos ? "a" : "an"; }

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
  for (const double wished : sensible_wishes(points, most_picks)) {
    const auto run = cheapest_within(points, wished);
    if (wished < uncertainty || !run) continue;
    if (!picks.empty() && picks.back().run == *run) picks.pop_back(); /* the same setting keeps a finer error too */
    picks.push_back({wished, *run});
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
    const std::string choice = fmt::format("{} with {} ({:.3g} ms for 1/60 s)", run.solver, short_text(run.settings), run.cost());
    sentence += k == 0 ? fmt::format("For {} {} of at most {} take {}", article_of(name.label), name.label, amount_text(picks[k].wished, name.unit), choice)
                       : fmt::format("; for {} {}", amount_text(picks[k].wished, name.unit), choice);
  }
  return sentence + ".";
}

std::string run_command_of(const SceneReport &scene, const Run &run)
{
  std::string command = fmt::format("tandem run {} --on {} --solver {} --substeps {} --iterations {} --steps {}", scene.specification, run.backend,
                                    run.solver, run.settings.substeps, run.settings.iterations, run.steps);
  return run.settings.step == base_step ? command : command + " --dt " + step_text(run.settings);
}

Report collect_report(const ReportRequest &request)
{
  Report report;
  report.request = request;
  report.machine = machine_text();
  report.date = date_text();
  for (const std::string &backend : request.backends) make_backend(backend); /* a bad name is said before anything runs */
  Work work(work_of(request));
  for (const ReportCase *source : request.cases) report.scenes.push_back(collect_scene(*source, request, work));
  collect_backends(report, work);
  report.contact_curves = contact_curves(request.problems, request.backends.front(), request.quick);
  collect_rounding(report, work);
  return report;
}

} // namespace tandem
