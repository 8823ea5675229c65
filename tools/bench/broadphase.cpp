/* broadphase.cpp - runs, times and compares broadphases, and formats the results; see broadphase.h. */
#include "tools/bench/broadphase.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "host/runtime/make_backend.h"
#include "tools/bench/broadphase_frames.h"
#include "tools/command/distinct_files.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"
#include "tools/plot/chart.h"

namespace tandem {
namespace {

/* Short frames are timed more often than the least number, because some frames cost more than others if data is kept
 * from frame to frame. */
constexpr uint32_t warm_frames = 2, timed_frames = 9, most_timed_frames = 30;
constexpr double enough_milliseconds = 3000;
constexpr uint32_t most_by_brute_force = 16384; /* its work grows with the square */
constexpr double longest_milliseconds = 5000;   /* of a frame: 11 of them are a minute */
constexpr const char *oracle = "brute-force";

std::vector<TimeAt> times_of(const std::vector<BroadphaseRun> &runs, const std::string &broadphase)
{
  std::vector<TimeAt> times;
  for (const BroadphaseRun &run : runs)
    if (run.broadphase == broadphase && run.skipped.empty())
      times.push_back({double(run.bodies), spread_of(run.milliseconds).median});
  return times;
}

bool was_too_slow(const std::vector<BroadphaseRun> &runs, const std::string &broadphase)
{
  return std::any_of(runs.begin(), runs.end(),
                     [&](const BroadphaseRun &run) { return run.broadphase == broadphase && !run.skipped.empty(); });
}

/* Empty if there is no reason. */
std::string reason_to_skip(const std::vector<BroadphaseRun> &smaller, const std::string &broadphase, uint32_t bodies)
{
  if (broadphase == oracle && bodies > most_by_brute_force) return fmt::format("over {}: skipped", most_by_brute_force);
  const std::optional<double> expected = predicted_milliseconds(times_of(smaller, broadphase), bodies);
  const bool slow = was_too_slow(smaller, broadphase) || (expected && *expected > longest_milliseconds);
  return slow ? "too slow: skipped" : "";
}

void run_frames(BroadphaseRun &run, BroadphaseFrames &frames, const std::function<void()> &after_frame)
{
  double spent = 0;
  for (uint32_t frame = 0;
       frame < warm_frames + timed_frames || (spent < enough_milliseconds && frame < warm_frames + most_timed_frames);
       ++frame) {
    const double milliseconds = frames.run(frame);
    run.pairs.push_back(frames.pairs());
    run.hashes.push_back(frames.hash());
    if (frame < warm_frames + timed_frames) after_frame();
    if (frame >= warm_frames) {
      run.milliseconds.push_back(milliseconds);
      spent += milliseconds;
    } else if (frame + 1 == warm_frames &&
               milliseconds > longest_milliseconds) { /* smaller numbers of bodies did not predict it */
      run.skipped = "too slow: stopped";
      return;
    }
  }
}

/* The first frame in which two lists differ. Of a run that was skipped after its warm-up frames, only these are
 * compared. */
std::string difference_between(const BroadphaseRun &run, const BroadphaseRun &reference)
{
  const size_t frames = std::min(run.hashes.size(), reference.hashes.size());
  for (size_t frame = 0; frame < frames; ++frame)
    if (run.hashes[frame] != reference.hashes[frame])
      return fmt::format("{} gives other pairs than {} in frame {}: {} and {}", run.broadphase, reference.broadphase,
                         frame, run.pairs[frame], reference.pairs[frame]);
  return "";
}

/* Compares with the reference broadphase, or else with the first that ran. */
void compare(std::vector<BroadphaseRun> &runs)
{
  const BroadphaseRun *reference = nullptr;
  for (const BroadphaseRun &run : runs)
    if (!run.hashes.empty() && (!reference || run.broadphase == oracle)) reference = &run;
  for (BroadphaseRun &run : runs)
    if (reference && &run != reference) run.difference = difference_between(run, *reference);
}

std::vector<BroadphaseRun> run_all(const BroadphaseRequest &request, const BroadphaseInput &input, uint32_t bodies,
                                   const std::vector<BroadphaseRun> &smaller, Backend &backend)
{
  std::vector<BroadphaseRun> runs;
  uint64_t wanted = 0, done = 0;
  for (const BroadphaseRow &broadphase : request.broadphases) {
    runs.push_back({broadphase.name, bodies, reason_to_skip(smaller, broadphase.name, bodies), {}, {}, {}, {}});
    if (runs.back().skipped.empty()) wanted += warm_frames + timed_frames;
  }
  if (wanted == 0) return runs;
  const MovingBodies moving(input, bodies);
  Progress progress(fmt::format("{}, {} bodies", input.name, bodies), wanted);
  for (size_t k = 0; k < runs.size(); ++k) {
    if (!runs[k].skipped.empty()) continue;
    BroadphaseFrames frames(moving, request.broadphases[k], backend);
    run_frames(runs[k], frames, [&] { progress.update(++done); });
  }
  progress.clear();
  compare(runs);
  return runs;
}

template <class Value> std::vector<Value> distinct(const BroadphaseScene &scene, Value BroadphaseRun::*field)
{
  std::vector<Value> values;
  for (const BroadphaseRun &run : scene.runs)
    if (std::find(values.begin(), values.end(), run.*field) == values.end()) values.push_back(run.*field);
  return values;
}

const BroadphaseRun &run_of(const BroadphaseScene &scene, const std::string &broadphase, uint32_t bodies)
{
  return *std::find_if(scene.runs.begin(), scene.runs.end(),
                       [&](const BroadphaseRun &run) { return run.broadphase == broadphase && run.bodies == bodies; });
}

std::string cell_text(const BroadphaseRun &run)
{
  if (!run.difference.empty()) return "WRONG";
  return run.skipped.empty() ? fmt::format("{:.3f}", spread_of(run.milliseconds).median) : run.skipped;
}

std::string slope_text(const std::optional<double> &slope) { return slope ? fmt::format("{:.2f}", *slope) : ""; }

/* The pairs of the last frame that all broadphases run. */
std::optional<uint32_t> last_pairs(const BroadphaseRun &run)
{
  if (run.pairs.empty()) return {};
  return run.pairs[std::min<size_t>(run.pairs.size(), warm_frames + timed_frames) - 1];
}

std::string pairs_text(const BroadphaseScene &scene, uint32_t bodies)
{
  for (const BroadphaseRun &run : scene.runs)
    if (run.bodies == bodies && last_pairs(run)) return fmt::format("{}", *last_pairs(run));
  return "";
}

double mean_of(const std::vector<double> &values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) / double(std::max<size_t>(values.size(), 1));
}

Json run_json(const BroadphaseRun &run)
{
  const Spread time = spread_of(run.milliseconds);
  const bool ran = run.skipped.empty();
  return {{"broadphase", run.broadphase},
          {"n", run.bodies},
          {"pairs", last_pairs(run) ? Json(*last_pairs(run)) : Json(nullptr)},
          {"ms", ran ? Json{{"median", time.median},
                            {"mean", mean_of(run.milliseconds)},
                            {"min", time.minimum},
                            {"max", time.maximum}}
                     : Json(nullptr)},
          {"frames_ms", run.milliseconds},
          {"skipped", ran ? Json(nullptr) : Json(run.skipped)},
          {"difference", run.difference.empty() ? Json(nullptr) : Json(run.difference)}};
}

Chart chart_of(const BroadphaseScene &scene, const std::string &backend)
{
  Chart chart{fmt::format("pairs of bounds: {}, on {}", scene.input->name, backend),
              {"bodies", AxisScale::logarithmic},
              {"ms a frame", AxisScale::logarithmic}};
  for (const std::string &name : distinct(scene, &BroadphaseRun::broadphase)) {
    ChartSeries series{name};
    for (const TimeAt &time : times_of(scene.runs, name))
      series.points.push_back(
          {time.bodies, time.milliseconds,
           fmt::format("{} pairs", last_pairs(run_of(scene, name, uint32_t(time.bodies))).value_or(0))});
    chart.series.push_back(series);
  }
  return chart;
}

constexpr const char *broadphase_time = "from bounds that are ready to the sorted pair list";

void print_scene(const BroadphaseScene &scene)
{
  fmt::print("{}\n", broadphase_text(scene));
  std::fflush(stdout);
}

} // namespace

