/* replay.cpp - `tandem replay`: makes the calls and steps of a recording again, on any backend, and compares. */
#include <chrono>
#include <memory>

#include <fmt/format.h>

#include <tandem/backend.h>
#include <tandem/recording.h>
#include <tandem/version.h>
#include <tandem/world.h>

#include "host/base/printable.h"
#include "tools/command/command.h"
#include "tools/command/output.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"
#include "tools/replay/recording_file.h"

namespace tandem {
namespace {

struct ReplayOptions {
  std::string file, on = "tbb", place, from = "0";
  bool verify = false, inexact = false;
  JsonOutput json;
};

void add_options(CLI::App &parser, ReplayOptions &options)
{
  parser.add_option("FILE", options.file, "a recording, as `tandem run --record` and World::start_recording write it")
      ->required()
      ->type_name("");
  parser.add_option("--on", options.on, "backend: serial, tbb[:threads=N,lanes=N], cl, cl:P.D, cl:PART-OF-A-NAME")
      ->type_name("B")
      ->capture_default_str();
  parser.add_option("--place", options.place, "run a stage or a kernel elsewhere: narrowphase=cl,solve=tbb")
      ->type_name("STAGE=B,...");
  parser.add_flag("--verify", options.verify,
                  "compare the state after every step with its hash in the recording; without it, after the last one");
  parser
      .add_option("--from", options.from,
                  "begin at the last snapshot before this step, and compare from this step on; the first is 0")
      ->type_name("STEP")
      ->capture_default_str();
  parser.add_flag("--inexact", options.inexact, "accept devices that fail the exactness self-test");
  parser.add_option("--json", options.json.path, "write the verdict as JSON; - for standard output")->type_name("FILE");
  parser.footer("Exit status: 0 equal, 1 another state than the recording's, or memory did not suffice, 2 bad use or "
                "input, a damaged file, or an output that cannot be written.");
}

struct ReplayOutcome {
  uint64_t first, compared, steps;
  double milliseconds; /* of all steps and calls */
  uint64_t hash;
  std::optional<RecordedDifference> difference;
};

Json difference_json(const RecordedDifference &difference)
{
  return {{"step", difference.step},
          {"recorded", hash_text(difference.recorded)},
          {"found", hash_text(difference.found)},
          {"body", difference.body ? Json(*difference.body) : Json(nullptr)},
          {"body_name", difference.name},
          {"body_step", difference.body_step}};
}

Json outcome_json(const ReplayOptions &options, const WorldRecording &recording, World &world,
                  const ReplayOutcome &outcome)
{
  return {{"recording", options.file},
          {"backend", options.on},
          {"made_by", recording.made_by()},
          {"finished", recording.finished()},
          {"bodies", world.body_count()},
          {"steps", recording.steps()},
          {"from", outcome.first},
          {"steps_made", outcome.steps},
          {"steps_compared", outcome.compared},
          {"ms", outcome.milliseconds},
          {"hash", hash_text(outcome.hash)},
          {"equal", !outcome.difference},
          {"first_difference", outcome.difference ? difference_json(*outcome.difference) : Json(nullptr)}};
}

std::string body_text(const RecordedDifference &difference)
{
  if (!difference.body)
    return "no body: what differs is in the contact cache, or the recording has no hashes of bodies";
  const std::string name = difference.name.empty() ? "" : fmt::format(" '{}'", printable(difference.name));
  return difference.body_step == difference.step
             ? fmt::format("body {}{} is the first that differs", *difference.body, name)
             : fmt::format("body {}{} is the first that differs in step {}, the next with hashes of bodies",
                           *difference.body, name, difference.body_step);
}

void print_outcome(const ReplayOptions &options, const WorldRecording &recording, const ReplayOutcome &outcome)
{
  if (const auto &difference = outcome.difference)
    fmt::print("DIFFERENT: {} in step {} of {}: hash {}, recorded {}\n  {}\n", options.on, difference->step,
               recording.steps(), hash_text(difference->found), hash_text(difference->recorded),
               body_text(*difference));
  else
    fmt::print("EQUAL: {} on {}: {} of {} steps made in {:.0f} ms, {} compared, hash {}\n", options.file, options.on,
               outcome.steps, recording.steps(), outcome.milliseconds, outcome.compared, hash_text(outcome.hash));
}

void print_warnings(const ReplayOptions &options, const WorldRecording &recording, const ReplayOutcome &outcome)
{
  if (!recording.finished())
    fmt::print(stderr, "tandem: {} ends after {} steps without its end: the program that wrote it stopped there\n",
               options.file, recording.steps());
  if (outcome.compared == 0)
    fmt::print(stderr, "tandem: {} has no hashes to compare with (RecordingOptions::hashes)\n", options.file);
  if (outcome.difference && recording.made_by() != version())
    fmt::print(stderr, "tandem: {} was made by Tandem {}; this is {}, whose bits may differ\n", options.file,
               recording.made_by(), version());
}

uint64_t steps_compared(const WorldRecording &recording, const ReplayRequest &request, uint64_t made)
{
  uint64_t compared = 0;
  for (uint64_t step = request.first; step < request.first + made; ++step)
    if (recording.has_hash(step) && (step + 1 == recording.steps() || (request.verify && step >= request.verify_from)))
      ++compared;
  return compared;
}

ReplayOutcome make_again(const ReplayOptions &options, const WorldRecording &recording, World &world,
                         ReplayRequest request)
{
  Progress progress("replaying", recording.steps());
  uint64_t made = 0;
  request.after_step = [&](uint64_t done) {
    made = done - request.first;
    progress.update(done);
  };
  const auto start = std::chrono::steady_clock::now();
  ReplayOutcome outcome{request.first, 0, 0, 0, 0, replay(recording, world, request)};
  outcome.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  progress.clear();
  if (outcome.difference) made = outcome.difference->step + 1 - request.first;
  outcome.steps = made;
  outcome.compared = steps_compared(recording, request, made);
  outcome.hash = outcome.difference ? outcome.difference->found : world.state_hash();
  static_cast<void>(options);
  return outcome;
}

int execute(const ReplayOptions &options)
{
  Placement placement{options.on, {}, options.inexact, false};
  if (!options.place.empty()) placement.exceptions = parse_placement(options.place);
  DistinctFiles files;
  options.json.check(files);
  const WorldRecording recording = read_recording(options.file, files);
  const uint64_t last = recording.steps() == 0 ? 0 : recording.steps() - 1;
  ReplayRequest request;
  request.verify_from = whole_number("--from", options.from, 0, last);
  request.first = recording.snapshot_step(request.verify_from);
  request.verify = options.verify;
  World world(recording.snapshot(request.verify_from), placement);
  const ReplayOutcome outcome = make_again(options, recording, world, request);
  if (!options.json.takes_standard_output()) print_outcome(options, recording, outcome);
  print_warnings(options, recording, outcome);
  options.json.write(outcome_json(options, recording, world, outcome));
  return outcome.difference ? 1 : 0;
}

} // namespace

Command replay_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("replay", "make the calls and steps of a recording again, and compare");
  auto options = std::make_shared<ReplayOptions>();
  add_options(*command, *options);
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
