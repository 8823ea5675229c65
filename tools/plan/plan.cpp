/* plan.cpp - `tandem plan`: prints what a scene needs, and what specialisation omits. */
#include "tools/plan/plan.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/runtime/interface/backend.h"
#include "host/runtime/interface/built_features.h"
#include "host/runtime/memory.h"
#include "tools/command/command.h"
#include "tools/command/output.h"
#include "tools/command/placement_text.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

struct PlanOptions {
  explicit PlanOptions(CLI::App &parser) : scene(parser, true) {}
  SceneOptions scene;
  std::string svg;
  JsonOutput json;
};

/* The broadphase, and the reason for it if it was chosen automatically. */
std::string broadphase_text(const World &world, Broadphase wanted)
{
  const std::string why = wanted == Broadphase::automatic ? fmt::format(", chosen for {}", world.broadphase_why()) : "";
  const BroadphaseRow &row = row_of(world.settings().broadphase);
  return fmt::format("{} ({}){}", row.name, row.what, why);
}

Json features_json(const Plan &plan)
{
  Json list = Json::array();
  for (int f = 0; f < FEATURE_COUNT; ++f)
    list.push_back({{"name", feature_rows[f].name}, {"what", feature_rows[f].what}, {"in", plan.has(f)}});
  return list;
}

Json kernels_json(const Plan &plan)
{
  Json list = Json::array();
  for (size_t k = 0; k < kernel_count; ++k) {
    const std::string backend = plan.backend_of(kernel_at(k));
    list.push_back({{"name", row_of(kernel_at(k)).name},
                    {"stage", name_of(row_of(kernel_at(k)).stage)},
                    {"built", plan.builds(kernel_at(k))},
                    {"built_with_all_features", plan.builds_with_all(kernel_at(k))},
                    {"brought_in_by", what_brings_in(kernel_at(k))},
                    {"backend", backend.empty() ? Json(nullptr) : Json(backend)}});
  }
  return list;
}

/* For a buffer that is omitted, the bytes are those that it would take with every feature. */
Json buffers_json(const Plan &plan)
{
  Json list = Json::array();
  for (size_t b = 0; b < buffer_count; ++b) {
    const uint64_t bytes = plan.bytes(buffer_at(b));
    const std::optional<Buffer> landlord = landlord_of(plan.chosen, buffer_at(b));
    list.push_back({{"name", row_of(buffer_at(b)).name},
                    {"stage", name_of(stage_of(buffer_at(b)))},
                    {"kept", bytes > 0},
                    {"bytes", bytes ? bytes : plan.bytes_with_all(buffer_at(b))},
                    {"in_memory_of", landlord ? Json(row_of(*landlord).name) : Json(nullptr)}});
  }
  return list;
}

/* The distinct backends of the kernels that are built. */
std::vector<Backend *> backends_of(const Plan &plan)
{
  std::vector<Backend *> backends;
  for (const Kernel kernel : plan.chosen.kernels()) {
    Backend *const backend = &plan.chosen.backend_of(kernel);
    if (std::find(backends.begin(), backends.end(), backend) == backends.end()) backends.push_back(backend);
  }
  return backends;
}

Json compiled_json(const Plan &plan)
{
  Json list = Json::array();
  for (const Backend *backend : backends_of(plan))
    for (const Backend::Compiled &program : backend->compiled())
      list.push_back({{"backend", backend->name()},
                      {"stage", name_of(program.stage)},
                      {"options", program.options},
                      {"kernels", program.kernels}});
  return list;
}