BroadphaseRequest broadphase_request(const std::vector<std::string> &names, const std::vector<std::string> &scenes)
{
  BroadphaseRequest request;
  const auto wanted = [](const std::vector<std::string> &list, const char *name) {
    return list.empty() || std::find(list.begin(), list.end(), name) != list.end();
  };
  for (const std::string &scene : scenes) broadphase_input_named(scene);
  for (const BroadphaseRow &broadphase : broadphases())
    if (wanted(names, broadphase.name)) request.broadphases.push_back(broadphase);
  for (const BroadphaseInput &input : broadphase_inputs())
    if (wanted(scenes, input.name)) request.inputs.push_back(&input);
  return request;
}

std::vector<BroadphaseScene> bench_broadphase(const BroadphaseRequest &request,
                                              const std::function<void(const BroadphaseScene &)> &after_scene)
{
  const std::unique_ptr<Backend> backend = make_backend(request.backend, request.allow_inexact);
  std::vector<BroadphaseScene> scenes;
  for (const BroadphaseInput *input : request.inputs) {
    BroadphaseScene scene{input, {}};
    for (uint32_t bodies : request.bodies) {
      const std::vector<BroadphaseRun> runs = run_all(request, *input, bodies, scene.runs, *backend);
      scene.runs.insert(scene.runs.end(), runs.begin(), runs.end());
    }
    if (after_scene) after_scene(scene);
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

std::optional<double> slope_of(const std::vector<TimeAt> &times)
{
  if (times.size() < 2) return {};
  const TimeAt &last = times.back(), &before = times[times.size() - 2];
  return std::log(last.milliseconds / before.milliseconds) / std::log(last.bodies / before.bodies);
}

std::optional<double> predicted_milliseconds(const std::vector<TimeAt> &times, double bodies)
{
  if (times.empty()) return {};
  const double slope = std::clamp(slope_of(times).value_or(2), 1.0, 2.0);
  return times.back().milliseconds * std::pow(bodies / times.back().bodies, slope);
}

std::vector<std::string> differences_of(const std::vector<BroadphaseScene> &scenes)
{
  std::vector<std::string> lines;
  for (const BroadphaseScene &scene : scenes)
    for (const BroadphaseRun &run : scene.runs)
      if (!run.difference.empty())
        lines.push_back(fmt::format("{}, {} bodies: {}", scene.input->name, run.bodies, run.difference));
  return lines;
}

std::string broadphase_text(const BroadphaseScene &scene)
{
  const std::vector<uint32_t> sizes = distinct(scene, &BroadphaseRun::bodies);
  std::vector<std::string> header{"bodies"}, pairs{"pairs"};
  for (uint32_t bodies : sizes) {
    header.push_back(fmt::format("{}", bodies));
    pairs.push_back(pairs_text(scene, bodies));
  }
  if (sizes.size() > 1) header.push_back("slope"), pairs.push_back("");
  Table table(header);
  for (const std::string &name : distinct(scene, &BroadphaseRun::broadphase)) {
    std::vector<std::string> cells{name};
    for (uint32_t bodies : sizes) cells.push_back(cell_text(run_of(scene, name, bodies)));
    if (sizes.size() > 1) cells.push_back(slope_text(slope_of(times_of(scene.runs, name))));
    table.add(cells);
  }
  table.add(pairs);
  return fmt::format("{}: {}\n{}", scene.input->name, scene.input->what, table.text("  "));
}

Json broadphase_json(const BroadphaseScene &scene)
{
  Json json = {
      {"name", scene.input->name}, {"what", scene.input->what}, {"runs", Json::array()}, {"slopes", Json::object()}};
  for (const BroadphaseRun &run : scene.runs) json["runs"].push_back(run_json(run));
  for (const std::string &name : distinct(scene, &BroadphaseRun::broadphase)) {
    const std::optional<double> slope = slope_of(times_of(scene.runs, name));
    json["slopes"][name] = slope ? Json(*slope) : Json(nullptr);
  }
  return json;
}

std::string broadphase_chart(const std::vector<BroadphaseScene> &scenes, const std::string &backend)
{
  std::vector<Chart> charts;
  for (const BroadphaseScene &scene : scenes) charts.push_back(chart_of(scene, backend));
  return svg_of(charts);
}

int execute_broadphase(const BenchOptions &options)
{
  BroadphaseRequest request = broadphase_request(options.broadphases, options.scenes);
  request.backend = options.on;
  request.allow_inexact = options.inexact;
  request.bodies = {1000, 10000, 100000, 1000000};
  if (!options.count.empty())
    request.bodies = {static_cast<uint32_t>(whole_number("--n", options.count, 2, most_bodies))};
  DistinctFiles files;
  options.json.check(files);
  files.writes("--chart", options.chart);
  const bool prints = !options.json.takes_standard_output();
  const std::vector<BroadphaseScene> scenes = bench_broadphase(
      request, prints ? print_scene : [](const BroadphaseScene &) {});
  if (prints) fmt::print("on {}: medians, ms a frame, {}\n", options.on, broadphase_time);
  const std::vector<std::string> differences = differences_of(scenes);
  Json json = {{"what", options.what},
               {"backend", options.on},
               {"timed", broadphase_time},
               {"equal", differences.empty()},
               {"scenes", Json::array()}};
  for (const BroadphaseScene &scene : scenes) json["scenes"].push_back(broadphase_json(scene));
  options.json.write(json);
  if (!options.chart.empty()) write_file("--chart", options.chart, broadphase_chart(scenes, options.on));
  for (const std::string &line : differences) fmt::print(stderr, "tandem: {}\n", line);
  return differences.empty() ? 0 : 1;
}

} // namespace tandem
