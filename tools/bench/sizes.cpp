/* sizes.cpp - times a cube of boxes at many sizes, and draws it; see sizes.h. */
#include "tools/bench/sizes.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include <fmt/format.h>

#include <tandem/load_scene.h>

#include "tools/command/progress.h"
#include "tools/plot/chart.h"

namespace tandem {
namespace {

constexpr uint64_t sides[] = {2, 5, 10, 20, 40, 100, 160};
constexpr uint64_t steps = 120;

uint64_t cube(uint64_t side) { return side * side * side; }

SizeTime time_of(uint64_t side, const Placement &placement)
{
  World world(load_scene(fmt::format("box-grid:nx={0},ny={0},nz={0}", side)), {}, placement);
  Progress progress(fmt::format("{} boxes", cube(side)), steps);
  SizeTime time;
  time.bodies = cube(side);
  time.milliseconds = measure(world, steps, [&](uint64_t done) { progress.update(done); }).step_milliseconds;
  const Statistics statistics = world.statistics();
  time.deepest = statistics.max_penetration;
  time.mean_depth = statistics.mean_penetration;
  return time;
}

const SizeTime *time_at(const SizesRun &run, uint64_t bodies)
{
  const auto found =
      std::find_if(run.sizes.begin(), run.sizes.end(), [&](const SizeTime &time) { return time.bodies == bodies; });
  return found == run.sizes.end() ? nullptr : &*found;
}

std::set<uint64_t> sizes_of(const std::vector<SizesRun> &runs)
{
  std::set<uint64_t> sizes;
  for (const SizesRun &run : runs)
    for (const SizeTime &time : run.sizes) sizes.insert(time.bodies);
  return sizes;
}

std::string cell_text(const SizeTime *time) { return time ? fmt::format("{:.3f}", time->milliseconds.median) : "-"; }

/* Nanoseconds a box; penetration, mm: the most, the mean. */
std::vector<std::string> figures_of(const SizeTime *time)
{
  if (!time) return {"-", "-", "-"};
  return {fmt::format("{:.1f}", 1e6 * time->milliseconds.median / static_cast<double>(time->bodies)),
          fmt::format("{:.2f}", time->deepest * 1e3), fmt::format("{:.3f}", time->mean_depth * 1e3)};
}

/* What a file leaves out of a figure that it need not have is 0, and shown as absent. */
SizeTime size_of_json(const Json &row)
{
  SizeTime time;
  time.bodies = row.at("bodies").get<uint64_t>();
  time.milliseconds.median = row.at("ms").at("median").get<double>();
  time.milliseconds.minimum = row.at("ms").value("min", time.milliseconds.median);
  time.milliseconds.maximum = row.at("ms").value("max", time.milliseconds.median);
  time.deepest = row.value("max_penetration", 0.0);
  time.mean_depth = row.value("mean_penetration", 0.0);
  if (time.bodies == 0 || !(time.milliseconds.median > 0) || !std::isfinite(time.milliseconds.median))
    throw InputError("bodies and ms.median must be above 0");
  return time;
}

ChartSeries series_of(const SizesRun &run)
{
  ChartSeries series{run.name};
  for (const SizeTime &time : run.sizes) {
    const std::string note = time.deepest > 0 ? fmt::format("penetration {:.3g} mm at most, {:.3g} mm on average",
                                                            time.deepest * 1e3, time.mean_depth * 1e3)
                                              : "";
    series.points.push_back({static_cast<double>(time.bodies), time.milliseconds.median, note});
  }
  return series;
}

} // namespace

std::vector<SizeTime> bench_sizes(const Placement &placement, uint64_t most)
{
  std::vector<SizeTime> times;
  for (const uint64_t side : sides)
    if (cube(side) <= most) times.push_back(time_of(side, placement));
  return times;
}

SizesRun read_sizes(const std::string &path)
{
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("--beside: {} cannot be read", path));
  try {
    const Json json = Json::parse(file);
    SizesRun run{json.at("name").get<std::string>(), {}};
    for (const Json &row : json.at("sizes")) run.sizes.push_back(size_of_json(row));
    return run;
  } catch (const std::exception &error) {
    throw InputError(fmt::format("--beside: {} is no JSON of bench sizes: {}", path, error.what()));
  }
}

std::string sizes_text(const std::vector<SizesRun> &runs)
{
  std::vector<std::string> header{"boxes"};
  for (const SizesRun &run : runs) header.push_back(run.name + ", ms");
  for (const char *figure : {"ns a box", "penetration, mm: most", "mean"}) header.push_back(figure);
  Table table(header);
  for (const uint64_t bodies : sizes_of(runs)) {
    std::vector<std::string> cells{fmt::format("{}", bodies)};
    for (const SizesRun &run : runs) cells.push_back(cell_text(time_at(run, bodies)));
    for (const std::string &cell : figures_of(time_at(runs.front(), bodies))) cells.push_back(cell);
    table.add(cells);
  }
  return table.text("  ");
}

Json sizes_json(const SizesRun &run)
{
  Json sizes = Json::array();
  for (const SizeTime &time : run.sizes)
    sizes.push_back({{"bodies", time.bodies},
                     {"ms", spread_json(time.milliseconds)},
                     {"max_penetration", time.deepest},
                     {"mean_penetration", time.mean_depth}});
  return {{"what", "sizes"}, {"name", run.name}, {"sizes", sizes}};
}

std::string sizes_chart(const std::vector<SizesRun> &runs)
{
  Chart chart{"a step of box-grid", {"boxes", AxisScale::logarithmic}, {"ms a step, median", AxisScale::logarithmic}};
  for (const SizesRun &run : runs) chart.series.push_back(series_of(run));
  return svg_of(chart);
}

} // namespace tandem
