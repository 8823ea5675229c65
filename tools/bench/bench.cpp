/* bench.cpp - `tandem bench`: measures how fast one part of the pipeline runs by itself, on any backend. */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "tools/bench/batching.h"
#include "tools/bench/bodies.h"
#include "tools/bench/broadphase.h"
#include "tools/bench/floors.h"
#include "tools/bench/left_out.h"
#include "tools/bench/narrowphase.h"
#include "tools/bench/primitives.h"
#include "tools/bench/rays.h"
#include "tools/bench/scenes.h"
#include "tools/bench/sizes.h"
#include "tools/bench/sleeping.h"
#include "tools/bench/snapshots.h"
#include "tools/bench/starts.h"
#include "tools/bench/support.h"
#include "tools/bench/worlds.h"
#include "tools/command/command.h"
#include "tools/command/marked_table.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

struct BenchOptions {
  std::string what, on = "tbb", count, steps, chart, table;
  std::vector<std::string> pairs, broadphases, scenes, beside;
  bool inexact = false;
  JsonOutput json;
};

struct Result {
  uint64_t items = 0;
  std::string item; /* what is counted: "pairs", "bodies" */
  Spread milliseconds;
  Json details = Json::object(); /* further keys of the JSON */
};

/* Runs a cube of about so many boxes. The benchmark of the step always uses the same scene. */
Result bench_step(const BenchOptions &options, uint64_t count)
{
  const auto side = static_cast<uint64_t>(std::max(1.0, std::round(std::cbrt(static_cast<double>(count)))));
  const std::string text = fmt::format("box-grid:nx={0},ny={0},nz={0}", side);
  World world(load_scene(text), Settings{}, Placement{options.on, {}, options.inexact});
  constexpr uint64_t steps = 120;
  Progress progress("simulating", steps);
  const Measurement measurement = measure(world, steps, [&](uint64_t done) { progress.update(done); });
  Result result{side * side * side, "bodies", measurement.step_milliseconds, {{"scene", text}}};
  result.details["stages"] = Json::array();
  for (const StageTime &stage : measurement.stages)
    result.details["stages"].push_back({{"name", stage.name}, {"backend", stage.backend}, {"ms", stage.milliseconds}});
  return result;
}

Result bench_primitive(const BenchOptions &options, uint64_t count)
{
  const bool sort = options.what == "sort";
  const auto items = static_cast<uint32_t>(count);
  const std::vector<double> times =
      sort ? bench_sort(options.on, items, options.inexact) : bench_scan(options.on, items, options.inexact);
  return {count, sort ? "pairs" : "numbers", spread_of(times)};
}

/* Runs every batcher on one list of contacts; the exit status is 1 if the check finds a wrong batch. */
int execute_batching(const BenchOptions &options)
{
  const uint64_t boxes = options.count.empty() ? 0 : whole_number("--n", options.count, 1, most_bodies);
  options.json.check();
  const std::vector<BatchScene> scenes = bench_batching(options.on, boxes, options.inexact);
  Json json = {{"what", options.what}, {"backend", options.on}, {"scenes", Json::array()}};
  bool right = true;
  for (const BatchScene &scene : scenes) {
    if (!options.json.takes_standard_output())
      fmt::print("{}on {}: {}", &scene == &scenes.front() ? "" : "\n", options.on, batch_text(scene));
    json["scenes"].push_back(batch_json(scene));
    for (const BatchTable &table : scene.tables) right = right && table.right;
  }
  options.json.write(json);
  return right ? 0 : 1;
}

constexpr const char *broadphase_time = "from bounds that are ready to the sorted pair list";

void print_scene(const BroadphaseScene &scene)
{
  fmt::print("{}\n", broadphase_text(scene));
  std::fflush(stdout);
}

/* The exit status is 1 if any two broadphases give different pairs. */
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

int execute_narrowphase(const BenchOptions &options)
{
  const uint64_t pairs = options.count.empty() ? 4096 : whole_number("--n", options.count, 1, most_bodies / 2);
  options.json.check();
  const std::vector<PairTime> times =
      bench_narrowphase(options.on, static_cast<uint32_t>(pairs), options.pairs, options.inexact);
  if (!options.json.takes_standard_output())
    fmt::print("{} on {}: {} pairs of each kind\n{}", options.what, options.on, pairs, narrowphase_text(times));
  options.json.write(
      {{"what", options.what}, {"backend", options.on}, {"n", pairs}, {"pairs", narrowphase_json(times)}});
  return 0;
}

