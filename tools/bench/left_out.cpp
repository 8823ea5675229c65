/* left_out.cpp - steps a world beside one that runs a feature which the scene lacks; see left_out.h. */
#include "tools/bench/left_out.h"

#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include <tandem/error.h>
#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/base/printable.h"
#include "host/runtime/interface/features.h"
#include "host/runtime/memory.h"
#include "host/scene/specialise.h"
#include "host/world/forced_features.h"
#include "tools/command/distinct_files.h"
#include "tools/command/marked_table.h"
#include "tools/command/progress.h"

namespace tandem {
namespace {

/* These follow from the settings, and a batch of worlds is no scene. */
constexpr Features chosen_features = FEATURE_AXES | FEATURE_EXPANSION | FEATURE_SAMPLED | FEATURE_FIELDS |
                                     FEATURE_SAT_SPLIT | FEATURE_HILL_CLIMBING | FEATURE_CUBE_MAP |
                                     FEATURE_SUBSTEP_WARM_START | FEATURE_WORLDS | FEATURE_PGS | FEATURE_NNCG |
                                     FEATURE_XPBD | FEATURE_AVBD | FEATURE_SPLIT_JOINTS;

struct TimedWorld {
  std::unique_ptr<World> world;
  std::vector<double> launches, milliseconds;

  void step(bool counts)
  {
    const uint64_t before = world->launches();
    const double time = timed_step(*world);
    if (!counts) return;
    launches.push_back(static_cast<double>(world->launches() - before));
    milliseconds.push_back(time);
  }

  WorldCost cost() const
  {
    return {world->kernels().size(), world->memory().total_bytes(), spread_of(launches), spread_of(milliseconds)};
  }
};

/* In turn, so that other work on the machine slows both alike. */
void step_in_turn(TimedWorld &first, TimedWorld &second, uint64_t steps, const std::function<void()> &after_step)
{
  for (uint64_t k = 0; k < scene_warm_steps + steps; ++k) {
    for (TimedWorld *timed : {&first, &second}) {
      if (k == scene_warm_steps) prepare_for_timing(*timed->world);
      timed->step(k >= scene_warm_steps);
    }
    after_step();
  }
}

void measure_row(LeftOut &row, const Scene &scene, Features feature, const ScenesRequest &request,
                 const std::function<void()> &after_step)
{
  TimedWorld without{std::make_unique<World>(scene, request.settings, request.placement), {}, {}},
      with{world_with_features(scene, request.settings, request.placement, with_needs(feature)), {}, {}};
  step_in_turn(without, with, request.steps, after_step);
  if (without.world->state_hash() != with.world->state_hash())
    throw std::runtime_error("the bits with the feature are not those without it");
  row.without = without.cost();
  row.with = with.cost();
}

std::vector<FeatureRow> lacking(const Scene &scene, const Settings &settings)
{
  const Features has = features_of(scene, settings) | chosen_features;
  std::vector<FeatureRow> rows;
  for (const FeatureRow &row : feature_rows)
    if ((row.feature & has) == 0) rows.push_back(row);
  return rows;
}

std::vector<std::string> left_out_header()
{
  return {"scene", "left out", "kernels", "with it", "launches", "with it", "bytes", "with it", "least ms", "with it"};
}

std::vector<std::string> left_out_cells(const LeftOut &row)
{
  if (!row.failure.empty()) return {row.scene, row.feature, "failed", "-", "-", "-", "-", "-", "-", "-"};
  return {row.scene,
          row.feature,
          fmt::format("{}", row.without.kernels),
          fmt::format("{}", row.with.kernels),
          fmt::format("{:g}", row.without.launches.median),
          fmt::format("{:g}", row.with.launches.median),
          fmt::format("{}", row.without.bytes),
          fmt::format("{}", row.with.bytes),
          fmt::format("{:.3f}", row.without.milliseconds.minimum),
          fmt::format("{:.3f}", row.with.milliseconds.minimum)};
}

Json cost_json(const WorldCost &cost)
{
  return {{"kernels_built", cost.kernels},
          {"launches", spread_json(cost.launches)},
          {"memory_bytes", cost.bytes},
          {"step_ms", spread_json(cost.milliseconds)}};
}

Table table_of(const std::vector<LeftOut> &rows)
{
  Table table(left_out_header());
  for (const LeftOut &row : rows) table.add(left_out_cells(row));
  return table;
}

} // namespace

std::vector<std::string> scene_feature_names()
{
  std::vector<std::string> names;
  for (const FeatureRow &row : feature_rows)
    if ((row.feature & chosen_features) == 0) names.emplace_back(row.name);
  return names;
}

std::vector<LeftOut> bench_left_out(const ScenesRequest &request)
{
  const uint64_t steps = scene_warm_steps + request.steps;
  std::vector<LeftOut> rows;
  for (const std::string &name : request.scenes) {
    const Scene scene = load_scene(name);
    const std::vector<FeatureRow> features = lacking(scene, request.settings);
    Progress progress("simulating " + name, steps * features.size());
    uint64_t done = 0;
    for (const FeatureRow &feature : features) {
      rows.push_back({name, feature.name, {}, {}, {}});
      try {
        measure_row(rows.back(), scene, feature.feature, request, [&] { progress.update(++done); });
      } catch (const InputError &) {
        throw;
      } catch (const std::exception &failure) {
        rows.back().failure = failure.what();
      }
    }
  }
  return rows;
}

std::vector<std::string> failures_of(const std::vector<LeftOut> &rows)
{
  std::vector<std::string> lines;
  for (const LeftOut &row : rows)
    if (!row.failure.empty())
      lines.push_back(fmt::format("{} with {} failed: {}", row.scene, row.feature, printable(row.failure)));
  return lines;
}

std::string left_out_text(const std::vector<LeftOut> &rows) { return table_of(rows).text("  "); }

std::string left_out_markdown(const std::vector<LeftOut> &rows) { return table_of(rows).markdown(2); }

Json left_out_json(const std::vector<LeftOut> &rows)
{
  Json json = Json::array();
  for (const LeftOut &row : rows)
    if (row.failure.empty())
      json.push_back({{"scene", row.scene},
                      {"feature", row.feature},
                      {"without", cost_json(row.without)},
                      {"with", cost_json(row.with)}});
    else json.push_back({{"scene", row.scene}, {"feature", row.feature}, {"failure", row.failure}});
  return json;
}

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

} // namespace tandem
