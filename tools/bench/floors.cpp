/* floors.cpp - counts the bytes of a step's launches, and times its stages; see floors.h.
 *
 * What a launch must move follows from its row in kernels.def: of each buffer that it reads or writes, the rows of its
 * items, or all that is in use if that is less. Bodies that a constraint gathers count as two rows of each constraint,
 * and a launch of one colour counts its constraints alone. What a kernel reads twice, and what it reads of neighbours,
 * does not count; what a cache holds from the launch before, or an item leaves unread because it has nothing to do,
 * does. A stage may therefore take a little less than its floor, and much less where its data fit into a cache. */
#include "tools/bench/floors.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/pipeline/layout.h"
#include "host/runtime/memory.h"
#include "host/world/step_parts.h"
#include "tools/bench/primitives.h"
#include "tools/command/distinct_files.h"
#include "tools/command/marked_table.h"
#include "tools/command/measure.h"
#include "tools/command/progress.h"

namespace tandem {
namespace {

constexpr uint32_t copied_words = 1u << 25;
constexpr uint64_t warm_steps = 60, measured_steps = 120;

using Counts = std::array<uint32_t, COUNT_TOTAL>;

Counts counts_of(World &world)
{
  Counts counts{};
  world.memory().download(Buffer::counts, counts.data(), sizeof counts);
  return counts;
}

uint64_t bytes_of_rows(World &world, const Counts &counts, Buffer buffer, uint64_t items)
{
  const Features features = world.features();
  const UsedPart used =
      part_in_use(buffer, world.memory().bytes(buffer), {counts[COUNT_ALL_BODIES], counts[COUNT_PAIRS], features});
  const uint64_t row = elements_of_item(buffer, features) * size_of(row_of(buffer).element);
  const uint64_t rows_an_item = row_of(buffer).capacity == Capacity::BODIES ? 2 : 1;
  return std::min<uint64_t>(used.bytes * used.planes, items * rows_an_item * row);
}

uint64_t least_bytes(World &world, const Counts &counts, const Launch &launch)
{
  const uint64_t items = uint64_t{counts[launch.last]} - counts[launch.first];
  uint64_t bytes = 0;
  for_each_buffer(launch, [&](Buffer buffer, Access access) {
    bytes += bytes_of_rows(world, counts, buffer, items) * (access == Access::inout ? 2 : 1);
  });
  return bytes;
}

std::vector<Launch> launches_of_step(World &world)
{
  std::vector<Launch> launches;
  world.set_observer([&](const Launch &launch) { launches.push_back(launch); });
  world.step();
  world.set_observer({});
  return launches;
}

void add_bytes(Floors &floors, World &world)
{
  const std::vector<Launch> launches = launches_of_step(world);
  const Counts counts = counts_of(world);
  for (const Launch &launch : launches) {
    const char *const stage = name_of(row_of(launch.kernel).stage);
    const auto found = std::find_if(floors.stages.begin(), floors.stages.end(),
                                    [&](const StageFloor &floor) { return floor.stage == stage; });
    if (found == floors.stages.end()) continue; /* none of its kernels took any time */
    ++found->launches;
    found->bytes += least_bytes(world, counts, launch);
  }
  for (StageFloor &floor : floors.stages)
    floor.floor_milliseconds = 1e3 * static_cast<double>(floor.bytes) / floors.bytes_per_second;
}

double copy_speed(const Placement &placement)
{
  const Spread spread = spread_of(bench_copy(placement.on, copied_words, placement.allow_inexact));
  return 2.0 * copied_words * sizeof(uint32_t) / (1e-3 * spread.median);
}

std::vector<std::string> floor_header()
{
  return {"stage", "launches", "MB that must move", "floor ms", "takes ms", "times the floor"};
}

std::vector<std::string> floor_cells(const StageFloor &floor)
{
  return {floor.stage,
          fmt::format("{}", floor.launches),
          fmt::format("{:.1f}", 1e-6 * static_cast<double>(floor.bytes)),
          fmt::format("{:.3f}", floor.floor_milliseconds),
          fmt::format("{:.3f}", floor.milliseconds),
          floor.floor_milliseconds > 0 ? fmt::format("{:.1f}", floor.milliseconds / floor.floor_milliseconds) : "-"};
}

StageFloor sum_of(const std::vector<StageFloor> &stages)
{
  StageFloor sum{"all", 0, 0, 0, 0};
  for (const StageFloor &floor : stages) {
    sum.launches += floor.launches;
    sum.bytes += floor.bytes;
    sum.floor_milliseconds += floor.floor_milliseconds;
    sum.milliseconds += floor.milliseconds;
  }
  return sum;
}

std::string floors_title(const Floors &floors)
{
  return fmt::format("{}: {} bodies, {} pairs; a copy moves {:.0f} GB/s; a step takes {:.3f} ms", floors.scene,
                     floors.bodies, floors.pairs, 1e-9 * floors.bytes_per_second, floors.step_milliseconds);
}

Table table_of(const Floors &floors)
{
  Table table(floor_header());
  for (const StageFloor &floor : floors.stages) table.add(floor_cells(floor));
  table.add(floor_cells(sum_of(floors.stages)));
  return table;
}

/* A scene may have parameters, whose commas part the option. */
std::string floors_scene(const BenchOptions &options)
{
  return options.scenes.empty() ? "box-grid" : fmt::format("{}", fmt::join(options.scenes, ","));
}

} // namespace

uint64_t least_bytes(World &world, const Launch &launch) { return least_bytes(world, counts_of(world), launch); }

Floors bench_floors(const std::string &scene, const Placement &placement)
{
  Floors floors{scene, 0, 0, copy_speed(placement), 0, {}};
  World world(load_scene(scene), Settings{}, placement);
  Progress progress("simulating", warm_steps + measured_steps);
  for (uint64_t step = 0; step < warm_steps; ++step) {
    world.step();
    progress.update(step + 1);
  }
  const Measurement measurement =
      measure(world, measured_steps, [&](uint64_t done) { progress.update(warm_steps + done); });
  floors.step_milliseconds = measurement.step_milliseconds.median;
  for (const StageTime &stage : measurement.stages) floors.stages.push_back({stage.name, 0, 0, 0, stage.milliseconds});
  add_bytes(floors, world);
  floors.bodies = world.scene().bodies.size();
  floors.pairs = world.statistics().pairs;
  return floors;
}

std::string floors_text(const Floors &floors) { return floors_title(floors) + "\n" + table_of(floors).text("  "); }

std::string floors_markdown(const Floors &floors)
{
  return floors_title(floors) + ".\n\n" + table_of(floors).markdown();
}

Json floors_json(const Floors &floors)
{
  Json stages = Json::array();
  for (const StageFloor &floor : floors.stages)
    stages.push_back({{"name", floor.stage},
                      {"launches", floor.launches},
                      {"bytes", floor.bytes},
                      {"floor_ms", floor.floor_milliseconds},
                      {"ms", floor.milliseconds}});
  return {{"scene", floors.scene},
          {"bodies", floors.bodies},
          {"pairs", floors.pairs},
          {"bytes_per_second", floors.bytes_per_second},
          {"step_ms", floors.step_milliseconds},
          {"stages", stages}};
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

} // namespace tandem
