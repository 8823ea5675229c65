/* worlds.cpp - times batches of worlds; see worlds.h. */
#include "tools/bench/worlds.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include <tandem/worlds.h>

#include "host/catalog/catalog.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

constexpr uint64_t batch_steps = 240, steps_alone = 120;
constexpr uint32_t most_alone = 32;

struct BatchOfTarget {
  const char *scene;
  uint32_t worlds;
};
constexpr BatchOfTarget targets[] = {{"falling-boxes:n=8,height=0", 1024}, {"falling-boxes:n=10,height=0", 4096}};

std::vector<Scene> seeded(const char *scene, uint32_t worlds)
{
  std::vector<Scene> scenes;
  for (uint32_t world = 0; world < worlds; ++world)
    scenes.push_back(load_scene(fmt::format("{},seed={}", scene, world + 1)));
  return scenes;
}

double step_alone(std::span<const Scene> scenes, const Placement &placement)
{
  std::vector<std::unique_ptr<World>> worlds;
  for (const Scene &scene : scenes) worlds.push_back(std::make_unique<World>(scene, Settings{}, placement));
  double sum = 0;
  for (uint64_t step = 0; step < 2 * steps_alone; ++step)
    for (const std::unique_ptr<World> &world : worlds)
      if (const double time = timed_step(*world); step >= steps_alone) sum += time;
  return sum / static_cast<double>(steps_alone * worlds.size());
}

WorldsTime time_of(const BatchOfTarget &target, uint32_t worlds, const Placement &placement)
{
  WorldsTime time;
  const std::vector<Scene> scenes = seeded(target.scene, worlds);
  time.scene = target.scene;
  time.worlds = worlds;
  time.bodies = scenes.front().bodies.size();
  time.worlds_alone = std::min(worlds, most_alone);
  time.alone = step_alone(std::span(scenes).first(time.worlds_alone), placement);
  Worlds batch(scenes, {}, placement);
  Progress progress(fmt::format("{} worlds", worlds), batch_steps);
  time.batch = measure(batch, batch_steps, [&](uint64_t done) { progress.update(done); });
  return time;
}

/* Steps of one world. */
double steps_a_second(const WorldsTime &time)
{
  return 1e3 * time.worlds / std::max(time.batch.step_milliseconds.median, 1e-9);
}

} // namespace

std::vector<WorldsTime> bench_worlds(const std::string &backend, std::optional<uint32_t> worlds, bool allow_inexact)
{
  std::vector<WorldsTime> times;
  for (const BatchOfTarget &target : targets)
    times.push_back(time_of(target, worlds.value_or(target.worlds), {backend, {}, allow_inexact}));
  return times;
}

std::string worlds_text(const std::vector<WorldsTime> &times)
{
  Table table({"scene of each", "worlds", "step of all, ms", "world-steps/s", "alone, world-steps/s"});
  for (const WorldsTime &row : times)
    table.add({row.scene, fmt::format("{}", row.worlds), fmt::format("{:.3f}", row.batch.step_milliseconds.median),
               fmt::format("{:.0f}", steps_a_second(row)), fmt::format("{:.0f}", 1e3 / row.alone)});
  return table.text("  ");
}

Json worlds_json(const std::vector<WorldsTime> &times)
{
  Json json = Json::array();
  for (const WorldsTime &row : times)
    json.push_back({{"scene", row.scene},
                    {"worlds", row.worlds},
                    {"bodies_of_world", row.bodies},
                    {"step_ms", spread_json(row.batch.step_milliseconds)},
                    {"world_steps_per_second", steps_a_second(row)},
                    {"launches", row.batch.launches},
                    {"worlds_alone", row.worlds_alone},
                    {"alone_ms", row.alone}});
  return json;
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

} // namespace tandem