Json plan_json(const Plan &plan, const std::string &scene, const Placement &placement)
{
  const BytesEach each = bytes_each(plan.chosen);
  return {{"scene", scene},
          {"backend", placement.on},
          {"features", features_json(plan)},
          {"flags", plan.flags()},
          {"library_features", built_option()},
          {"library_option", plan.library_option()},
          {"broadphase", name_of(plan.chosen.settings().broadphase)},
          {"broadphase_why", plan.chosen.broadphase_why()},
          {"placement", placement_json(plan.chosen.placement_report())},
          {"kernels", kernels_json(plan)},
          {"compiled", compiled_json(plan)},
          {"kernels_built", plan.chosen.kernels().size()},
          {"buffers", buffers_json(plan)},
          {"memory_bytes", plan.chosen.memory().total_bytes()},
          {"bytes_a_body", each.body},
          {"bytes_a_pair", each.pair},
          {"room_for_pairs", each.room},
          {"build_ms", plan.chosen.build_milliseconds()}};
}

/* What it was configured for. */
std::string library_text()
{
  const std::string option = built_option();
  return option.empty() ? "built for all features" : fmt::format("built for TANDEM_FEATURES=\"{}\"", option);
}

void print_features(const Plan &plan)
{
  Table table({"feature", "", "what brings it in"}, false);
  for (int f = 0; f < FEATURE_COUNT; ++f)
    table.add({feature_rows[f].name, plan.has(f) ? "in" : "out", feature_rows[f].what});
  fmt::print("{}\nflags: {}\n", table.text("  "), plan.flags());
  fmt::print("library: {}; for such scenes alone: {}\n\n", library_text(), plan.library_option());
}

/* Breaks names into lines of at most 100 columns. */
std::string wrapped(const std::vector<std::string> &names, const std::string &indent)
{
  std::string text, line;
  for (const std::string &name : names) {
    if (!line.empty() && line.size() + name.size() > 100) text += indent + line + "\n", line.clear();
    line += name + " ";
  }
  return line.empty() ? text : text + indent + line.substr(0, line.size() - 1) + "\n";
}

/* Kernels that are left out, by what would bring them in. */
void print_left_out(const Plan &plan, Stage stage)
{
  std::map<std::string, std::vector<std::string>> by_reason;
  for (size_t k = 0; k < kernel_count; ++k)
    if (row_of(kernel_at(k)).stage == stage && !plan.builds(kernel_at(k)))
      by_reason[what_brings_in(kernel_at(k))].push_back(row_of(kernel_at(k)).name);
  for (const auto &[reason, names] : by_reason)
    fmt::print("  {}, left out without {}\n{}", name_of(stage), reason, wrapped(names, "    "));
}

void print_kernels(const Plan &plan)
{
  for (size_t s = 0; s < stage_count; ++s) {
    std::map<std::string, std::vector<std::string>> by_backend;
    for (size_t k = 0; k < kernel_count; ++k)
      if (row_of(kernel_at(k)).stage == static_cast<Stage>(s) && plan.builds(kernel_at(k)))
        by_backend[plan.backend_of(kernel_at(k))].push_back(row_of(kernel_at(k)).name);
    for (const auto &[backend, names] : by_backend)
      fmt::print("  {} on {}\n{}", name_of(static_cast<Stage>(s)), backend, wrapped(names, "    "));
    print_left_out(plan, static_cast<Stage>(s));
  }
}

/* What drivers have compiled, which may be more than the step launches: some compile a stage as a whole. */
void print_compiled(const Plan &plan)
{
  for (const Backend *backend : backends_of(plan)) {
    const std::vector<Backend::Compiled> programs = backend->compiled();
    if (programs.empty())
      fmt::print("\ncompiled on {}: nothing, its kernels are part of the library\n", backend->name());
    else fmt::print("\ncompiled on {}:\n", backend->name());
    for (const Backend::Compiled &program : programs)
      fmt::print("  {} with {} kernels: {}\n", name_of(program.stage), program.kernels.size(), program.options);
  }
}

void print_stages(const Plan &plan)
{
  Table table({"stage", "kernels", "with all features", "bytes", "with all features"});
  for (const StageSum &sum : sums_by_stage(plan))
    table.add({name_of(sum.stage), fmt::format("{}", sum.kernels), fmt::format("{}", sum.kernels_with_all),
               fmt::format("{}", sum.bytes), fmt::format("{}", sum.bytes_with_all)});
  fmt::print("\n{}", table.text("  "));
}

