/* plan.cpp - `tandem plan`: prints what a scene needs, and what specialisation omits. */
#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "tools/command/command.h"
#include "tools/command/output.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

struct PlanOptions {
  explicit PlanOptions(CLI::App &parser) : scene(parser, true) {}
  SceneOptions scene;
  JsonOutput json;
};

struct Feature {
  const char *name;
  const char *what;
};

constexpr Feature feature_rows[] = {
#define FEATURE(name, what) {#name, what},
#include "shared/features.def"
#undef FEATURE
};

/* The scene's world and one with all features; the difference is what specialisation saves. */
struct Plan {
  World &chosen;
  World &everything;
  std::vector<bool> built;

  Plan(World &chosen, World &everything) : chosen(chosen), everything(everything), built(kernel_count, false)
  {
    for (const Kernel kernel : chosen.kernels()) built[index_of(kernel)] = true;
  }
  bool has(int feature) const { return (chosen.features() & feature_of_index(feature)) != 0; }
  std::string flags() const { return fmt::format("-D FEATURES={:#x}ul", chosen.features()); }
  /* The broadphase, and the reason for it if it was chosen automatically. */
  std::string broadphase_text(Broadphase wanted) const
  {
    const std::string why =
        wanted == Broadphase::automatic ? fmt::format(", chosen for {}", chosen.broadphase_why()) : "";
    const BroadphaseRow &row = row_of(chosen.settings().broadphase);
    return fmt::format("{} ({}){}", row.name, row.what, why);
  }
  std::string backend_of(Kernel kernel) const
  {
    return built[index_of(kernel)] ? chosen.backend_of(kernel).name() : "";
  }
};

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
                    {"built", static_cast<bool>(plan.built[k])},
                    {"backend", backend.empty() ? Json(nullptr) : Json(backend)}});
  }
  return list;
}

/* For a buffer that is omitted, the bytes are those that it would take with every feature. */
Json buffers_json(const Plan &plan)
{
  Json list = Json::array();
  for (size_t b = 0; b < buffer_count; ++b) {
    const uint64_t bytes = plan.chosen.memory().bytes(buffer_at(b));
    list.push_back({{"name", row_of(buffer_at(b)).name},
                    {"kept", bytes > 0},
                    {"bytes", bytes ? bytes : plan.everything.memory().bytes(buffer_at(b))}});
  }
  return list;
}

Json plan_json(const Plan &plan, const std::string &scene, const Placement &placement)
{
  return {{"scene", scene},
          {"backend", placement.on},
          {"features", features_json(plan)},
          {"flags", plan.flags()},
          {"broadphase", name_of(plan.chosen.settings().broadphase)},
          {"broadphase_why", plan.chosen.broadphase_why()},
          {"kernels", kernels_json(plan)},
          {"kernels_built", plan.chosen.kernels().size()},
          {"buffers", buffers_json(plan)},
          {"memory_bytes", plan.chosen.memory().total_bytes()},
          {"build_ms", plan.chosen.build_milliseconds()}};
}

void print_features(const Plan &plan)
{
  Table table({"feature", "", "what brings it in"}, false);
  for (int f = 0; f < FEATURE_COUNT; ++f)
    table.add({feature_rows[f].name, plan.has(f) ? "in" : "out", feature_rows[f].what});
  fmt::print("{}\nflags: {}\n\n", table.text("  "), plan.flags());
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

void print_kernels(const Plan &plan)
{
  for (size_t s = 0; s < stage_count; ++s) {
    std::map<std::string, std::vector<std::string>> by_backend;
    std::vector<std::string> out;
    for (size_t k = 0; k < kernel_count; ++k) {
      if (row_of(kernel_at(k)).stage != static_cast<Stage>(s)) continue;
      if (plan.built[k]) by_backend[plan.backend_of(kernel_at(k))].push_back(row_of(kernel_at(k)).name);
      else out.push_back(row_of(kernel_at(k)).name);
    }
    for (const auto &[backend, names] : by_backend)
      fmt::print("  {} on {}\n{}", name_of(static_cast<Stage>(s)), backend, wrapped(names, "    "));
    if (!out.empty()) fmt::print("  {}, left out\n{}", name_of(static_cast<Stage>(s)), wrapped(out, "    "));
  }
}

void print_buffers(const Plan &plan)
{
  Table kept({"buffer kept", "bytes"}), out({"buffer left out", "bytes saved"});
  for (size_t b = 0; b < buffer_count; ++b) {
    const uint64_t bytes = plan.chosen.memory().bytes(buffer_at(b)),
                   saved = plan.everything.memory().bytes(buffer_at(b));
    if (bytes) kept.add({row_of(buffer_at(b)).name, fmt::format("{}", bytes)});
    else if (saved) out.add({row_of(buffer_at(b)).name, fmt::format("{}", saved)});
    else out.add({row_of(buffer_at(b)).name, "-"});
  }
  fmt::print("\n{}\n{}\n", kept.text("  "), out.text("  "));
}

void print_plan(const Plan &plan, const std::string &scene, Broadphase broadphase)
{
  fmt::print("{}: {} bodies\n\n", scene, plan.chosen.scene().bodies.size());
  print_features(plan);
  fmt::print("broadphase: {}\n\n", plan.broadphase_text(broadphase));
  fmt::print("kernels: {} of {} built in {:.0f} ms\n", plan.chosen.kernels().size(), kernel_count,
             plan.chosen.build_milliseconds());
  print_kernels(plan);
  print_buffers(plan);
  fmt::print("memory: {}\n", bytes_text(plan.chosen.memory().total_bytes()));
}

int execute(const PlanOptions &options)
{
  Settings settings = options.scene.settings();
  const Broadphase broadphase = settings.broadphase;
  const Placement placement = options.scene.placement();
  DistinctFiles files;
  options.json.check(files);
  const Scene scene = options.scene.scene(files);
  World chosen(scene, settings, placement);
  settings.specialise = false;
  settings.broadphase = chosen.settings().broadphase;
  World everything(scene, settings, Placement{"serial", {}, false});
  const Plan plan(chosen, everything);
  if (!options.json.takes_standard_output()) print_plan(plan, options.scene.scene_text(), broadphase);
  options.json.write(plan_json(plan, options.scene.scene_text(), placement));
  return 0;
}

} // namespace

Command plan_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("plan", "say what a scene needs: features, kernels, flags, buffers");
  auto options = std::make_shared<PlanOptions>(*command);
  options->scene.add_events_flag(*command);
  command->add_option("--json", options->json.path, "write the plan as JSON; - for standard output")->type_name("FILE");
  return {command, [options] { return execute(*options); }};
}

} // namespace tandem