constexpr uint32_t boxes_for_rays = 100000;

int execute_rays(const BenchOptions &options)
{
  const auto rays =
      static_cast<uint32_t>(options.count.empty() ? 1000000 : whole_number("--n", options.count, 1, uint64_t{1} << 26));
  options.json.check();
  const std::vector<RayTime> times = bench_rays(options.on, boxes_for_rays, rays, options.inexact);
  if (!options.json.takes_standard_output())
    fmt::print("rays on {}: {} rays, {} boxes\n{}", options.on, rays, boxes_for_rays, rays_text(times, rays));
  options.json.write({{"what", options.what},
                      {"backend", options.on},
                      {"n", rays},
                      {"boxes", boxes_for_rays},
                      {"times", rays_json(times, rays)}});
  return 0;
}

int execute_snapshots(const BenchOptions &options)
{
  std::vector<uint64_t> counts{1000, 10000, 100000};
  if (!options.count.empty()) counts = {whole_number("--n", options.count, 1, most_bodies)};
  options.json.check();
  std::vector<SnapshotTimes> times;
  for (const uint64_t count : counts) times.push_back(bench_snapshots(options.on, count, options.inexact));
  if (!options.json.takes_standard_output())
    fmt::print("snapshots on {}: medians, the wait for the device included\n{}", options.on, snapshots_text(times));
  options.json.write({{"what", options.what}, {"backend", options.on}, {"worlds", snapshots_json(times)}});
  return 0;
}

int execute_sleeping(const BenchOptions &options)
{
  std::vector<uint64_t> counts{1000, 10000, 100000};
  if (!options.count.empty()) counts = {whole_number("--n", options.count, 40, most_bodies)};
  options.json.check();
  std::vector<SleepTimes> times;
  for (const uint64_t count : counts) times.push_back(bench_sleeping(options.on, count, options.inexact));
  if (!options.json.takes_standard_output())
    fmt::print("sleeping on {}: medians, the wait for the device included\n{}", options.on, sleeping_text(times));
  options.json.write({{"what", options.what}, {"backend", options.on}, {"worlds", sleeping_json(times)}});
  return 0;
}

int execute_bodies(const BenchOptions &options)
{
  std::vector<uint64_t> counts{1000, 10000};
  if (!options.count.empty()) counts = {whole_number("--n", options.count, 1, most_bodies)};
  options.json.check();
  std::vector<BodyTimes> times;
  for (const uint64_t count : counts) times.push_back(bench_bodies(options.on, count, options.inexact));
  if (!options.json.takes_standard_output())
    fmt::print("bodies on {}: medians, the wait for the device included\n{}", options.on, bodies_text(times));
  options.json.write({{"what", options.what}, {"backend", options.on}, {"worlds", bodies_json(times)}});
  return 0;
}

int execute_worlds(const BenchOptions &options)
{
  std::optional<uint32_t> worlds;
  if (!options.count.empty()) worlds = static_cast<uint32_t>(whole_number("--n", options.count, 1, most_bodies / 16));
  options.json.check();
  const std::vector<WorldsTime> times = bench_worlds(options.on, worlds, options.inexact);
  if (!options.json.takes_standard_output())
    fmt::print("worlds on {}: medians, the wait for the device included\n{}", options.on, worlds_text(times));
  options.json.write({{"what", options.what}, {"backend", options.on}, {"batches", worlds_json(times)}});
  return 0;
}

/* The command line that repeats the run, for the page that gets its table. */
std::string scenes_command_text(const BenchOptions &options)
{
  std::string text = fmt::format("tandem bench {} --on {}", options.what, options.on);
  if (!options.scenes.empty()) text += fmt::format(" --scene {}", fmt::join(options.scenes, ","));
  if (!options.steps.empty()) text += " --steps " + options.steps;
  return text + " --table-in " + options.table;
}

ScenesRequest scenes_request(const BenchOptions &options)
{
  ScenesRequest request;
  request.scenes = scene_names(options.scenes);
  request.placement = {options.on, {}, options.inexact};
  if (!options.steps.empty()) request.steps = whole_number("--steps", options.steps, 1, 100000);
  return request;
}

