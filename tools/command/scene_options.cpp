/* scene_options.cpp - see scene_options.h. Numbers are parsed here and not by CLI11, so that the message for a bad one
 * says what would be right. */
#include "tools/command/scene_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/base/out_of_memory.h"
#include "host/catalog/catalog.h"
#include "host/io/input_file.h"

namespace tandem {
namespace {

constexpr uint64_t most_steps = 1'000'000'000;

std::string one_of(const char *what, const std::vector<std::string> &names)
{
  return fmt::format("{}: {}", what, fmt::join(names, ", "));
}

} // namespace

uint64_t whole_number(const std::string &option, const std::string &text, uint64_t lowest, uint64_t highest)
{
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < lowest || value > highest)
    throw InputError(fmt::format("{} '{}': use a whole number from {} to {}", option, text, lowest, highest));
  return value;
}

double real_number(const std::string &option, const std::string &text)
{
  char *end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size() || !std::isfinite(value))
    throw InputError(fmt::format("{} '{}': use a finite number", option, text));
  return value;
}

void add_coordinates_option(CLI::App &parser, std::string &coordinates)
{
  parser
      .add_option("--coordinates", coordinates,
                  "of joints: maximal, or reduced: trees of them become articulations (docs/articulations.md)")
      ->type_name("NAME")
      ->capture_default_str();
}

Coordinates coordinates_of(const std::string &text)
{
  if (text == "maximal") return Coordinates::maximal;
  if (text == "reduced") return Coordinates::reduced;
  throw InputError(fmt::format("--coordinates '{}': use maximal or reduced", text));
}

SceneOptions::SceneOptions(CLI::App &parser, bool one_backend) : one_backend_(one_backend)
{
  const Settings defaults;
  step_ = "1/60";
  solver_ = name_of(defaults.solver);
  broadphase_ = name_of(defaults.broadphase);
  bounds_ = name_of(defaults.bounds);
  midphase_ = name_of(defaults.midphase);
  narrowphase_ = name_of(defaults.narrowphase);
  support_ = name_of(defaults.support);
  support_cells_ = fmt::format("{}", defaults.support_cells);
  batching_ = name_of(defaults.batching);
  max_pairs_ = fmt::format("{}", defaults.max_pairs);
  const auto option = [&](const char *name, std::string &value, const std::string &what, const char *type) {
    parser.add_option(name, value, what)->type_name(type)->capture_default_str();
  };
  const std::string recording = one_backend ? "" : ", a recording (.tandem)"; /* which `tandem replay` runs on one */
  parser.add_option("SCENE", scene_, "a file (.json, .gltf, .glb, .urdf, .xml)" + recording + " or name:key=value,...")
      ->required()
      ->type_name("");
  if (one_backend) option("--on", on_, "backend: serial, tbb[:threads=N,lanes=N], cl, cl:P.D, cl:PART-OF-A-NAME", "B");
  const std::string automatic =
      one_backend ? "; auto: on tbb, on the device of --on, or on both, whatever is fastest on the first steps" : "";
  option("--place", place_, "run a stage or a kernel elsewhere: narrowphase=cl,solve=tbb" + automatic, "STAGE=B,...");
  option("--steps", steps_, "how many steps", "N");
  steps_option_ = parser.get_option("--steps");
  option("--dt", step_, "time step in seconds, or a fraction 1/N", "S");
  option("--substeps", substeps_,
         "substeps of a step, or auto: as many as loads and stacks need; what the solver wants if not given", "N");
  option("--iterations", iterations_, "solver passes of a substep; what the solver wants if not given", "N");
  option("--joint-hertz", joint_hertz_,
         "frequency of soft joints; at most 0.28 of the substep rate is used; 60 if not given", "HZ");
  option("--solver", solver_, one_of("solver", choice_names<Solver>()), "NAME");
  option("--broadphase", broadphase_,
         one_of("broadphase", choice_names<Broadphase>()) + "; auto: as the scene suggests (`tandem plan` says why)",
         "NAME");
  option("--bounds", bounds_, one_of("bounds", choice_names<Bounds>()), "NAME");
  option("--midphase", midphase_, one_of("walk of the trees of meshes and compounds", choice_names<Midphase>()),
         "NAME");
  option("--narrowphase", narrowphase_, one_of("narrowphase", choice_names<Narrowphase>()), "NAME");
  option("--support", support_, one_of("support of hulls", choice_names<Support>()), "NAME");
  option("--support-cells", support_cells_, "cells along a side of the cube maps of hill-climbing and cube-map", "N");
  option("--batching", batching_, one_of("batching", choice_names<Batching>()), "NAME");
  option("--max-pairs", max_pairs_, "room for pairs never grows past so many: a step that needs more ends the run",
         "N");
  parser.add_flag("--check", check_,
                  "prove in every step that no batch touches a moving body twice and that every contact is in one; "
                  "exit status 1 if not");
  parser.add_flag("--sleep", sleep_, "islands of bodies at rest fall asleep; what sleeps costs nothing");
  parser.add_flag("--tree-joint-forces", tree_joint_forces_,
                  "compute the forces of the joints of articulations, which programs read with read_joints");
  parser.add_flag("--no-specialise", no_specialise_,
                  "build and run every feature, needed or not: the same bits, slower");
  parser.add_flag("--allow-outside-files", outside_files_,
                  "let a scene file name files (buffers, OBJ files) outside its own folder");
  add_coordinates_option(parser, coordinates_);
  parser.add_flag("--inexact", inexact_, "accept devices that fail the exactness self-test");
}