void print_buffers(const Plan &plan)
{
  Table kept({"buffer kept", "bytes", "in the memory of"}), out({"buffer left out", "bytes saved"});
  for (size_t b = 0; b < buffer_count; ++b) {
    const uint64_t bytes = plan.bytes(buffer_at(b)), saved = plan.bytes_with_all(buffer_at(b));
    const std::optional<Buffer> landlord = landlord_of(plan.chosen, buffer_at(b));
    if (bytes) kept.add({row_of(buffer_at(b)).name, fmt::format("{}", bytes), landlord ? row_of(*landlord).name : ""});
    else if (saved) out.add({row_of(buffer_at(b)).name, fmt::format("{}", saved)});
    else out.add({row_of(buffer_at(b)).name, "-"});
  }
  fmt::print("\n{}\n{}\n", kept.text("  "), out.text("  "));
}

void print_placement(const Plan &plan)
{
  const PlacementReport report = plan.chosen.placement_report();
  const std::string stages = stage_times_table(report);
  fmt::print("placement: {}\n{}\n", placement_text(report), stages.empty() ? "" : "\n" + stages);
}

void print_plan(const Plan &plan, const std::string &scene, Broadphase broadphase)
{
  fmt::print("{}: {} bodies\n\n", scene, plan.chosen.scene().bodies.size());
  print_features(plan);
  fmt::print("broadphase: {}\n\n", broadphase_text(plan.chosen, broadphase));
  print_placement(plan);
  fmt::print("kernels: {} of {} built in {:.0f} ms\n", plan.chosen.kernels().size(), kernel_count,
             plan.chosen.build_milliseconds());
  print_kernels(plan);
  print_compiled(plan);
  print_stages(plan);
  print_buffers(plan);
  const BytesEach each = bytes_each(plan.chosen);
  fmt::print("memory: {}, of which {:.0f} bytes a body and {:.0f} a pair, with room for {} pairs\n",
             bytes_text(plan.chosen.memory().total_bytes()), each.body, each.pair, each.room);
}

/* The choice is made by the times of steps, so some are made, and one more on what was chosen. A scene that never
 * settles is described as it is then. */
void choose_placement(World &world)
{
  constexpr int most_steps = 64;
  if (world.placement_report().settled) return;
  for (int step = 0; step < most_steps && !world.placement_report().settled; ++step) {
    world.finish();
    world.step();
  }
  world.step();
}

int execute(const PlanOptions &options)
{
  Settings settings = options.scene.settings();
  const Broadphase broadphase = settings.broadphase;
  const Placement placement = options.scene.placement();
  DistinctFiles files;
  files.writes("--svg", options.svg);
  options.json.check(files);
  const Scene scene = options.scene.scene(files);
  World chosen(scene, settings, placement);
  choose_placement(chosen);
  settings.specialise = false;
  settings.broadphase = chosen.settings().broadphase;
  World everything(scene, settings, Placement{"tbb", {}, false});
  const Plan plan(chosen, everything);
  if (!options.json.takes_standard_output()) print_plan(plan, options.scene.scene_text(), broadphase);
  if (!options.svg.empty()) write_file("--svg", options.svg, picture_of(plan, options.scene.scene_text()));
  options.json.write(plan_json(plan, options.scene.scene_text(), placement));
  return 0;
}

} // namespace

Command plan_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("plan", "say what a scene needs: features, kernels, flags, buffers");
  auto options = std::make_shared<PlanOptions>(*command);
  options->scene.add_events_flag(*command);
  command
      ->add_option(
          "--svg", options->svg,
          "draw the stages with their kernels and buffers, kept and left out, and those of all features beside "
          "them")
      ->type_name("F.svg");
  command->add_option("--json", options->json.path, "write the plan as JSON; - for standard output")->type_name("FILE");
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
