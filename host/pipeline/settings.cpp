/* settings.cpp - validates settings, and converts choices to and from their names; see settings.h. */
#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/scene.h>
#include <tandem/settings.h>

#include "host/pipeline/batching/batcher.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/setting_rows.h"
#include "host/pipeline/solvers/solvers.h"
#include "host/pipeline/substep_choice.h"
#include "host/runtime/interface/module.h"
#include "shared/body_codes.h"

namespace tandem {
namespace {

constexpr float longest_step = 10.0f; /* s; a longer step is physically meaningless */
constexpr uint32_t most_passes = 1000;
constexpr uint32_t most_cells = 256;

constexpr BoundsRow bounds_rows[] = {{Bounds::affine, "affine"}, {Bounds::tight, "tight"}};

constexpr MidphaseRow midphase_rows[] = {{Midphase::walk, "walk"}, {Midphase::subtrees, "subtrees"}};

constexpr NarrowphaseRow narrowphase_rows[] = {{Narrowphase::sat, "sat", CONVEX_AXES},
                                               {Narrowphase::gjk_epa, "gjk-epa", CONVEX_EXPANSION},
                                               {Narrowphase::gjk_sampled, "gjk-sampled", CONVEX_SAMPLED},
                                               {Narrowphase::sat_split, "sat-split", CONVEX_AXES},
                                               {Narrowphase::cube_map, "cube-map", CONVEX_FIELDS}};

constexpr SupportRow support_rows[] = {{Support::brute_force, "brute-force", SUPPORT_BRUTE_FORCE},
                                       {Support::hill_climbing, "hill-climbing", SUPPORT_HILL_CLIMBING},
                                       {Support::cube_map, "cube-map", SUPPORT_CUBE_MAP}};

static_assert(are_in_order(bounds_rows) && are_in_order(midphase_rows) && are_in_order(narrowphase_rows) &&
              are_in_order(support_rows));

/* The name of each enum in messages, and its rows. */
template <class T> struct Setting;
template <> struct Setting<Solver> {
  static constexpr const char *what = "solver";
  static auto rows() { return solvers(); }
};
template <> struct Setting<Broadphase> {
  static constexpr const char *what = "broadphase";
  static auto rows() { return broadphase_rows(); }
};
template <> struct Setting<Bounds> {
  static constexpr const char *what = "bounds";
  static auto rows() { return std::span<const BoundsRow>(bounds_rows); }
};
template <> struct Setting<Midphase> {
  static constexpr const char *what = "midphase";
  static auto rows() { return std::span<const MidphaseRow>(midphase_rows); }
};
template <> struct Setting<Narrowphase> {
  static constexpr const char *what = "narrowphase";
  static auto rows() { return std::span<const NarrowphaseRow>(narrowphase_rows); }
};
template <> struct Setting<Support> {
  static constexpr const char *what = "support";
  static auto rows() { return std::span<const SupportRow>(support_rows); }
};
template <> struct Setting<Batching> {
  static constexpr const char *what = "batching";
  static auto rows() { return batchers(); }
};

template <class T> [[noreturn]] void refuse(const std::string &given)
{
  std::vector<const char *> accepted;
  for (const auto &row : Setting<T>::rows()) accepted.push_back(row.name);
  throw InputError(fmt::format("{} {} is unknown; use {}", Setting<T>::what, given, fmt::join(accepted, ", ")));
}

template <class T> void check_choice(T choice)
{
  if (static_cast<size_t>(choice) >= Setting<T>::rows().size())
    refuse<T>(fmt::format("number {}", static_cast<unsigned>(choice)));
}

void check_count(const char *what, uint32_t value)
{
  if (value < 1 || value > most_passes) throw InputError(fmt::format("{} {}: use 1 to {}", what, value, most_passes));
}

void check_number(const char *what, float value, const char *unit, bool zero_allowed)
{
  if (!std::isfinite(value) || value < 0 || (value == 0 && !zero_allowed))
    throw InputError(
        fmt::format("{} {} {}: use a finite number {} 0", what, value, unit, zero_allowed ? "of at least" : "above"));
}

void check_extensions(const std::vector<Extension> &extensions)
{
  for (size_t i = 0; i < extensions.size(); ++i) {
    if (!extensions[i].module) throw InputError(fmt::format("extension {}: it names no module", i));
    for (const auto &[point, launch] : extensions[i].launches)
      if (!launch || point > StepPoint::commit)
        throw InputError(fmt::format("extension {}: a launch of module '{}' has no function, or no point of the step",
                                     i, extensions[i].module->name()));
    for (size_t before = 0; before < i; ++before)
      if (extensions[before].module == extensions[i].module)
        throw InputError(fmt::format("extension {}: module '{}' is given twice; give all its launches in one", i,
                                     extensions[i].module->name()));
  }
}

} // namespace

template <Choice T> const char *name_of(T choice)
{
  check_choice(choice);
  return row_in(Setting<T>::rows(), choice).name;
}

template <Choice T> T parse_setting(const std::string &name)
{
  for (const auto &row : Setting<T>::rows())
    if (name == row.name) return row.choice;
  refuse<T>(fmt::format("'{}'", name));
}

template <Choice T> std::vector<T> choices()
{
  std::vector<T> all;
  for (const auto &row : Setting<T>::rows()) all.push_back(row.choice);
  if constexpr (std::is_same_v<T, Broadphase>) std::erase(all, Broadphase::automatic);
  return all;
}

template <Choice T> std::vector<std::string> choice_names()
{
  std::vector<std::string> names;
  for (const T choice : choices<T>()) names.emplace_back(name_of(choice));
  return names;
}

#define INSTANTIATE(T)                                             \
  template TANDEM_API const char *name_of<T>(T choice);            \
  template TANDEM_API T parse_setting<T>(const std::string &name); \
  template TANDEM_API std::vector<T> choices<T>();                 \
  template TANDEM_API std::vector<std::string> choice_names<T>();
INSTANTIATE(Solver)
INSTANTIATE(Broadphase)
INSTANTIATE(Bounds)
INSTANTIATE(Midphase)
INSTANTIATE(Narrowphase)
INSTANTIATE(Support)
INSTANTIATE(Batching)
#undef INSTANTIATE

uint32_t narrowphase_method(const Settings &settings)
{
  return row_in(Setting<Narrowphase>::rows(), settings.narrowphase).code |
         row_in(Setting<Support>::rows(), settings.support).code << 8;
}

HullMaps hull_maps(const Settings &settings)
{
  return {settings.support == Support::brute_force ? 0 : settings.support_cells,
          settings.narrowphase == Narrowphase::cube_map ? settings.support_cells : 0};
}

void validate(const Settings &settings)
{
  if (!std::isfinite(settings.step) || settings.step <= 0 || settings.step > longest_step)
    throw InputError(
        fmt::format("time step {} s: use a number of seconds above 0, at most {}", settings.step, longest_step));
  if (settings.substeps == automatic_substeps && settings.solver != Solver::soft_step)
    throw InputError(fmt::format("substeps auto with the solver {}: only soft-step chooses its substeps; use 1 to 1000",
                                 name_of(settings.solver)));
  if (settings.substeps != automatic_substeps) check_count("substeps", settings.substeps);
  check_count("iterations", settings.iterations);
  const uint32_t substeps = settings.substeps == automatic_substeps ? most_substeps(settings) : settings.substeps;
  const float parts = substeps;
  if (settings.step / parts < 1e-9f)
    throw InputError(
        fmt::format("time step {} s in {} substeps: a substep must be at least 1e-9 s", settings.step, substeps));
  check_choice(settings.solver);
  check_choice(settings.broadphase);
  check_choice(settings.bounds);
  check_choice(settings.midphase);
  check_choice(settings.narrowphase);
  check_choice(settings.support);
  if (settings.support_cells < 1 || settings.support_cells > most_cells)
    throw InputError(fmt::format("support cells {}: use 1 to {}", settings.support_cells, most_cells));
  if (settings.max_pairs < 1 || settings.max_pairs > most_pairs)
    throw InputError(fmt::format("at most {} pairs: use 1 to {}", settings.max_pairs, most_pairs));
  check_choice(settings.batching);
  check_extensions(settings.extensions);
  check_number("contact stiffness", settings.contact_hertz, "Hz", false);
  check_number("contact damping ratio", settings.contact_damping_ratio, "(no unit)", true);
  check_number("joint stiffness", settings.joint_hertz, "Hz", false);
  check_number("joint damping ratio", settings.joint_damping_ratio, "(no unit)", true);
  check_number("push speed", settings.push_speed, "m/s", true);
  check_number("slop", settings.slop, "m", true);
  check_number("slop share", settings.slop_share, "(no unit)", true);
  check_number("restitution speed", settings.restitution_speed, "m/s", true);
  check_number("sleep speed", settings.sleep_speed, "m/s", false);
  check_number("sleep time", settings.sleep_time, "s", false);
  check_number("hit speed", settings.hit_speed, "m/s", true);
}

} // namespace tandem