void SceneOptions::add_events_flag(CLI::App &parser)
{
  parser.add_flag("--events", events_, "with contact events, as `run --events F.json` has them");
}

namespace {

uint32_t substeps_of(const std::string &text)
{
  if (text == "auto") return automatic_substeps;
  try {
    return static_cast<uint32_t>(whole_number("--substeps", text, 1, 1000));
  } catch (const InputError &error) {
    throw InputError(fmt::format("{}, or auto", error.what()));
  }
}

} // namespace

Settings SceneOptions::settings() const
{
  Settings settings = settings_for(parse_setting<Solver>(solver_));
  if (step_.starts_with("1/")) settings.step = static_cast<float>(1.0 / real_number("--dt", step_.substr(2)));
  else settings.step = static_cast<float>(real_number("--dt", step_));
  if (!substeps_.empty()) settings.substeps = substeps_of(substeps_);
  if (!iterations_.empty())
    settings.iterations = static_cast<uint32_t>(whole_number("--iterations", iterations_, 1, 1000));
  if (!joint_hertz_.empty()) settings.joint_hertz = static_cast<float>(real_number("--joint-hertz", joint_hertz_));
  settings.broadphase = parse_setting<Broadphase>(broadphase_);
  settings.bounds = parse_setting<Bounds>(bounds_);
  settings.midphase = parse_setting<Midphase>(midphase_);
  settings.narrowphase = parse_setting<Narrowphase>(narrowphase_);
  settings.support = parse_setting<Support>(support_);
  settings.support_cells = static_cast<uint32_t>(whole_number("--support-cells", support_cells_, 1, 256));
  settings.batching = parse_setting<Batching>(batching_);
  settings.max_pairs = static_cast<uint32_t>(whole_number("--max-pairs", max_pairs_, 1, most_pairs));
  settings.check = check_;
  settings.events = events_;
  settings.sleeping = sleep_;
  settings.tree_joint_forces = tree_joint_forces_;
  settings.specialise = !no_specialise_;
  validate(settings);
  return settings;
}

Placement SceneOptions::placement() const
{
  constexpr const char *automatic = "auto";
  Placement placement;
  placement.on = on_;
  placement.automatic = place_ == automatic || place_.starts_with(std::string(automatic) + ",");
  const std::string exceptions =
      placement.automatic ? place_.substr(std::min(place_.size(), std::strlen(automatic) + 1)) : place_;
  if (!exceptions.empty() || place_.ends_with(',')) placement.exceptions = parse_placement(exceptions);
  if (placement.automatic && !one_backend_)
    throw InputError("--place auto: what is compared runs where --between says; name stages instead");
  placement.allow_inexact = inexact_;
  validate(placement);
  return placement;
}

uint64_t SceneOptions::steps() const { return whole_number("--steps", steps_, 1, most_steps); }

std::optional<uint64_t> SceneOptions::steps_given() const
{
  return steps_option_->count() > 0 ? std::optional(steps()) : std::nullopt;
}

Scene SceneOptions::scene(DistinctFiles &files) const
{
  const auto load = [&] {
    const FilesRead read;
    Scene scene = load_scene(scene_, outside_files_ ? OutsideFiles::allowed : OutsideFiles::refused,
                             coordinates_of(coordinates_));
    for (const std::string &path : read.paths) files.reads("SCENE", path);
    for (const std::string &warning : warnings_of(scene, scene_)) fmt::print(stderr, "tandem: {}\n", warning);
    return scene;
  };
  return naming_what_failed([&] { return fmt::format("out of memory: scene {} takes more than there is", scene_); },
                            load);
}

std::string SceneOptions::typed_again(const std::string &broadphase) const
{
  const Settings defaults;
  std::string text;
  const auto add = [&](const char *name, const std::string &value, const std::string &standard) {
    if (value != standard) text += fmt::format(" {} {}", name, value);
  };
  add("--dt", step_, "1/60");
  add("--substeps", substeps_, "");
  add("--iterations", iterations_, "");
  add("--joint-hertz", joint_hertz_, "");
  add("--solver", solver_, name_of(defaults.solver));
  add("--broadphase", broadphase, name_of(defaults.broadphase));
  add("--bounds", bounds_, name_of(defaults.bounds));
  add("--midphase", midphase_, name_of(defaults.midphase));
  add("--narrowphase", narrowphase_, name_of(defaults.narrowphase));
  add("--support", support_, name_of(defaults.support));
  add("--support-cells", support_cells_, fmt::format("{}", defaults.support_cells));
  add("--batching", batching_, name_of(defaults.batching));
  add("--max-pairs", max_pairs_, fmt::format("{}", defaults.max_pairs));
  add("--coordinates", coordinates_, "maximal");
  if (outside_files_) text += " --allow-outside-files";
  if (check_) text += " --check";
  if (events_) text += " --events events.json";
  if (sleep_) text += " --sleep";
  if (tree_joint_forces_) text += " --tree-joint-forces";
  if (no_specialise_) text += " --no-specialise";
  return text;
}

} // namespace tandem