/* The exit status is 1 if a scene failed; its row says so, and those of the others stand. */
int execute_scenes(const BenchOptions &options)
{
  const ScenesRequest request = scenes_request(options);
  const MarkedTable table{options.table, options.on}; /* a page may have a table of each backend */
  DistinctFiles files;
  options.json.check(files);
  table.check(files);
  const std::vector<SceneCost> costs = bench_scenes(request);
  if (!options.json.takes_standard_output())
    fmt::print("scenes on {}: medians of {} steps after {}\n{}", options.on, request.steps, scene_warm_steps,
               scenes_text(costs));
  table.write(fmt::format("```\n{}\n```\n{}", scenes_command_text(options), scenes_markdown(costs)));
  options.json.write({{"what", options.what},
                      {"backend", options.on},
                      {"steps", request.steps},
                      {"kernels", kernel_count},
                      {"scenes", scenes_json(costs)}});
  const std::vector<std::string> failures = failures_of(costs);
  for (const std::string &line : failures) fmt::print(stderr, "tandem: {}\n", line);
  return failures.empty() ? 0 : 1;
}

/* The exit status is 1 if a row has no costs. */
int execute_left_out(const BenchOptions &options)
{
  const ScenesRequest request = scenes_request(options);
  const MarkedTable table{options.table, "left-out " + options.on};
  DistinctFiles files;
  options.json.check(files);
  table.check(files);
  const std::vector<LeftOut> rows = bench_left_out(request);
  if (!options.json.takes_standard_output())
    fmt::print("left out on {}: {} steps after {}, launches by their median, times by their least\n{}", options.on,
               request.steps, scene_warm_steps, left_out_text(rows));
  table.write(fmt::format("```\n{}\n```\n{}", scenes_command_text(options), left_out_markdown(rows)));
  options.json.write({{"what", options.what},
                      {"backend", options.on},
                      {"steps", request.steps},
                      {"features", scene_feature_names()},
                      {"rows", left_out_json(rows)}});
  const std::vector<std::string> failures = failures_of(rows);
  for (const std::string &line : failures) fmt::print(stderr, "tandem: {}\n", line);
  return failures.empty() ? 0 : 1;
}

/* A scene may have parameters, whose commas part the option. */
std::string floors_scene(const BenchOptions &options)
{
  return options.scenes.empty() ? "box-grid" : fmt::format("{}", fmt::join(options.scenes, ","));
}

int execute_floors(const BenchOptions &options)
{
  const std::string scene = floors_scene(options);
  const MarkedTable table{options.table, "floors " + options.on};
  DistinctFiles files;
  options.json.check(files);
  table.check(files);
  const Floors floors = bench_floors(scene, {options.on, {}, options.inexact});
  if (!options.json.takes_standard_output()) fmt::print("{}", floors_text(floors));
  table.write(fmt::format("```\ntandem bench floors --on {} --scene {} --table-in {}\n```\n{}", options.on, scene,
                          options.table, floors_markdown(floors)));
  Json json = floors_json(floors);
  json["what"] = options.what;
  json["backend"] = options.on;
  options.json.write(json);
  return 0;
}

/* Runs to show together: those of files behind the one that is made, unless --n is 0. */
std::vector<SizesRun> sizes_beside(const BenchOptions &options, DistinctFiles &files)
{
  std::vector<SizesRun> runs;
  for (const std::string &path : options.beside) {
    files.reads("--beside", path);
    runs.push_back(read_sizes(path));
  }
  return runs;
}

int execute_sizes(const BenchOptions &options)
{
  const uint64_t most = options.count.empty() ? most_of_sizes : whole_number("--n", options.count, 0, most_bodies);
  DistinctFiles files;
  std::vector<SizesRun> runs = sizes_beside(options, files);
  if (most < 8 && (most > 0 || runs.empty() || !options.json.path.empty()))
    throw InputError("--n: 8 boxes are the fewest; 0 draws the files of --beside alone, without --json");
  options.json.check(files);
  files.writes("--chart", options.chart);
  if (most > 0)
    runs.insert(runs.begin(), {"tandem, " + options.on, bench_sizes({options.on, {}, options.inexact}, most)});
  if (!options.json.takes_standard_output()) fmt::print("a step of box-grid, median\n{}", sizes_text(runs));
  if (most > 0) options.json.write(sizes_json(runs.front()));
  if (!options.chart.empty()) write_file("--chart", options.chart, sizes_chart(runs));
  return 0;
}

int execute_starts(const BenchOptions &options)
{
  const std::vector<std::string> scenes = start_scenes(options.scenes);
  const MarkedTable table{options.table, "starts " + options.on};
  DistinctFiles files;
  options.json.check(files);
  table.check(files);
  const std::vector<StartTime> starts = bench_starts(scenes, {options.on, {}, options.inexact});
  if (!options.json.takes_standard_output()) fmt::print("starts on {}:\n{}", options.on, starts_text(starts));
  table.write(fmt::format("```\ntandem bench starts --on {} --scene {} --table-in {}\n```\n{}", options.on,
                          fmt::join(scenes, ","), options.table, starts_markdown(starts)));
  options.json.write({{"what", options.what}, {"backend", options.on}, {"starts", starts_json(starts)}});
  return 0;
}

