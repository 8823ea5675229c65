/* built.cpp - finds the body that needs what is missing; see built.h. */
#include "host/scene/built.h"

#include <bit>

#include <fmt/format.h>

#include <tandem/error.h>
#include <tandem/settings.h>

#include "host/runtime/interface/built_features.h"
#include "host/runtime/interface/features.h"
#include "host/scene/specialise.h"

namespace tandem {
namespace {

bool needs(Features feature, const Scene &scene, const Settings &settings)
{
  return (features_of(scene, settings) & feature) != 0;
}

/* The first body with which, and those before it, the scene needs the feature: more never make it need less. */
size_t body_that_brings(Features feature, const Scene &scene, const Settings &settings)
{
  Scene part = scene;
  size_t too_few = 0, enough = scene.bodies.size();
  while (too_few + 1 < enough) {
    const size_t middle = (too_few + enough) / 2;
    part.bodies.assign(scene.bodies.begin(), scene.bodies.begin() + static_cast<ptrdiff_t>(middle));
    (needs(feature, part, settings) ? enough : too_few) = middle;
  }
  return enough - 1;
}

/* A batch needs its feature, a user may ask for one, and a world may have had bodies that it has no more. */
std::string who_needs(Features feature, const Scene &scene, const Settings &settings)
{
  Scene empty = scene;
  empty.bodies.clear();
  if (needs(feature, empty, settings)) return "the settings need";
  if (!needs(feature, scene, settings)) return "it needs";
  return fmt::format("body {} needs", body_that_brings(feature, scene, settings));
}

std::string option_with(Features missing)
{
  std::string option = built_option();
  for (int index = 0; index < FEATURE_COUNT; ++index)
    if (missing & feature_of_index(index)) option += fmt::format(";{}", feature_rows[index].name);
  return option;
}

} // namespace

void check_built(Features needed, const Scene &scene, const Settings &settings, const std::string &where)
{
  const Features missing = needed & ~built_features();
  if (missing == 0) return;
  const int first = std::countr_zero(missing);
  throw InputError(fmt::format("{}: {} {} ({}), which this library is built without; one that is configured with "
                               "-DTANDEM_FEATURES=\"{}\" has all that is needed",
                               where, who_needs(feature_of_index(first), scene, settings), feature_rows[first].name,
                               feature_rows[first].what, option_with(missing)));
}

} // namespace tandem
