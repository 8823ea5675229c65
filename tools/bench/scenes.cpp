/* scenes.cpp - steps every built-in scene and counts what it takes; see scenes.h. */
#include "tools/bench/scenes.h"

#include <algorithm>
#include <cstdio>
#include <functional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/error.h>
#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/base/printable.h"
#include "host/catalog/catalog.h"
#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/memory.h"
#include "tools/command/distinct_files.h"
#include "tools/command/marked_table.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

uint64_t moving_bodies(const Scene &scene)
{
  return static_cast<uint64_t>(std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                             [](const Body &body) { return body.type != BodyType::fixed; }));
}

void time_steps(SceneCost &cost, World &world, uint64_t steps, const std::function<void()> &after_step)
{
  std::vector<double> milliseconds, launches;
  for (uint64_t k = 0; k < scene_warm_steps + steps; ++k) {
    if (k == scene_warm_steps) prepare_for_timing(world);
    const uint64_t before = world.launches();
    const double time = timed_step(world);
    if (k >= scene_warm_steps) {
      milliseconds.push_back(time);
      launches.push_back(static_cast<double>(world.launches() - before));
    }
    after_step();
  }
  cost.milliseconds = spread_of(milliseconds);
  cost.launches = spread_of(launches);
}

void count_needs(SceneCost &cost, World &world)
{
  const Statistics statistics = world.statistics();
  cost.pairs = statistics.pairs;
  cost.contacts = statistics.contacts;
  cost.kernels = world.kernels().size();
  cost.bytes = world.memory().total_bytes();
  cost.build_milliseconds = world.build_milliseconds();
  if (statistics.nonfinite)
    throw std::runtime_error(fmt::format("{} bodies stopped being finite, so this is no result", statistics.nonfinite));
}

SceneCost cost_of(const std::string &scene, const Settings &settings, const ScenesRequest &request,
                  const std::function<void()> &after_step)
{
  SceneCost cost;
  cost.scene = scene;
  cost.specialised = settings.specialise;
  try {
    World world(load_scene(scene), settings, request.placement);
    cost.moving = moving_bodies(world.scene());
    time_steps(cost, world, request.steps, after_step);
    count_needs(cost, world);
  } catch (const InputError &) {
    throw;
  } catch (const std::exception &failure) {
    cost.failure = failure.what();
  }
  return cost;
}

std::string title_of(const SceneCost &cost) { return cost.scene + (cost.specialised ? "" : ", all features"); }

std::vector<std::string> header_cells()
{
  return {"scene",    "moving bodies", fmt::format("kernels of {}", kernel_count),
          "launches", "bytes",         "bytes a moving body",
          "build ms", "step ms",       "pairs",
          "contacts"};
}

std::vector<std::string> cells_of(const SceneCost &cost)
{
  if (!cost.failure.empty()) return {title_of(cost), "failed", "-", "-", "-", "-", "-", "-", "-", "-"};
  return {title_of(cost),
          fmt::format("{}", cost.moving),
          fmt::format("{}", cost.kernels),
          fmt::format("{:g}", cost.launches.median),
          fmt::format("{}", cost.bytes),
          fmt::format("{:.0f}", static_cast<double>(cost.bytes) / static_cast<double>(cost.moving)),
          fmt::format("{:.0f}", cost.build_milliseconds),
          fmt::format("{:.3f}", cost.milliseconds.median),
          fmt::format("{}", cost.pairs),
          fmt::format("{}", cost.contacts)};
}

Json cost_json(const SceneCost &cost)
{
  if (!cost.failure.empty())
    return {{"scene", cost.scene}, {"all_features", !cost.specialised}, {"failure", cost.failure}};
  return {{"scene", cost.scene},
          {"all_features", !cost.specialised},
          {"moving_bodies", cost.moving},
          {"kernels_built", cost.kernels},
          {"launches", spread_json(cost.launches)},
          {"memory_bytes", cost.bytes},
          {"build_ms", cost.build_milliseconds},
          {"step_ms", spread_json(cost.milliseconds)},
          {"pairs", cost.pairs},
          {"contacts", cost.contacts}};
}

Table table_of(const std::vector<SceneCost> &costs)
{
  Table table(header_cells());
  for (const SceneCost &cost : costs) table.add(cells_of(cost));
  return table;
}

} // namespace

std::vector<SceneCost> bench_scenes(const ScenesRequest &request)
{
  const uint64_t steps = scene_warm_steps + request.steps, worlds = request.scenes.size() + 1;
  Progress progress("simulating", steps * worlds);
  std::vector<SceneCost> costs;
  const auto run = [&](const std::string &scene, const Settings &settings) {
    uint64_t done = steps * costs.size(); /* a scene that fails leaves the rest of its steps out */
    costs.push_back(cost_of(scene, settings, request, [&] { progress.update(++done); }));
  };
  Settings settings = request.settings;
  for (const std::string &scene : request.scenes) run(scene, settings);
  settings.specialise = false;
  run(request.scenes.front(), settings);
  return costs;
}

std::vector<std::string> scene_names(const std::vector<std::string> &wanted)
{
  std::vector<std::string> known;
  for (const BuiltInScene &scene : built_in_scenes()) known.push_back(scene.name);
  for (const std::string &name : wanted)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(
          fmt::format("--scene '{}': no built-in scene has this name; use {}", name, fmt::join(known, ", ")));
  return wanted.empty() ? known : wanted;
}

std::vector<std::string> failures_of(const std::vector<SceneCost> &costs)
{
  std::vector<std::string> lines;
  for (const SceneCost &cost : costs)
    if (!cost.failure.empty()) lines.push_back(fmt::format("{} failed: {}", title_of(cost), printable(cost.failure)));
  return lines;
}

std::string scenes_text(const std::vector<SceneCost> &costs) { return table_of(costs).text("  "); }

std::string scenes_markdown(const std::vector<SceneCost> &costs) { return table_of(costs).markdown(); }

Json scenes_json(const std::vector<SceneCost> &costs)
{
  Json json = Json::array();
  for (const SceneCost &cost : costs) json.push_back(cost_json(cost));
  return json;
}

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

} // namespace tandem
