/* diff.cpp - `tandem diff`: runs the same scene on several backends and compares every kernel bit for bit. */
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/compare.h>

#include "host/base/printable.h"
#include "host/runtime/backend_list.h"
#include "host/runtime/interface/module.h"
#include "tools/command/command.h"
#include "tools/command/output.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"
#include "tools/replay/recording_file.h"

namespace tandem {
namespace {

struct DiffOptions {
  explicit DiffOptions(CLI::App &parser) : scene(parser, false) {}
  SceneOptions scene;
  std::string between = "serial,tbb", plant;
  JsonOutput json;
};

void add_options(CLI::App &parser, DiffOptions &options)
{
  parser.add_option("--between", options.between, "two or more backends; the first is the reference")
      ->type_name("B,B,...")
      ->capture_default_str();
  parser
      .add_option("--plant", options.plant,
                  "try the comparison out: on the last backend, change one number of what a kernel wrote by the least "
                  "possible (NUMBER counts floats or integers from the buffer's start; default step 0)")
      ->type_name("KERNEL:BUFFER:NUMBER[:STEP]");
  options.scene.add_events_flag(parser);
  parser.add_option("--json", options.json.path, "write the verdict as JSON; - for standard output")->type_name("FILE");
  parser.footer("After every kernel of every step each buffer that it wrote is compared as a whole.\n"
                "Exit status: 0 equal, also where bodies stopped being finite alike (which is said); 1 different, or a "
                "batch is wrong, or memory or the room that\n"
                "--max-pairs allows did not suffice; 2 bad use or input, a --plant that plants nothing, or an output "
                "that cannot be written.");
}

std::vector<std::string> split(const std::string &text, char separator)
{
  std::vector<std::string> parts;
  for (size_t at = 0; at <= text.size();) {
    const size_t end = std::min(text.find(separator, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return parts;
}

FaultInjector fault_injector(const std::string &text, size_t world, std::string &missing)
{
  if (text.empty()) return {};
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() < 3 || parts.size() > 4)
    throw InputError(fmt::format("--plant '{}': use KERNEL:BUFFER:NUMBER[:STEP]", text));
  InjectedFault error;
  error.world = world;
  const std::optional<Kernel> kernel = find_kernel(parts[0]);
  const std::optional<Buffer> buffer = find_buffer(parts[1]);
  if (!kernel) throw InputError(fmt::format("--plant: no kernel '{}'; `tandem plan SCENE` lists them", parts[0]));
  if (!buffer) throw InputError(fmt::format("--plant: no buffer '{}'; `tandem plan SCENE` lists them", parts[1]));
  error.kernel = *kernel;
  error.buffer = *buffer;
  error.scalar = whole_number("--plant, number", parts[2], 0, uint64_t{1} << 40);
  if (parts.size() == 4) error.step = whole_number("--plant, step", parts[3], 0, 1'000'000'000);
  return inject_fault(error, &missing);
}

/* The text of the scene may contain characters that a shell would interpret. */
std::string shell_quoted(const std::string &text)
{
  if (text.find_first_of(" '\"$`\\;&|<>()*?[]{}!#~") == std::string::npos) return text;
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string gdb_line(const Difference &difference, const SceneOptions &options, const std::string &broadphase)
{
  if (difference.breakpoint.empty()) return "";
  if (names_recording(options.scene_text()))
    return fmt::format("gdb -ex 'break {}' -ex run --args tandem replay {} --on serial", difference.breakpoint,
                       shell_quoted(options.scene_text()));
  return fmt::format("gdb -ex 'break {}' -ex run --args tandem run {} --on serial --steps {}{}", difference.breakpoint,
                     shell_quoted(options.scene_text()), difference.step + 1, options.typed_again(broadphase));
}

std::string kernel_name(const Difference &difference)
{
  return difference.kernel ? row_of(*difference.kernel).name : "";
}

/* Bodies that a recording creates are not in its first scene. */
std::string name_in(const Scene &scene, uint32_t body)
{
  return body < scene.bodies.size() ? scene.bodies[body].name : "";
}

Json bodies_json(const Difference &difference, const Scene &scene)
{
  Json bodies = Json::array();
  for (const uint32_t body : difference.bodies) bodies.push_back({{"index", body}, {"name", name_in(scene, body)}});
  return bodies;
}

Json difference_json(const Difference &difference, const Scene &scene, const SceneOptions &options,
                     const std::string &broadphase)
{
  const auto text_or_null = [](const std::string &text) { return text.empty() ? Json(nullptr) : Json(text); };
  Json json = {
      {"step", difference.step}, {"kernel", text_or_null(kernel_name(difference))}, {"launch", difference.launch}};
  json["buffer"] = difference.buffer ? Json(row_of(*difference.buffer).name) : Json(nullptr);
  json["element"] = difference.location.element;
  json["item"] = difference.location.item;
  json["field"] = text_or_null(difference.location.field);
  json["values"] = Json::array();
  for (int side = 0; side < 2; ++side)
    json["values"].push_back({{"backend", difference.backends[side]},
                              {"value", difference.values[side].decimal},
                              {"bits", difference.values[side].bits}});
  json["ulps"] = difference.ulps ? Json(*difference.ulps) : Json(nullptr);
  json["differing"] = difference.differing;
  json["bodies"] = bodies_json(difference, scene);
  json["gdb"] = text_or_null(gdb_line(difference, options, broadphase));
  json["note"] = text_or_null(difference.note);
  return json;
}

Json comparison_json(const Comparison &comparison, const ComparisonRequest &request, const Scene &scene,
                     const SceneOptions &options)
{
  const auto &difference = comparison.first_difference;
  return {{"equal", comparison.equal},
          {"backends", request.backends},
          {"broadphase", name_of(comparison.broadphase)},
          {"broadphase_why", comparison.broadphase_why},
          {"steps", comparison.steps},
          {"kernels_compared", comparison.kernels_compared},
          {"bytes_compared", comparison.bytes_compared},
          {"quarantined", comparison.quarantined.size()},
          {"first_difference",
           difference ? difference_json(*difference, scene, options, name_of(comparison.broadphase)) : Json(nullptr)}};
}

std::string bodies_text(const Difference &difference, const Scene &scene)
{
  std::vector<std::string> names;
  for (const uint32_t body : difference.bodies) {
    const std::string name = name_in(scene, body);
    names.push_back(name.empty() ? fmt::format("{}", body) : fmt::format("{} '{}'", body, name));
  }
  return fmt::format("{}", fmt::join(names, " and "));
}

void print_place(const Difference &difference, const Scene &scene)
{
  const BufferLocation &location = difference.location;
  Table table({"buffer", row_of(*difference.buffer).name}, false);
  table.add({"element", fmt::format("{} (item {})", location.element, location.item)});
  table.add({"field", location.field});
  if (!difference.bodies.empty())
    table.add({difference.bodies.size() == 1 ? "body" : "bodies", bodies_text(difference, scene)});
  for (int side = 0; side < 2; ++side)
    table.add({difference.backends[side],
               fmt::format("{} ({})", difference.values[side].decimal, difference.values[side].bits)});
  table.add(
      {"apart", difference.ulps ? fmt::format("{} ulp", *difference.ulps) : "not floating point, or not a number"});
  table.add({"in all", fmt::format("{} numbers of this buffer differ", difference.differing)});
  fmt::print("{}", table.text("  "));
}

void print_difference(const Difference &difference, const Scene &scene, const SceneOptions &options,
                      const std::string &broadphase)
{
  fmt::print("DIFFERENT: {} and {} in step {}", difference.backends[0], difference.backends[1], difference.step);
  if (difference.kernel) fmt::print(", kernel {} (launch {} of the step)", kernel_name(difference), difference.launch);
  fmt::print("\n");
  if (difference.buffer && !difference.breakpoint.empty()) print_place(difference, scene);
  if (!difference.note.empty()) fmt::print("  {}\n", difference.note);
  const std::string gdb = gdb_line(difference, options, broadphase);
  if (!gdb.empty()) fmt::print("\nTo stop there (debug build):\n  {}\n", gdb);
}

/* Quarantined bodies are no difference between backends, but the comparison has no valid result either. */
std::string quarantine_text(const std::vector<Quarantine> &lost, const std::string &backend, const Scene &scene)
{
  const Quarantine &first = lost.front();
  return fmt::format(
      "{} of {} bodies stopped being finite on {} and were taken out, first body {} '{}' in step {} ({})", lost.size(),
      scene.bodies.size(), backend, first.body, first.name, first.step, first.stage);
}

/* The worlds of a recording begin with its snapshot, and its calls are made before each step. `request` refers to the
 * result. */
WorldRecording take_recording(const DiffOptions &options, DistinctFiles &files, ComparisonRequest &request)
{
  const std::string given = options.scene.typed_again(name_of(Settings{}.broadphase));
  if (!given.empty() || request.settings.broadphase != Settings{}.broadphase)
    throw InputError(fmt::format("{}: a recording has settings of its own; leave out{}",
                                 printable(options.scene.scene_text()), given.empty() ? " --broadphase" : given));
  WorldRecording recording = read_recording(options.scene.scene_text(), files);
  if (recording.steps() == 0)
    throw InputError(fmt::format("{}: the recording has no step to compare", printable(options.scene.scene_text())));
  request.steps = std::min(options.scene.steps_given().value_or(recording.steps()), recording.steps());
  return recording;
}

int execute(const DiffOptions &options)
{
  ComparisonRequest request;
  request.settings = options.scene.settings();
  request.placement = options.scene.placement();
  request.backends = split_backends(options.between);
  if (request.backends.size() < 2)
    throw InputError(fmt::format("--between {}: name at least two backends", options.between));
  request.steps = options.scene.steps();
  std::string not_planted;
  request.inject_fault = fault_injector(options.plant, request.backends.size() - 1, not_planted);
  DistinctFiles files;
  options.json.check(files);
  std::optional<WorldRecording> recording;
  if (names_recording(options.scene.scene_text())) recording = take_recording(options, files, request);
  const Scene scene = recording ? World(recording->snapshot(), {"serial", {}}).scene() : options.scene.scene(files);
  if (recording) {
    request.snapshot = recording->snapshot();
    request.before_step = [&](World &world, uint64_t step) { recording->make_calls(world, step); };
  }
  Progress progress("comparing", request.steps);
  request.after_step = [&](uint64_t done) { progress.update(done); };
  const Comparison comparison = compare_backends(scene, request);
  progress.clear();
  if (comparison.equal && !not_planted.empty())
    throw InputError(
        fmt::format("--plant {}: nothing was planted in {} steps: {}", options.plant, comparison.steps, not_planted));
  if (!options.json.takes_standard_output()) {
    if (comparison.equal) fmt::print("EQUAL");
    else print_difference(*comparison.first_difference, scene, options.scene, name_of(comparison.broadphase));
    fmt::print("{}{}: {} steps, {} kernels and {} compared bit for bit\n", comparison.equal ? ": " : "\n",
               fmt::join(request.backends, ", "), comparison.steps, comparison.kernels_compared,
               bytes_text(comparison.bytes_compared));
    fmt::print("Broadphase on all of them: {} ({})\n", name_of(comparison.broadphase), comparison.broadphase_why);
  }
  options.json.write(comparison_json(comparison, request, scene, options.scene));
  if (!comparison.quarantined.empty())
    fmt::print(stderr, "tandem: {}\n", quarantine_text(comparison.quarantined, request.backends.front(), scene));
  if (comparison.batch_fault) fmt::print(stderr, "tandem: {}\n", describe(*comparison.batch_fault));
  return comparison.equal && !comparison.batch_fault ? 0 : 1;
}

} // namespace

Command diff_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("diff", "compare every kernel's outputs between backends, bit for bit");
  auto options = std::make_shared<DiffOptions>(*command);
  add_options(*command, *options);
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
