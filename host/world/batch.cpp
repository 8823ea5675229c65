/* batch.cpp - what a batch of many worlds does otherwise than a world alone: it needs kernels for resets, and each of
 * its worlds quarantines bodies by itself. */
#include <algorithm>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/world/implementation.h"
#include "host/world/quarantine_limits.h"

namespace tandem {

void World::Implementation::note_batch(Recorder &recorder) const
{
  recorder.note(Kernel::find_failed_bodies);
  recorder.note(Kernel::reset_worlds);
  if (settings.events) recorder.note(Kernel::reset_touching);
  if (plan.forces) recorder.note(Kernel::reset_forces);
}

/* A world alone quarantines its first body that is not finite, by stage and then by index, and runs its step again. In
 * a batch all worlds do so in one repetition. */
void World::Implementation::quarantine_in_worlds(uint32_t status)
{
  const uint32_t all = bodies(), of_world = bodies_of_world();
  launcher.launch({Kernel::find_failed_bodies, {}, {}, COUNT_ZERO, COUNT_BODIES, all});
  const auto failed = memory.read<uint32_t>(Buffer::body_failed, all);
  for (uint32_t first = 0; first < all; first += of_world)
    quarantine_of_world(std::span(failed).subspan(first, of_world), first, (status & lacks_contacts) != 0);
  forget_kept(memory);
}

/* failed: 1 + the stage, by body of the world, or 0. */
void World::Implementation::quarantine_of_world(std::span<const uint32_t> failed, uint32_t first, bool lacks_contacts)
{
  const auto before = [](uint32_t one, uint32_t other) { return one - 1 < other - 1; }; /* 0 is after all stages */
  const auto worst = std::min_element(failed.begin(), failed.end(), before);
  if (*worst == 0 || (lacks_contacts && *worst - 1 > NONFINITE_AT_START)) return;
  const auto place = [&](auto at) { return first + static_cast<uint32_t>(at - failed.begin()); };
  quarantine(place(worst), *worst - 1);
  const auto is_here = [&](const auto &taken) { return taken.first >= first && taken.first - first < failed.size(); };
  if (std::count_if(taken_out.begin(), taken_out.end(), is_here) <= std::ptrdiff_t{taken_one_by_one}) return;
  for (const uint32_t body : bodies_not_finite(memory, bodies()))
    if (body >= first && body - first < failed.size() && body != place(worst)) quarantine(body, *worst - 1);
}

} // namespace tandem
