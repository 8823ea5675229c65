/* substep_choice.cpp - more substeps at once, fewer after a while; see substep_choice.h. */
#include "host/pipeline/substep_choice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <tandem/round_to_float.h>

#include "host/base/hash.h"

namespace tandem {
namespace {

constexpr uint32_t every_rate = 0xffffffffu;

/* The share of the substep rate that the stiffest contacts have, in hertz. */
constexpr double stiffest_share = 0.2;

/* Contacts asked for that are stiffer than the default get as many as they need: up to the highest power of two that a
 * world may take. */
constexpr uint32_t most_of_stiffness = 512;

/* Who asks for softer contacts than the default gets them, whatever stands on them. */
bool may_stiffen(const Settings &settings) { return settings.contact_hertz >= Settings{}.contact_hertz; }

/* Hz: of the stiffest contacts. */
double stiffest_with(const Settings &settings, uint32_t substeps)
{
  return stiffest_share * substeps / double{settings.step};
}

float contact_hertz_with(const Settings &settings, uint32_t substeps)
{
  if (substeps <= fewest_automatic_substeps || !may_stiffen(settings)) return settings.contact_hertz;
  return std::max(settings.contact_hertz, round_to_float(stiffest_with(settings, substeps)));
}

/* Joints are as stiff as a quarter of the substep rate, which is what joints/load_rate.h reckons with. */
float joint_hertz_with(const Settings &settings, uint32_t substeps)
{
  if (substeps <= fewest_automatic_substeps || settings.joint_hertz < Settings{}.joint_hertz)
    return settings.joint_hertz;
  return std::max(settings.joint_hertz, round_to_float(0.25 * substeps / double{settings.step}));
}

/* A soft contact of these substeps: its frequency, 1/s, and the angle that it passes in a substep. */
struct Spring {
  double omega, angle;
};

Spring spring_with(const Settings &settings, uint32_t substeps)
{
  const double hertz = std::min<double>(contact_hertz_with(settings, substeps), stiffest_with(settings, substeps));
  const double omega = 2 * M_PI * hertz;
  return {omega, omega * double{settings.step} / substeps};
}

/* Stiffer contacts part bodies no faster, because parting gives a crowd energy with the square of its speed. Contacts
 * of the damping ratio z part at w / (2 z + h w), and carry the same with any. */
float contact_damping_with(const Settings &settings, uint32_t substeps)
{
  const double ratio = settings.contact_damping_ratio;
  if (substeps <= fewest_automatic_substeps || !may_stiffen(settings)) return settings.contact_damping_ratio;
  const Spring soft = spring_with(settings, fewest_automatic_substeps), stiff = spring_with(settings, substeps);
  const double time = (2 * ratio + soft.angle) / soft.omega;
  return round_to_float(std::max(ratio, (time * stiff.omega - stiff.angle) / 2));
}

/* Contacts softer than substeps allow, as four of them have in steps shorter than 1/75 s, bear what fewer would. The
 * bits of floats that are not negative are in the order of the floats. */
uint32_t highest_load_rate_of(const Settings &settings, uint32_t substeps)
{
  if (substeps >= most_substeps(settings)) return every_rate;
  double rate = substeps / double{settings.step};
  if (may_stiffen(settings)) rate = std::min(rate, contact_hertz_with(settings, substeps) / stiffest_share);
  return std::bit_cast<uint32_t>(round_to_float(rate * rate));
}

bool is_a_second(uint32_t steps, const Settings &settings)
{
  const float of_float = steps;
  return of_float * settings.step >= 1;
}

uint32_t steps_of_a_second(const Settings &settings)
{
  uint32_t steps = static_cast<uint32_t>(std::clamp(1 / double{settings.step}, 1.0, 1e8));
  while (!is_a_second(steps, settings)) ++steps;
  return steps;
}

} // namespace

uint32_t fewest_substeps(const Settings &settings)
{
  uint32_t fewest = fewest_automatic_substeps;
  if (settings.contact_hertz <= Settings{}.contact_hertz) return fewest;
  while (fewest < most_of_stiffness && stiffest_with(settings, fewest) < settings.contact_hertz) fewest *= 2;
  return fewest;
}

uint32_t most_substeps(const Settings &settings)
{
  return std::max(most_automatic_substeps, fewest_substeps(settings));
}

SubstepChoice first_choice(const Settings &settings)
{
  SubstepChoice choice;
  choice.automatic = settings.substeps == automatic_substeps;
  choice.now = choice.of_cache = choice.automatic ? fewest_substeps(settings) : settings.substeps;
  return choice;
}

uint32_t highest_load_rate(const SubstepChoice &choice, const Settings &settings)
{
  return choice.automatic ? highest_load_rate_of(settings, choice.now) : every_rate;
}

void raise_substeps(SubstepChoice &choice, uint32_t load_rate, const Settings &settings)
{
  if (load_rate <= highest_load_rate_of(settings, choice.now)) return;
  while (load_rate > highest_load_rate_of(settings, choice.now)) choice.now *= 2;
  choice.calm_steps = 0;
}

void note_start(SubstepChoice &choice, uint32_t braced_layers)
{
  if (choice.automatic && choice.starts) choice.layers_at_start = braced_layers;
}

void settle_substeps(SubstepChoice &choice, uint32_t load_rate, const Settings &settings)
{
  if (!choice.automatic) return;
  choice.starts = false;
  choice.of_cache = choice.now;
  const uint32_t half = choice.now / 2;
  const bool is_calm = half >= fewest_substeps(settings) && load_rate <= highest_load_rate_of(settings, half);
  choice.calm_steps = is_calm ? choice.calm_steps + 1 : 0;
  if (!is_a_second(choice.calm_steps, settings)) return;
  choice.now = half;
  choice.calm_steps = 0;
}

uint64_t hash_choice(const SubstepChoice &choice, uint64_t seed)
{
  const auto &[automatic, starts, now, of_cache, calm_steps, layers_at_start] = choice;
  if (!automatic) return seed;
  const std::array<uint32_t, 5> words{starts, now, of_cache, calm_steps, layers_at_start};
  return hash_bytes(words.data(), sizeof words, seed);
}

SubstepChoice choice_of_few(const SubstepChoice &choice, const Settings &settings)
{
  SubstepChoice few = choice;
  few.now = fewest_substeps(settings);
  return few;
}

uint32_t steps_of_wish(const SubstepChoice &choice, const Settings &settings)
{
  uint32_t seconds = 0;
  for (uint32_t substeps = choice.now; substeps > fewest_substeps(settings); substeps /= 2) ++seconds;
  return seconds * steps_of_a_second(settings);
}

Settings with_substeps(const Settings &settings, const SubstepChoice &choice)
{
  Settings chosen = settings;
  chosen.substeps = choice.now;
  if (!choice.automatic) return chosen;
  chosen.contact_hertz = contact_hertz_with(settings, choice.now);
  chosen.contact_damping_ratio = contact_damping_with(settings, choice.now);
  chosen.joint_hertz = joint_hertz_with(settings, choice.now);
  return chosen;
}

} // namespace tandem
