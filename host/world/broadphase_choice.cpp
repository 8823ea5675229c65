/* broadphase_choice.cpp - `auto`: a world chooses its broadphase when it is made, and again where so many bodies have
 * come, gone, woken or fallen asleep that another one suits, or where most begin or cease to move.
 *
 * All broadphases give the same list of pairs, so a change shows in no bit. What they keep from step to step is dropped
 * with a change, and the buffers that the new one does not need are released.
 */
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/broadphases/choice.h"
#include "host/world/implementation.h"

namespace tandem {

/* before: what ran so far, if anything did. */
void World::Implementation::choose_broadphase_after(std::optional<Broadphase> before)
{
  if (!chooses) return;
  std::string backend = broadphase_backend(backends.wanted());
  BroadphaseChoice choice = choose_broadphase(scene, special.awake, backend, {before, trees_trial.pauses()});
  take_broadphase(choice.broadphase);
  broadphase_why = std::move(choice.why);
  chosen_for = std::move(backend);
  chosen_moving = trees_trial.pauses();
}

void World::Implementation::take_broadphase(Broadphase broadphase)
{
  settings.broadphase = settings_in_use.broadphase = broadphase;
}

bool World::Implementation::is_still_right() const
{
  return !chooses || (chosen_for == broadphase_backend(backends.wanted()) && chosen_moving == trees_trial.pauses() &&
                      tandem::is_still_right(settings.broadphase, special.awake, chosen_for));
}

/* Comes before launches, because it forgets the counts. If it throws, all is as before. */
void World::Implementation::choose_again()
{
  StepBuffers::Needs needs_before = buffers.needs();
  const Broadphase before = settings.broadphase;
  const bool moving_before = chosen_moving;
  std::string for_before = chosen_for, why_before = broadphase_why;
  try {
    choose_broadphase_after(before);
    if (settings.broadphase == before) return;
    record_kernels();
    place_again();
    forget_kept(memory);
    buffers.make_ready(sizes());
  } catch (...) {
    take_broadphase(before);
    chosen_moving = moving_before;
    chosen_for = std::move(for_before);
    broadphase_why = std::move(why_before);
    buffers.give_back_needs(std::move(needs_before));
    throw;
  }
  structure_state = 0; /* that of queries may be of another kind now */
  guess_counts();
}

uint32_t World::Implementation::query_structure() const
{
  if (!chooses) return row_of(settings.broadphase).queries;
  return query_structure_for(settings.broadphase, bodies(), broadphase_backend(backends.wanted()));
}

} // namespace tandem
