/* sizes.cpp - times a cube of boxes at many sizes, and draws it; see sizes.h. */
#include "tools/bench/sizes.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include <tandem/error.h>
#include <tandem/load_scene.h>

#include "host/base/printable.h"
#include "host/catalog/catalog.h"
#include "host/io/input_file.h"
#include "host/io/json/reader.h"
#include "tools/command/distinct_files.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"
#include "tools/plot/chart.h"

namespace tandem {
namespace {

constexpr uint64_t sides[] = {2, 5, 10, 20, 40, 100, 160};
constexpr uint64_t steps = 120;
constexpr double most_depth = 1e6; /* m, which a file may state */

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

std::string millimetres(const std::optional<double> &metres, int digits)
{
  return metres ? fmt::format("{:.{}f}", *metres * 1e3, digits) : "-";
}

std::string cell_text(const SizeTime *time) { return time ? fmt::format("{:.3f}", time->milliseconds.median) : "-"; }

/* Nanoseconds a box; penetration, mm: the most, the mean. */
std::vector<std::string> figures_of(const SizeTime *time)
{
  if (!time) return {"-", "-", "-"};
  return {fmt::format("{:.1f}", 1e6 * time->milliseconds.median / static_cast<double>(time->bodies)),
          millimetres(time->deepest, 2), millimetres(time->mean_depth, 3)};
}

double above_zero(const JsonValue &value)
{
  const double number = value.precise_number();
  if (!(number > 0)) value.fail("must be above 0");
  return number;
}

std::optional<double> depth_of(const JsonValue &row, const char *key)
{
  const std::optional<JsonValue> value = row.find(key);
  if (!value) return {};
  const double depth = value->precise_number();
  if (depth < 0 || depth > most_depth) value->fail(fmt::format("must be 0 to {} m", most_depth));
  return depth;
}

SizeTime size_of_json(const JsonValue &row)
{
  SizeTime time;
  time.bodies = row.member("bodies").long_unsigned_integer();
  if (time.bodies == 0) row.member("bodies").fail("must be above 0");
  const JsonValue milliseconds = row.member("ms");
  time.milliseconds.median = above_zero(milliseconds.member("median"));
  time.deepest = depth_of(row, "max_penetration");
  time.mean_depth = depth_of(row, "mean_penetration");
  return time;
}

ChartSeries series_of(const SizesRun &run)
{
  ChartSeries series{run.name};
  for (const SizeTime &time : run.sizes) {
    const std::string note = time.deepest ? fmt::format("penetration {} mm at most, {} mm on average",
                                                        millimetres(time.deepest, 2), millimetres(time.mean_depth, 3))
                                          : "";
    series.points.push_back({static_cast<double>(time.bodies), time.milliseconds.median, note});
  }
  return series;
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
  const std::string where = "--beside " + path;
  const JsonDocument document = parse_json(read_file(path), where);
  const JsonValue json(document.value(), where, "", JsonFloats::numbers);
  SizesRun run{printable(json.member("name").text()), {}};
  const JsonValue sizes = json.member("sizes");
  for (size_t k = 0; k < sizes.array_size(); ++k) run.sizes.push_back(size_of_json(sizes.element(k)));
  return run;
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
                     {"max_penetration", *time.deepest},
                     {"mean_penetration", *time.mean_depth}});
  return {{"what", "sizes"}, {"name", run.name}, {"sizes", sizes}};
}

std::string sizes_chart(const std::vector<SizesRun> &runs)
{
  Chart chart{"a step of box-grid", {"boxes", AxisScale::logarithmic}, {"ms a step, median", AxisScale::logarithmic}};
  for (const SizesRun &run : runs) chart.series.push_back(series_of(run));
  return svg_of(chart);
}

int execute_sizes(const BenchOptions &options)
{
  const uint64_t most = options.count.empty() ? most_of_sizes : whole_number("--n", options.count, 0, most_bodies);
  DistinctFiles files;
  std::vector<SizesRun> runs = sizes_beside(options, files);
  if (most < 8 && (most > 0 || runs.empty() || !options.json.path.empty()))
    throw InputError("--n: 8 boxes are the fewest; 0 draws the files of --beside alone, without --json");
  if (most == 0 && options.on != BenchOptions{}.on)
    throw InputError("--on: with --n 0 bench sizes makes no steps on a backend; leave it out");
  options.json.check(files);
  files.writes("--chart", options.chart);
  if (most > 0)
    runs.insert(runs.begin(), {"tandem, " + options.on, bench_sizes({options.on, {}, options.inexact}, most)});
  if (!options.json.takes_standard_output()) fmt::print("a step of box-grid, median\n{}", sizes_text(runs));
  if (most > 0) options.json.write(sizes_json(runs.front()));
  if (!options.chart.empty()) write_file("--chart", options.chart, sizes_chart(runs));
  return 0;
}

} // namespace tandem
