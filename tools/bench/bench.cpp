/* bench.cpp - `tandem bench`: measures how fast one part of the pipeline runs by itself, on any backend. */
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/world.h>

#include "tools/bench/batching.h"
#include "tools/bench/bodies.h"
#include "tools/bench/broadphase.h"
#include "tools/bench/controls.h"
#include "tools/bench/floors.h"
#include "tools/bench/left_out.h"
#include "tools/bench/narrowphase.h"
#include "tools/bench/rays.h"
#include "tools/bench/repeated.h"
#include "tools/bench/scenes.h"
#include "tools/bench/sizes.h"
#include "tools/bench/sleeping.h"
#include "tools/bench/snapshots.h"
#include "tools/bench/starts.h"
#include "tools/bench/support.h"
#include "tools/bench/worlds.h"
#include "tools/command/command.h"

namespace tandem {
namespace {

struct Benchmark {
  const char *name, *what;
  int (*execute)(const BenchOptions &);
};
constexpr Benchmark benchmarks[] = {
    {"sort", "32-bit keys with values", execute_repeated},
    {"scan", "of numbers", execute_repeated},
    {"broadphase", "every one on the same moving bodies", execute_broadphase},
    {"batching", "scenes of the talks; others with --scene, box-grid with --n", execute_batching},
    {"narrowphase", "pairs of shapes", execute_narrowphase},
    {"rays", "against 100,000 boxes", execute_rays},
    {"support", "farthest vertices of hulls", execute_support},
    {"snapshots", "states kept on the device, and saved to the host", execute_snapshots},
    {"sleeping", "one island awake among bodies that sleep", execute_sleeping},
    {"bodies", "that come and go, and one that is read", execute_bodies},
    {"worlds", "many small ones in a batch, and one after another", execute_worlds},
    {"controls", "a batch of robots whose joints are driven at random", execute_controls},
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
  only_of("--scene", !options.scenes.empty(),
          {"broadphase", "scenes", "left-out", "floors", "starts", "batching", "controls"});
  only_of("--steps", !options.steps.empty(), {"scenes", "left-out", "batching", "controls"});
  only_of("--table-in", !options.table.empty(), {"scenes", "left-out", "floors", "starts"});
  only_of("--error", options.error, {"controls"});
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
      ->add_option(
          "--n", options->count,
          "how many: 1048576 keys, 1000 to 1000000 bodies of broadphase, 1000000 rays, 4096 pairs of each "
          "kind, 1000 to 100000 bodies of snapshots and sleeping, 1000 and 10000 of bodies, 1024 and 4096 "
          "worlds, 1024 of controls, 1000 bodies of step, at most 64000 of sizes (0: --beside alone) unless given")
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
                   "alone; floors: one scene with its parameters; batching, starts, controls: scenes with their "
                   "parameters, or files")
      ->delimiter(',')
      ->type_name("NAME,...");
  command
      ->add_option(
          "--steps", options->steps,
          fmt::format("scenes, left-out: how many steps are timed, after {} of warm-up; {} unless given; "
                      "batching: after how many the contacts of --scene are taken; controls: timed steps; 200 unless "
                      "given",
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
  command->add_flag("--error", options->error,
                    "controls: tell how far the robots are from a run with a 32nd of the step, too");
  command->add_flag("--inexact", options->inexact, "accept devices that fail the exactness self-test");
  command->add_option("--json", options->json.path, "write the result as JSON; - for standard output")
      ->type_name("FILE");
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
