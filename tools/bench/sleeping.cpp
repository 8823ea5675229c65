/* sleeping.cpp - times worlds that sleep; see sleeping.h. */
#include "tools/bench/sleeping.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

constexpr uint32_t island_bodies = 40;
constexpr int wakes = 7, idle_steps = 201, most_steps = 600;

template <class Work> double wait_for(World &world, const Work &work)
{
  world.finish();
  const auto start = std::chrono::steady_clock::now();
  work();
  world.finish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Body box_at(double x, double y, double z)
{
  Body body;
  body.shape = 1;
  body.position = {x, y, z};
  return body;
}

Scene sleepers(uint64_t bodies)
{
  Scene scene;
  scene.name = "boxes that lie apart, and a stack";
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f)};
  scene.bodies.resize(1);
  scene.bodies[0].type = BodyType::fixed;
  for (uint32_t k = 0; k < island_bodies; ++k) scene.bodies.push_back(box_at(k % 5, 0.5 + k / 10, -20.0 - k / 5 % 2));
  const auto side = static_cast<uint64_t>(std::ceil(std::sqrt(static_cast<double>(bodies))));
  for (uint64_t k = island_bodies; k < bodies; ++k)
    scene.bodies.push_back(box_at(1.5 * static_cast<double>(k % side), 0.5, 1.5 * static_cast<double>(k / side)));
  return scene;
}

/* Steps until so many bodies fell asleep; returns the times of the steps, the last of which the last ones fell asleep
 * in. Events tell, because the statistics of a world read all of its bodies and so empty the caches. */
std::vector<double> steps_until_asleep(World &world, uint64_t bodies)
{
  std::vector<double> times;
  uint64_t asleep = 0;
  while (asleep < bodies) {
    if (times.size() == most_steps)
      throw std::runtime_error(
          fmt::format("bench sleeping: {} of {} bodies sleep after {} steps", asleep, bodies, most_steps));
    times.push_back(wait_for(world, [&] { world.step(); }));
    for (const SleepEvent &event : world.sleep_events()) asleep += event.asleep ? 1 : 0;
  }
  return times;
}

Spread spread_or_none(const std::vector<double> &times) { return times.empty() ? Spread{} : spread_of(times); }

} // namespace

SleepTimes bench_sleeping(const std::string &backend, uint64_t bodies, bool allow_inexact)
{
  SleepTimes times;
  times.bodies = std::max<uint64_t>(bodies, island_bodies);
  Settings settings;
  settings.sleeping = true;
  World world(sleepers(times.bodies), settings, {backend, {}, allow_inexact});
  world.step(); /* the first step compiles */
  times.awake = spread_or_none(steps_until_asleep(world, times.bodies));
  std::vector<double> asleep, island, wake, fall, read;
  for (int k = 0; k < idle_steps; ++k) asleep.push_back(wait_for(world, [&] { world.step(); }));
  world.wake_body(world.id_of(1));
  steps_until_asleep(world, island_bodies);
  world.prepare_kernels();
  for (int k = 0; k < wakes; ++k) {
    wake.push_back(wait_for(world, [&] {
      world.wake_body(world.id_of(1));
      world.step();
    }));
    read.push_back(wait_for(world, [&] { world.read_body(world.id_of(1)); }));
    std::vector<double> steps = steps_until_asleep(world, island_bodies);
    fall.push_back(steps.back());
    island.insert(island.end(), steps.begin(), steps.end() - 1);
  }
  times.asleep = spread_of(asleep);
  times.island = spread_or_none(island);
  times.wake = spread_of(wake);
  times.fall = spread_of(fall);
  times.read = spread_of(read);
  return times;
}

std::string sleeping_text(const std::vector<SleepTimes> &times)
{
  Table table({"bodies", "all awake, ms", "all asleep, us", "40 awake, ms", "wake and step, ms", "fall asleep, ms",
               "read one, us"});
  for (const SleepTimes &row : times)
    table.add({fmt::format("{}", row.bodies), fmt::format("{:.3f}", row.awake.median),
               fmt::format("{:.2f}", 1e3 * row.asleep.median), fmt::format("{:.3f}", row.island.median),
               fmt::format("{:.3f}", row.wake.median), fmt::format("{:.3f}", row.fall.median),
               fmt::format("{:.1f}", 1e3 * row.read.median)});
  return table.text("  ");
}

Json sleeping_json(const std::vector<SleepTimes> &times)
{
  Json json = Json::array();
  for (const SleepTimes &row : times)
    json.push_back({{"bodies", row.bodies},
                    {"awake_ms", spread_json(row.awake)},
                    {"asleep_ms", spread_json(row.asleep)},
                    {"island_ms", spread_json(row.island)},
                    {"wake_ms", spread_json(row.wake)},
                    {"fall_ms", spread_json(row.fall)},
                    {"read_ms", spread_json(row.read)}});
  return json;
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

} // namespace tandem
