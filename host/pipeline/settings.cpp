/* settings.cpp - which settings and placements make sense; see settings.h. */
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tandem/scene.h>
#include <tandem/settings.h>

#include "host/pipeline/batching/batcher.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/runtime/backend_list.h"
#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/interface/module.h"
#include "shared/body_codes.h"

namespace tandem {
namespace {

constexpr float longest_step = 10.0f; /* s; nothing physical is left of a longer one */
constexpr uint32_t most_passes = 1000;
constexpr uint32_t most_cells = 256;

void check_name(const char *what, const std::string &name, const std::vector<std::string> &accepted)
{
  if (std::find(accepted.begin(), accepted.end(), name) == accepted.end())
    throw InputError(fmt::format("{} '{}' is unknown; use {}", what, name, fmt::join(accepted, ", ")));
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
    for (size_t before = 0; before < i; ++before)
      if (extensions[before].module == extensions[i].module)
        throw InputError(fmt::format("extension {}: module '{}' is given twice; give all its launches in one", i,
                                     extensions[i].module->name()));
  }
}

bool names_stage_or_kernel(const std::string &name)
{
  for (size_t s = 0; s < all_stages(); ++s)
    if (name == name_of(static_cast<Stage>(s))) return true;
  for (size_t k = 0; k < all_kernels(); ++k)
    if (name == row_of(kernel_at(k)).name) return true;
  return false;
}

std::string stage_list()
{
  std::string list;
  for (size_t s = 0; s < all_stages(); ++s) list += fmt::format("{}{}", s ? ", " : "", name_of(static_cast<Stage>(s)));
  return list;
}

} // namespace

std::vector<std::string> bounds_names() { return {"affine", "tight"}; }
std::vector<std::string> midphase_names() { return {"walk", "subtrees"}; }
std::vector<std::string> narrowphase_names() { return {"sat", "gjk-epa", "gjk-sampled", "sat-split", "cube-map"}; }
/* In the order of SUPPORT_ in shared/narrowphase/hull_support.h. */
std::vector<std::string> support_names() { return {"brute-force", "hill-climbing", "cube-map"}; }

uint32_t narrowphase_method(const Settings &settings)
{
  static const std::map<std::string, uint32_t> methods{{"sat", CONVEX_AXES},
                                                       {"gjk-epa", CONVEX_EXPANSION},
                                                       {"gjk-sampled", CONVEX_SAMPLED},
                                                       {"sat-split", CONVEX_AXES},
                                                       {"cube-map", CONVEX_FIELDS}};
  const std::vector<std::string> names = support_names();
  return methods.at(settings.narrowphase) |
         static_cast<uint32_t>(std::find(names.begin(), names.end(), settings.support) - names.begin()) << 8;
}
uint32_t cube_map_cells(const Settings &settings)
{
  return settings.support == "brute-force" && settings.narrowphase != "cube-map" ? 0 : settings.support_cells;
}

std::vector<std::string> broadphase_names()
{
  std::vector<std::string> names;
  for (const Broadphase &broadphase : broadphases()) names.emplace_back(broadphase.name);
  return names;
}

std::vector<std::string> batching_names()
{
  std::vector<std::string> names;
  for (const Batcher &batcher : batchers()) names.emplace_back(batcher.name);
  return names;
}

void validate(const Settings &settings)
{
  if (!std::isfinite(settings.step) || settings.step <= 0 || settings.step > longest_step)
    throw InputError(
        fmt::format("time step {} s: use a number of seconds above 0, at most {}", settings.step, longest_step));
  check_count("substeps", settings.substeps);
  check_count("iterations", settings.iterations);
  const float substeps = settings.substeps;
  if (settings.step / substeps < 1e-9f)
    throw InputError(fmt::format("time step {} s in {} substeps: a substep must be at least 1e-9 s", settings.step,
                                 settings.substeps));
  check_name("solver", settings.solver, solver_names());
  std::vector<std::string> broadphases = broadphase_names();
  broadphases.emplace_back("auto");
  check_name("broadphase", settings.broadphase, broadphases);
  check_name("bounds", settings.bounds, bounds_names());
  check_name("midphase", settings.midphase, midphase_names());
  check_name("narrowphase", settings.narrowphase, narrowphase_names());
  check_name("support", settings.support, support_names());
  if (settings.support_cells < 1 || settings.support_cells > most_cells)
    throw InputError(fmt::format("support cells {}: use 1 to {}", settings.support_cells, most_cells));
  if (settings.max_pairs < 1 || settings.max_pairs > most_pairs)
    throw InputError(fmt::format("at most {} pairs: use 1 to {}", settings.max_pairs, most_pairs));
  check_name("batching", settings.batching, batching_names());
  check_extensions(settings.extensions);
  check_number("contact stiffness", settings.contact_hertz, "Hz", false);
  check_number("contact damping ratio", settings.contact_damping_ratio, "(no unit)", true);
  check_number("push speed", settings.push_speed, "m/s", true);
  check_number("slop", settings.slop, "m", true);
  check_number("slop share", settings.slop_share, "(no unit)", true);
  check_number("restitution speed", settings.restitution_speed, "m/s", true);
}

std::vector<std::pair<std::string, std::string>> parse_placement(const std::string &text)
{
  std::vector<std::pair<std::string, std::string>> exceptions;
  for (const std::string &part : split_backends(text)) {
    const size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == part.size())
      throw InputError(fmt::format("placement '{}' is not STAGE=BACKEND", part));
    const std::string place = part.substr(0, equals);
    if (!names_stage_or_kernel(place))
      throw InputError(
          fmt::format("placement '{}': no stage or kernel '{}'; the stages are {}", part, place, stage_list()));
    if (std::any_of(exceptions.begin(), exceptions.end(), [&](const auto &given) { return given.first == place; }))
      throw InputError(fmt::format("placement '{}': {} is given twice", text, place));
    exceptions.emplace_back(place, part.substr(equals + 1));
  }
  return exceptions;
}

} // namespace tandem