/* The exit status is 1 if hill climbing ever ends at another vertex. */
int execute_support(const BenchOptions &options)
{
  const uint64_t directions =
      options.count.empty() ? 200000 : whole_number("--n", options.count, 1000, uint64_t{1} << 28);
  options.json.check();
  const std::vector<SupportTime> times = bench_support(directions);
  if (!options.json.takes_standard_output())
    fmt::print("support: {} directions of each hull\n{}", directions, support_text(times));
  options.json.write({{"what", options.what}, {"n", directions}, {"hulls", support_json(times)}});
  return std::any_of(times.begin(), times.end(), [](const SupportTime &time) { return time.differences > 0; }) ? 1 : 0;
}

void print_result(const BenchOptions &options, const Result &result)
{
  const Spread &time = result.milliseconds;
  fmt::print("{} on {}: {} {}, {:.4f} ms (median; {:.4f} to {:.4f}), {:.4g} million a second\n", options.what,
             options.on, result.items, result.item, time.median, time.minimum, time.maximum,
             static_cast<double>(result.items) / std::max(time.median, 1e-9) * 1e-3);
  if (!result.details.contains("stages")) return;
  Table table({"stage", "ms/step", "backend"});
  for (const Json &stage : result.details["stages"])
    table.add({stage["name"], fmt::format("{:.3f}", stage["ms"].get<double>()), stage["backend"]});
  fmt::print("{}", table.text("  "));
}

Json result_json(const BenchOptions &options, const Result &result)
{
  const Spread &time = result.milliseconds;
  Json json = {{"what", options.what},
               {"backend", options.on},
               {"n", result.items},
               {"unit", result.item},
               {"ms", spread_json(time)},
               {"items_per_second", static_cast<double>(result.items) / std::max(time.median, 1e-9) * 1e3}};
  json.update(result.details);
  return json;
}

/* Benchmarks that measure one thing, a number of times. */
int execute_repeated(const BenchOptions &options)
{
  const bool step = options.what == "step";
  const uint64_t most = step ? most_bodies : uint64_t{1} << 28;
  const uint64_t count = options.count.empty() ? (step ? 1000 : 1 << 20) : whole_number("--n", options.count, 1, most);
  options.json.check();
  const Result result = step ? bench_step(options, count) : bench_primitive(options, count);
  if (!options.json.takes_standard_output()) print_result(options, result);
  options.json.write(result_json(options, result));
  return 0;
}

struct Benchmark {
  const char *name, *what;
  int (*execute)(const BenchOptions &);
};
constexpr Benchmark benchmarks[] = {
    {"sort", "32-bit keys with values", execute_repeated},
    {"scan", "of numbers", execute_repeated},
    {"broadphase", "every one on the same moving bodies", execute_broadphase},
    {"batching", "scenes of the talks; box-grid with --n", execute_batching},
    {"narrowphase", "pairs of shapes", execute_narrowphase},
    {"rays", "against 100,000 boxes", execute_rays},
    {"support", "farthest vertices of hulls", execute_support},
    {"snapshots", "states kept on the device, and saved to the host", execute_snapshots},
    {"sleeping", "one island awake among bodies that sleep", execute_sleeping},
    {"bodies", "that come and go, and one that is read", execute_bodies},
    {"worlds", "many small ones in a batch, and one after another", execute_worlds},
    {"scenes", "what every built-in scene takes: kernels, launches, memory, time", execute_scenes},
    {"left-out", "what a scene saves by each feature that it lacks", execute_left_out},
    {"floors", "bytes that each stage must move, and how long a copy of them takes", execute_floors},
    {"starts",
     "from nothing to the first step, and to the first on the device, with the caches of its driver off and "
     "filled",
     execute_starts},
    {"sizes", "box-grid from 8 boxes to millions", execute_sizes},
    {"step", "box-grid", execute_repeated},
};

std::vector<std::string> benchmark_names()
{
  std::vector<std::string> names;
  for (const Benchmark &benchmark : benchmarks) names.push_back(benchmark.name);
  return names;
}

