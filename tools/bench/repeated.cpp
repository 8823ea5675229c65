/* repeated.cpp - times what has one time: a primitive, or the step of a cube of boxes; see repeated.h. */
#include "tools/bench/repeated.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "tools/bench/primitives.h"
#include "tools/command/command.h"
#include "tools/command/measure.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

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

} // namespace

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

} // namespace tandem
