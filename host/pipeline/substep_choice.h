/* substep_choice.h - the substeps of a world that chooses them itself: Settings::substeps is automatic_substeps.
 *
 * A step that finds it needs more is run again with them; they become fewer, by halves, once a second of steps needed
 * no more than half. Device counts alone decide, so all backends choose alike; and the choice is part of a world's
 * state, since snapshots and states that are gone back to must go on with it. */
#pragma once

#include <cstdint>

#include <tandem/settings.h>

namespace tandem {

constexpr uint32_t fewest_automatic_substeps = 4, most_automatic_substeps = 64;

/* Of cached_wish, as of all that a step hands to the next. */
constexpr uint32_t sides_of_wishes = 2;

struct SubstepChoice {
  bool automatic = false;
  bool starts = true;           /* no step has been done, so nothing is known of what stands on what */
  uint32_t now = 0;             /* substeps of the next step */
  uint32_t of_cache = 0;        /* of the step that left the impulses in the cache */
  uint32_t calm_steps = 0;      /* that needed no more than half of them */
  uint32_t layers_at_start = 0; /* COUNT_BRACED_LAYERS of the first step */
};

/* More than 4 and 64 if contacts are asked for that are stiffer than these allow. */
uint32_t fewest_substeps(const Settings &settings);
uint32_t most_substeps(const Settings &settings);

SubstepChoice first_choice(const Settings &settings);

/* COUNT_LOAD_RATE up to which these substeps suffice. */
uint32_t highest_load_rate(const SubstepChoice &choice, const Settings &settings);

/* After an attempt that needed more: so many that COUNT_LOAD_RATE is not above highest_load_rate, or the most. An
 * attempt that had enough changes nothing, because how often a step is run again depends on what the host guessed. */
void raise_substeps(SubstepChoice &choice, uint32_t load_rate, const Settings &settings);

/* After the first step. */
void note_start(SubstepChoice &choice, uint32_t braced_layers);

/* After a step that is done. */
void settle_substeps(SubstepChoice &choice, uint32_t load_rate, const Settings &settings);

/* Of all that decides the substeps of steps to come; the seed itself for a world that is told its number. */
uint64_t hash_choice(const SubstepChoice &choice, uint64_t seed);

/* The same world, as far as it takes the fewest. */
SubstepChoice choice_of_few(const SubstepChoice &choice, const Settings &settings);

/* For so many steps a body that wished for many takes them: until the world would be back at the fewest. */
uint32_t steps_of_wish(const SubstepChoice &choice, const Settings &settings);

/* The settings with these substeps, and with contacts as stiff as they allow if they are more than four. */
Settings with_substeps(const Settings &settings, const SubstepChoice &choice);

} // namespace tandem
