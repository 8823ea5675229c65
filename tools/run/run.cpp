/* run.cpp - `tandem run`: simulates a scene and prints the time of each stage and the results. */
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include <tandem/metrics.h>
#include <tandem/world.h>

#include "host/base/printable.h"
#include "host/catalog/catalog.h"
#include "host/geometry/geometry.h"
#include "host/io/glb/animation.h"
#include "host/runtime/memory.h"
#include "tools/command/command.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"
#include "tools/command/placement_text.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"
#include "tools/command/start.h"
#include "tools/plot/image.h"
#include "tools/replay/recording_file.h"
#include "tools/run/event_file.h"
#include "tools/run/stage_table.h"
#include "tools/run/trace.h"
#include "tools/run/worlds.h"

namespace tandem {
namespace {

struct RunOptions {
  explicit RunOptions(CLI::App &parser) : scene(parser, true) {}
  SceneOptions scene;
  std::string worlds, start = "device";
  std::string save, image, image_size = "960x540", camera, trace, events, record, record_snapshots;
  bool allow_quarantine = false;
  JsonOutput json;
};

void add_options(CLI::App &parser, RunOptions &options)
{
  parser
      .add_option("--worlds", options.worlds,
                  "so many copies of the scene, stepped together; step times are of all, the hash of the first")
      ->type_name("N");
  parser
      .add_option("--start", options.start,
                  "where the first steps run: device waits until the kernels of --on are built; cpu does not, and tbb "
                  "makes the steps until then, with the same bits")
      ->type_name("cpu|device")
      ->capture_default_str();
  parser.add_option("--save", options.save, "write the motion as an animation for any glTF viewer")->type_name("F.glb");
  CLI::Option *image =
      parser
          .add_option("--image", options.image,
                      "draw the scene as it is in the end, by ray casting where the stage queries is placed")
          ->type_name("F.png");
  parser.add_option("--image-size", options.image_size, "of the picture, in pixels")
      ->type_name("WxH")
      ->capture_default_str()
      ->needs(image);
  parser
      .add_option("--camera", options.camera,
                  "from where to where the picture is seen; at all bodies but the largest if not given")
      ->type_name("EX,EY,EZ,TX,TY,TZ")
      ->needs(image);
  parser
      .add_option("--trace", options.trace,
                  "write a time line of the kernels (Chrome trace events); waits for each kernel, so steps take longer")
      ->type_name("F.json");
  parser
      .add_option("--events", options.events,
                  "write which bodies begin, go on and cease to touch in each step, and how hard")
      ->type_name("F.json");
  CLI::Option *record = parser
                            .add_option("--record", options.record,
                                        "write a recording for `tandem replay` and `tandem diff`: a snapshot, and a "
                                        "hash a step, which makes steps take longer")
                            ->type_name("F.tandem");
  parser
      .add_option("--record-snapshots", options.record_snapshots,
                  "with another snapshot every N steps, from which a replay can start")
      ->type_name("N")
      ->needs(record);
  parser.add_option("--json", options.json.path, "write the results as JSON; - for standard output")->type_name("FILE");
  parser.add_flag("--allow-quarantine", options.allow_quarantine,
                  "exit status 0 also where bodies stopped being finite and were taken out");
  parser.footer(
      "Exit status: 0 fine, 1 a body stopped being finite, a batch is wrong, or memory or the room that --max-pairs "
      "allows did not suffice, 2 bad use or input, or an output that cannot be written.\n"
      "Timing: the first half of the steps is warm-up; step times are the median, minimum and maximum over the "
      "last half.\nEvery 8th step of the last half is measured kernel by kernel instead and counts for the "
      "stages alone.");
}

void check_files(const RunOptions &options, DistinctFiles &files)
{
  const auto [width, height] = size_of_image(options.image_size);
  if (!options.camera.empty()) camera_from(options.camera, width, height);
  const std::string ending = std::filesystem::path(options.image).extension();
  if (!ending.empty() && ending != ".png" && ending != ".PNG")
    throw InputError(
        fmt::format("--image '{}': a picture is written as .png; name the file so", printable(options.image)));
  files.writes("--image", options.image);
  files.writes("--save", options.save);
  files.writes("--trace", options.trace);
  files.writes("--events", options.events);
  if (!options.record.empty() && !names_recording(options.record))
    throw InputError(fmt::format("--record '{}': the name of a recording ends in .tandem", printable(options.record)));
  files.writes("--record", options.record);
  options.json.check(files);
}

/* The animation during recording; does nothing without --save. */
class AnimationFrames {
public:
  AnimationFrames(const std::string &path, World &world) : world_(world)
  {
    if (path.empty()) return;
    writer_ = std::make_unique<AnimationWriter>(world.scene(), path);
    add_frame(0);
  }
  void add_frame(uint64_t step)
  {
    if (!writer_) return;
    std::vector<Vec3> positions;
    std::vector<Quat> orientations;
    for (const BodyState &body : world_.bodies()) {
      positions.push_back(rounded(body.position));
      orientations.push_back(body.orientation);
    }
    writer_->add_frame(static_cast<double>(step) * static_cast<double>(world_.settings().step), positions,
                       orientations);
  }
  void finish()
  {
    if (writer_) writer_->finish();
  }

private:
  World &world_;
  std::unique_ptr<AnimationWriter> writer_;
};

struct Outcome {
  std::string scene;
  uint64_t steps;
  Measurement measurement;
  Statistics statistics;
  JointErrorSummary joints;
  double coupling_error;
  uint64_t hash, body_hash;
};

Json outcome_json(const Outcome &outcome, World &world, const Placement &placement)
{
  const Spread &step = outcome.measurement.step_milliseconds;
  const Statistics &statistics = outcome.statistics;
  return {{"scene", outcome.scene},
          {"backend", placement.on},
          {"solver", name_of(world.settings().solver)},
          {"bodies", world.scene().bodies.size()},
          {"steps", outcome.steps},
          {"dt", world.settings().step},
          {"step_ms", {{"median", step.median}, {"min", step.minimum}, {"max", step.maximum}}},
          {"stages", stages_json(outcome.measurement)},
          {"pairs", statistics.pairs},
          {"contacts", statistics.contacts},
          {"colors", statistics.colors},
          {"max_penetration", statistics.max_penetration},
          {"mean_penetration", statistics.mean_penetration},
          {"kinetic_energy", statistics.kinetic_energy},
          {"direct",
           {{"islands", statistics.direct_islands},
            {"left", statistics.direct_left},
            {"stalled", statistics.direct_stalled}}},
          {"nonfinite", statistics.nonfinite},
          {"overflow", statistics.overflow},
          {"substeps", statistics.substeps},
          {"bodies_with_more_substeps", statistics.bodies_with_more_substeps},
          {"joints", world.scene().joints.size()},
          {"joint_error",
           {{"max", outcome.joints.max_distance},
            {"mean", outcome.joints.mean_distance},
            {"max_angle", outcome.joints.max_angle},
            {"mean_angle", outcome.joints.mean_angle}}},
          {"couplings", world.scene().couplings.size()},
          {"coupling_error", outcome.coupling_error},
          {"asleep", statistics.asleep},
          {"islands", statistics.sleeping_islands},
          {"memory_bytes", world.memory().total_bytes()},
          {"kernels_built", world.kernels().size()},
          {"build_ms", world.build_milliseconds()},
          {"placement", placement_json(world.placement_report())},
          {"launches", outcome.measurement.launches},
          {"bytes_moved", outcome.measurement.bytes_moved},
          {"device_reads", outcome.measurement.device_reads},
          {"resident_groups", world.resident_groups()},
          {"hash", hash_text(outcome.hash)},
          {"body_hash", hash_text(outcome.body_hash)}};
}

std::string launches_text(const World &world, const Measurement &measurement)
{
  const uint32_t groups = world.resident_groups();
  return fmt::format("{:.0f} a step", measurement.launches) +
         (groups > 1 ? fmt::format(", of up to {} work-groups that wait for each other", groups) : "");
}

/* A CPU's backends have one memory, and the host reads no other. */
std::string moved_text(const Measurement &measurement)
{
  return fmt::format("{} a step between memories", bytes_text(static_cast<uint64_t>(measurement.bytes_moved))) +
         (measurement.device_reads > 0 ? fmt::format("; the host reads a device {:.0f} times", measurement.device_reads)
                                       : "");
}

/* Of a world that chooses its substeps. */
std::string who_took_more(const Statistics &statistics)
{
  if (statistics.bodies_with_more_substeps == 0) return "";
  return fmt::format("; in the last one {} bodies took more than the fewest", statistics.bodies_with_more_substeps);
}

std::string facts_table(const Outcome &outcome, World &world, const Placement &placement)
{
  const Statistics &statistics = outcome.statistics;
  Table table({"pairs", fmt::format("{}", statistics.pairs)}, false);
  table.add({"contacts", fmt::format("{} points in {} pairs", statistics.contacts, statistics.manifolds)});
  table.add({"colours", fmt::format("{}", statistics.colors)});
  if (world.settings().solver == Solver::direct)
    table.add({"islands", fmt::format("{} solved directly ({} solves stalled), {} pairs and joints in larger ones",
                                      statistics.direct_islands, statistics.direct_stalled, statistics.direct_left)});
  if (world.settings().substeps == automatic_substeps)
    table.add({"substeps", fmt::format("{} in the next step{}", statistics.substeps, who_took_more(statistics))});
  table.add({"penetration", fmt::format("{:.3g} mm at most, {:.3g} mm on average", statistics.max_penetration * 1e3,
                                        statistics.mean_penetration * 1e3)});
  if (const size_t joints = world.scene().joints.size(); joints > 0)
    table.add({"joints", fmt::format("{}, open by {:.3g} mm and {:.3g} rad at most, {:.3g} mm on average", joints,
                                     outcome.joints.max_distance * 1e3, outcome.joints.max_angle,
                                     outcome.joints.mean_distance * 1e3)});
  if (const size_t couplings = world.scene().couplings.size(); couplings > 0)
    table.add({"couplings", fmt::format("{}, off by {:.3g} rad or m at most", couplings, outcome.coupling_error)});
  table.add({"kinetic energy", fmt::format("{:.6g} J", statistics.kinetic_energy)});
  table.add({"memory", bytes_text(world.memory().total_bytes())});
  table.add({"kernels", fmt::format("{}, built in {:.0f} ms", world.kernels().size(), world.build_milliseconds())});
  if (placement.automatic) table.add({"placement", placement_text(world.placement_report())});
  if (placement.start == Start::on_cpu) table.add({"start", start_text(world.placement_report(), world.is_placed())});
  table.add({"launches", launches_text(world, outcome.measurement)});
  table.add({"moved", moved_text(outcome.measurement)});
  table.add({"hash", fmt::format("{} (bodies alone {})", hash_text(outcome.hash), hash_text(outcome.body_hash))});
  if (world.settings().check)
    table.add(
        {"batches", world.batch_fault() ? "WRONG" : fmt::format("free of conflict in all {} steps", outcome.steps)});
  return table.text("  ");
}

void print_outcome(const Outcome &outcome, World &world, const Placement &placement)
{
  fmt::print("{}: {} bodies, {} steps of {:.6g} s on {}\n\n", outcome.scene, world.scene().bodies.size(), outcome.steps,
             world.settings().step, placement.on);
  fmt::print("{}\n{}", stage_table(outcome.measurement), facts_table(outcome, world, placement));
}

/* Warnings are printed in any case, whatever else is. */
void print_warnings(World &world, bool allow_quarantine)
{
  for (const Quarantine &quarantine : world.quarantined())
    fmt::print(stderr, "tandem: body {} '{}' stopped being finite in step {} ({}) and was taken out\n", quarantine.body,
               printable(quarantine.name), quarantine.step, quarantine.stage);
  if (!world.quarantined().empty() && !allow_quarantine)
    fmt::print(
        stderr,
        "tandem: {} of {} bodies did not stay finite, so this is no result; --allow-quarantine takes it for one\n",
        world.quarantined().size(), world.scene().bodies.size());
}

Outcome simulate(World &world, const RunOptions &options, uint64_t steps)
{
  AnimationFrames frames(options.save, world);
  std::optional<Trace> trace;
  if (!options.trace.empty()) trace.emplace(world);
  std::optional<EventFile> events;
  if (!options.events.empty()) events.emplace(options.events, options.scene.scene_text(), world);
  Progress progress("simulating", steps);
  Outcome outcome{options.scene.scene_text(), steps, {}, {}, {}, 0, 0, 0};
  if (trace) trace->begin_step();
  outcome.measurement = measure(world, steps, [&](uint64_t done) {
    if (trace) trace->end_step(done - 1);
    frames.add_frame(done);
    if (events) events->add_step(done - 1, world);
    progress.update(done);
    if (trace) trace->begin_step();
  });
  frames.finish();
  if (events) events->finish();
  if (trace) write_file("--trace", options.trace, trace->json());
  outcome.statistics = world.statistics();
  outcome.joints = summary_of(joint_errors(world.scene(), world.precise_bodies()));
  for (const double error : coupling_errors(world.scene(), world.precise_bodies()))
    outcome.coupling_error = std::max(outcome.coupling_error, error);
  outcome.hash = world.state_hash();
  outcome.body_hash = world.body_hash();
  return outcome;
}

void save_image(const RunOptions &options, World &world)
{
  if (options.image.empty()) return;
  const auto [width, height] = size_of_image(options.image_size);
  const Camera camera =
      options.camera.empty() ? camera_for(world, width, height) : camera_from(options.camera, width, height);
  write_png(options.image, draw(world, camera), width, height);
}

void start_recording(const RunOptions &options, World &world)
{
  if (options.record.empty()) return;
  RecordingOptions recording;
  if (!options.record_snapshots.empty())
    recording.snapshot_every = whole_number("--record-snapshots", options.record_snapshots, 1, 1'000'000'000);
  world.start_recording(options.record, recording);
}

Placement placement_of(const RunOptions &options, BuildingBar &bar)
{
  Placement placement = options.scene.placement();
  placement.start = start_from(options.start);
  bar.watch(placement);
  return placement;
}

void refuse_files_of_one_world(const RunOptions &options)
{
  for (const auto &[option, file] :
       {std::pair("--save", &options.save), std::pair("--image", &options.image), std::pair("--trace", &options.trace),
        std::pair("--events", &options.events), std::pair("--record", &options.record)})
    if (!file->empty()) throw InputError(fmt::format("--worlds: {} is of one world; leave one of the two out", option));
}

/* Many copies; the exit status is 1 if bodies did not stay finite, as in a run of one. */
int execute_worlds(const RunOptions &options)
{
  refuse_files_of_one_world(options);
  const auto count = static_cast<uint32_t>(whole_number("--worlds", options.worlds, 1, most_bodies));
  BuildingBar bar;
  const Placement placement = placement_of(options, bar);
  DistinctFiles files;
  check_files(options, files);
  Worlds worlds(options.scene.scene(files), count, options.scene.settings(), placement);
  bar.clear();
  const WorldsOutcome outcome = simulate_worlds(worlds, options.scene.scene_text(), options.scene.steps());
  if (!options.json.takes_standard_output()) fmt::print("{}", worlds_text(outcome, worlds, placement));
  options.json.write(worlds_json(outcome, worlds, placement));
  if (outcome.statistics.nonfinite == 0 || options.allow_quarantine) return 0;
  fmt::print(stderr,
             "tandem: {} bodies did not stay finite, so this is no result; --allow-quarantine takes it for one\n",
             outcome.statistics.nonfinite);
  return 1;
}

int execute(const RunOptions &options)
{
  if (!options.worlds.empty()) return execute_worlds(options);
  Settings settings = options.scene.settings();
  settings.events = !options.events.empty();
  BuildingBar bar;
  const Placement placement = placement_of(options, bar);
  const uint64_t steps = options.scene.steps();
  DistinctFiles files;
  check_files(options, files);
  World world(options.scene.scene(files), settings, placement);
  bar.clear();
  start_recording(options, world);
  const Outcome outcome = simulate(world, options, steps);
  bar.clear(); /* an automatic placement has waited in the first step */
  world.stop_recording();
  save_image(options, world);
  if (!options.json.takes_standard_output()) print_outcome(outcome, world, placement);
  print_warnings(world, options.allow_quarantine);
  options.json.write(outcome_json(outcome, world, placement));
  if (world.batch_fault()) fmt::print(stderr, "tandem: {}\n", describe(*world.batch_fault()));
  return world.batch_fault() || (!world.quarantined().empty() && !options.allow_quarantine) ? 1 : 0;
}

} // namespace

Command run_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("run", "simulate a scene");
  auto options = std::make_shared<RunOptions>(*command);
  add_options(*command, *options);
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