std::string benchmarks_text()
{
  std::vector<std::string> texts;
  for (const Benchmark &benchmark : benchmarks) texts.push_back(fmt::format("{} ({})", benchmark.name, benchmark.what));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/* Throws InputError for options of one benchmark that are given to another. */
void check_options(const BenchOptions &options)
{
  const auto only_of = [&](const char *option, bool given, const std::vector<std::string> &takers) {
    if (given && std::find(takers.begin(), takers.end(), options.what) == takers.end())
      throw InputError(fmt::format("{} is of bench {}; bench {} has none, leave it out", option,
                                   fmt::join(takers, " and "), options.what));
  };
  only_of("--pairs", !options.pairs.empty(), {"narrowphase"});
  only_of("--broadphase", !options.broadphases.empty(), {"broadphase"});
  only_of("--chart", !options.chart.empty(), {"broadphase", "sizes"});
  only_of("--beside", !options.beside.empty(), {"sizes"});
  only_of("--scene", !options.scenes.empty(), {"broadphase", "scenes", "left-out", "floors", "starts"});
  only_of("--steps", !options.steps.empty(), {"scenes", "left-out"});
  only_of("--table-in", !options.table.empty(), {"scenes", "left-out", "floors", "starts"});
  if ((options.what == "floors" || options.what == "starts") && !options.count.empty())
    throw InputError(fmt::format("--n: bench {} takes the size from --scene, as --scene spheres:n=1000; leave it out",
                                 options.what));
  if ((options.what == "scenes" || options.what == "left-out") && !options.count.empty())
    throw InputError(fmt::format(
        "--n: the scenes of bench {} have the numbers of bodies of `tandem scenes`; leave it out", options.what));
}

int execute(const BenchOptions &options)
{
  check_options(options);
  for (const Benchmark &benchmark : benchmarks)
    if (options.what == benchmark.name) return benchmark.execute(options);
  throw InputError(
      fmt::format("bench '{}' is unknown; use one of {}", options.what, fmt::join(benchmark_names(), ", ")));
}

} // namespace

Command bench_command(CLI::App &parser)
{
  CLI::App *command =
      parser.add_subcommand("bench", fmt::format("time one part by itself: {}", fmt::join(benchmark_names(), ", ")));
  auto options = std::make_shared<BenchOptions>();
  command->add_option("WHAT", options->what, benchmarks_text())->required()->type_name("");
  command->add_option("--on", options->on, "backend")->type_name("B")->capture_default_str();
  command
      ->add_option("--n", options->count,
                   "how many: 1048576 keys, 1000 to 1000000 bodies of broadphase, 1000000 rays, 4096 pairs of each "
                   "kind, 1000 to 100000 bodies of snapshots and sleeping, 1000 and 10000 of bodies, 1024 and 4096 "
                   "worlds, 1000 bodies of step, at most 64000 of sizes (0: --beside alone) unless given")
      ->type_name("N");
  command->add_option("--pairs", options->pairs, "narrowphase: these kinds alone, as box-box,hull32-hull32")
      ->delimiter(',')
      ->check(CLI::IsMember(bench_pair_names()))
      ->type_name("KIND,...");
  command->add_option("--broadphase", options->broadphases, "broadphase: these alone, as grid,bvh")
      ->delimiter(',')
      ->check(CLI::IsMember(choice_names<Broadphase>()))
      ->type_name("NAME,...");
  command
      ->add_option("--scene", options->scenes,
                   "broadphase: these inputs alone, as spheres,pile; scenes, left-out: these built-in scenes "
                   "alone; floors: one scene with its parameters; starts: scenes with their parameters")
      ->delimiter(',')
      ->type_name("NAME,...");
  command
      ->add_option("--steps", options->steps,
                   fmt::format("scenes, left-out: how many steps are timed, after {} of warm-up; {} unless given",
                               scene_warm_steps, scene_timed_steps))
      ->type_name("N");
  command
      ->add_option("--table-in", options->table,
                   "scenes, left-out, floors, starts: write the table between the marks of this Markdown page, which "
                   "name the backend")
      ->type_name("FILE.md");
  command
      ->add_option("--chart", options->chart,
                   "broadphase, sizes: write charts of time over bodies; of broadphase one a scene")
      ->type_name("FILE.svg");
  command->add_option("--beside", options->beside, "sizes: runs to show beside this one, as their --json wrote them")
      ->delimiter(',')
      ->type_name("FILE.json,...");
  command->add_flag("--inexact", options->inexact, "accept devices that fail the exactness self-test");
  command->add_option("--json", options->json.path, "write the result as JSON; - for standard output")
      ->type_name("FILE");
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
