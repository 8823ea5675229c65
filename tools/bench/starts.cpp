/* starts.cpp - measures starts in child processes; see starts.h. */
#include "tools/bench/starts.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/error.h>
#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "tools/command/child.h"
#include "tools/command/distinct_files.h"
#include "tools/command/marked_table.h"

namespace tandem {
namespace {

namespace files = std::filesystem;
using Clock = std::chrono::steady_clock;

/* While a device's kernels are built, steps come as in a game, so that the compiler has the processor in between. */
constexpr std::chrono::microseconds frame_of_game{16667};

/* A folder for what drivers and this program cache, and nothing before it. */
class EmptyCaches {
public:
  EmptyCaches()
  {
    std::error_code error;
    const files::path parent = files::temp_directory_path(error);
    std::string pattern = (parent / "tandem-starts-XXXXXX").string();
    if (error || !mkdtemp(pattern.data()))
      throw InputError(fmt::format("bench starts: no folder for caches can be made in {}; set TMPDIR to one that can "
                                   "be written",
                                   error ? "that of TMPDIR" : parent.string()));
    folder_ = pattern;
  }
  ~EmptyCaches()
  {
    std::error_code ignored;
    files::remove_all(folder_, ignored);
  }
  EmptyCaches(const EmptyCaches &) = delete;
  EmptyCaches &operator=(const EmptyCaches &) = delete;
  /* For this process, before it loads a driver. Without caching, what was cached before is not found either. */
  void take(bool caching) const
  {
    setenv("CUDA_CACHE_DISABLE", caching ? "0" : "1", 1);
    setenv("POCL_KERNEL_CACHE", caching ? "1" : "0", 1);
    setenv("CUDA_CACHE_PATH", (folder_ / "cuda").c_str(), 1);
    setenv("POCL_CACHE_DIR", (folder_ / "pocl").c_str(), 1);
    setenv("TANDEM_CACHE_DIR", (folder_ / (caching ? "tandem" : "none")).c_str(), 1);
    if (!caching) files::remove_all(folder_ / "none");
  }

private:
  files::path folder_;
};

double milliseconds_since(Clock::time_point start)
{
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/* Steps until one has run on the device. */
void make_first_steps(World &world, Clock::time_point began, StartTime &time)
{
  for (bool on_device = false; !on_device;) {
    const Clock::time_point step_began = Clock::now();
    world.step();
    world.finish();
    time.longest_step = std::max(time.longest_step, milliseconds_since(step_began));
    on_device = world.is_placed();
    if (time.first_step == 0) {
      time.first_step = milliseconds_since(began);
      time.hash = hash_text(world.state_hash());
    }
    if (!on_device) std::this_thread::sleep_until(step_began + frame_of_game);
  }
  time.device_step = milliseconds_since(began);
}

StartTime start_of(const std::string &scene, bool cached, Placement placement, Clock::time_point began)
{
  StartTime time;
  time.scene = scene;
  time.cached = cached;
  time.start = placement.start;
  World world(load_scene(scene), {}, placement);
  time.made = milliseconds_since(began);
  make_first_steps(world, began, time);
  time.kernels = world.kernels().size();
  time.steps_on_cpu = world.placement_report().building.steps_on_cpu;
  return time;
}

const char *word_of(Start start) { return start == Start::on_cpu ? "cpu" : "device"; }

const char *caches_of(const StartTime &time) { return time.cached ? "filled" : "off"; }

Json time_json(const StartTime &time)
{
  return {{"scene", time.scene},
          {"cached", time.cached},
          {"start", word_of(time.start)},
          {"kernels", time.kernels},
          {"made_ms", time.made},
          {"first_step_ms", time.first_step},
          {"device_step_ms", time.device_step},
          {"longest_step_ms", time.longest_step},
          {"steps_on_cpu", time.steps_on_cpu},
          {"hash", time.hash}};
}

StartTime time_from(const Json &json)
{
  StartTime time;
  time.scene = json["scene"];
  time.cached = json["cached"];
  time.start = json["start"] == "cpu" ? Start::on_cpu : Start::on_device;
  time.kernels = json["kernels"];
  time.made = json["made_ms"];
  time.first_step = json["first_step_ms"];
  time.device_step = json["device_step_ms"];
  time.longest_step = json["longest_step_ms"];
  time.steps_on_cpu = json["steps_on_cpu"];
  time.hash = json["hash"];
  return time;
}

StartTime measured_start(const std::string &scene, const EmptyCaches &caches, bool cached, Placement placement,
                         Start start)
{
  placement.start = start;
  const Clock::time_point began = Clock::now();
  return time_from(answer_of_child([&] {
    caches.take(cached);
    return time_json(start_of(scene, cached, placement, began));
  }));
}

std::vector<std::string> start_header()
{
  return {"scene",
          "caches",
          "start",
          "kernels",
          "world made, s",
          "first step, s",
          "on the device, s",
          "steps on the CPU",
          "longest step, ms"};
}

std::vector<std::string> start_cells(const StartTime &time)
{
  return {time.scene,
          caches_of(time),
          word_of(time.start),
          fmt::format("{}", time.kernels),
          fmt::format("{:.2f}", time.made * 1e-3),
          fmt::format("{:.2f}", time.first_step * 1e-3),
          fmt::format("{:.2f}", time.device_step * 1e-3),
          fmt::format("{}", time.steps_on_cpu),
          fmt::format("{:.1f}", time.longest_step)};
}

Table table_of(const std::vector<StartTime> &starts)
{
  Table table(start_header());
  for (const StartTime &time : starts) table.add(start_cells(time));
  return table;
}

} // namespace

/* The caches are filled by a start that is not measured. */
std::vector<StartTime> bench_starts(const std::vector<std::string> &scenes, const Placement &placement)
{
  if (!placement.on.starts_with("cl"))
    throw InputError(fmt::format("--on '{}': bench starts measures how long kernels of an OpenCL device are waited "
                                 "for, and this is none; use cl, cl:P.D or cl:PART-OF-A-NAME",
                                 placement.on));
  Placement on_cpu = placement;
  on_cpu.start = Start::on_cpu;
  validate(on_cpu);
  std::vector<StartTime> starts;
  for (const std::string &scene : scenes) {
    const EmptyCaches caches;
    for (const Start start : {Start::on_device, Start::on_cpu})
      starts.push_back(measured_start(scene, caches, false, placement, start));
    measured_start(scene, caches, true, placement, Start::on_device);
    for (const Start start : {Start::on_device, Start::on_cpu})
      starts.push_back(measured_start(scene, caches, true, placement, start));
  }
  return starts;
}

std::vector<std::string> differences_of(const std::vector<StartTime> &starts)
{
  std::vector<std::string> lines;
  for (const StartTime &time : starts) {
    const StartTime &first =
        *std::find_if(starts.begin(), starts.end(), [&](const StartTime &other) { return other.scene == time.scene; });
    if (time.hash != first.hash)
      lines.push_back(
          fmt::format("{}: after the first step the start on the {} with caches {} has the hash {}, that on "
                      "the {} with caches {} has {}",
                      time.scene, word_of(time.start), caches_of(time), time.hash, word_of(first.start),
                      caches_of(first), first.hash));
  }
  return lines;
}

std::string starts_text(const std::vector<StartTime> &starts) { return table_of(starts).text("  "); }

std::string starts_markdown(const std::vector<StartTime> &starts) { return table_of(starts).markdown(3); }

Json starts_json(const std::vector<StartTime> &starts)
{
  Json json = Json::array();
  for (const StartTime &time : starts) json.push_back(time_json(time));
  return json;
}

int execute_starts(const BenchOptions &options)
{
  const std::vector<std::string> scenes = options.scenes.empty()
                                              ? std::vector<std::string>{"spheres", "box-grid", "convex-hulls"}
                                              : scenes_of_parts(options.scenes);
  const MarkedTable table{options.table, "starts " + options.on};
  DistinctFiles files;
  options.json.check(files);
  table.check(files);
  const std::vector<StartTime> starts = bench_starts(scenes, {options.on, {}, options.inexact});
  if (!options.json.takes_standard_output()) fmt::print("starts on {}:\n{}", options.on, starts_text(starts));
  table.write(fmt::format("```\ntandem bench starts --on {} --scene {} --table-in {}\n```\n{}", options.on,
                          fmt::join(scenes, ","), options.table, starts_markdown(starts)));
  options.json.write({{"what", options.what}, {"backend", options.on}, {"starts", starts_json(starts)}});
  const std::vector<std::string> differences = differences_of(starts);
  for (const std::string &line : differences) fmt::print(stderr, "tandem: {}\n", line);
  return differences.empty() ? 0 : 1;
}

} // namespace tandem
