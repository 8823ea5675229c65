/* substep_choice.cpp - more substeps at once, fewer after a while; see substep_choice.h. */
#include "host/pipeline/substep_choice.h"

#include <algorithm>
#include <bit>

#include <tandem/round_to_float.h>

namespace tandem {
namespace {

constexpr uint32_t every_rate = 0xffffffffu;

/* The bits of floats that are not negative are in the order of the floats. */
uint32_t highest_load_rate_of(uint32_t substeps, float step)
{
  if (substeps >= most_automatic_substeps) return every_rate;
  const float rate = static_cast<float>(substeps) / step;
  return std::bit_cast<uint32_t>(rate * rate);
}

} // namespace

SubstepChoice first_choice(const Settings &settings)
{
  SubstepChoice choice;
  choice.automatic = settings.substeps == automatic_substeps;
  choice.now = choice.of_cache = choice.automatic ? fewest_automatic_substeps : settings.substeps;
  return choice;
}

uint32_t highest_load_rate(const SubstepChoice &choice, float step)
{
  return choice.automatic ? highest_load_rate_of(choice.now, step) : every_rate;
}

void raise_substeps(SubstepChoice &choice, uint32_t load_rate, float step)
{
  while (load_rate > highest_load_rate_of(choice.now, step)) choice.now *= 2;
  choice.calm_steps = 0;
}

void settle_substeps(SubstepChoice &choice, uint32_t load_rate, float step)
{
  if (!choice.automatic) return;
  choice.starts = false;
  choice.of_cache = choice.now;
  const uint32_t half = choice.now / 2;
  const bool is_calm = half >= fewest_automatic_substeps && load_rate <= highest_load_rate_of(half, step);
  choice.calm_steps = is_calm ? choice.calm_steps + 1 : 0;
  if (static_cast<float>(choice.calm_steps) * step < 1) return;
  choice.now = half;
  choice.calm_steps = 0;
}

/* Who asks for softer contacts than the default gets them, whatever stands on them. */
Settings with_substeps(const Settings &settings, const SubstepChoice &choice)
{
  Settings chosen = settings;
  chosen.substeps = choice.now;
  const bool stiffens =
      choice.automatic && choice.now > fewest_automatic_substeps && settings.contact_hertz >= Settings{}.contact_hertz;
  const double stiffest = 0.2 * choice.now / double{settings.step};
  if (stiffens) chosen.contact_hertz = std::max(settings.contact_hertz, round_to_float(stiffest));
  return chosen;
}

} // namespace tandem
