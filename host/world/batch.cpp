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
  if (!scene.joints.empty()) {
    recorder.note(Kernel::reset_joints);
    recorder.note(Kernel::scatter_reals); /* of controls */
  }
  if (!scene.couplings.empty()) recorder.note(Kernel::reset_couplings);
  if (settings.events) recorder.note(Kernel::reset_touching);
  if (plan.forces || (features_run() & FEATURE_TREE_JOINT_FORCES) != 0) recorder.note(Kernel::reset_forces);
}

/* A world alone quarantines its first body that is not finite, by stage and then by index, and runs its step again. In
 * a batch all worlds do so in one repetition. */
void World::Implementation::quarantine_in_worlds(uint32_t status)
{
  const uint32_t all = bodies(), of_world = bodies_of_world();
  launcher.launch({Kernel::find_failed_bodies, {}, {}, COUNT_ZERO, COUNT_BODIES, all});
  const auto failed = memory.read<uint32_t>(Buffer::body_failed, all);
  std::vector<uint32_t> taken(all / of_world);
  for (const auto &[index, record] : taken_out) ++taken[index / of_world];
  const bool takes_all =
      std::any_of(taken.begin(), taken.end(), [](uint32_t count) { return count >= taken_one_by_one; });
  const std::vector<uint32_t> not_finite = takes_all ? bodies_not_finite(memory, all) : std::vector<uint32_t>{};
  for (uint32_t first = 0; first < all; first += of_world) {
    const auto worst =
        quarantine_worst(std::span(failed).subspan(first, of_world), first, (status & lacks_contacts) != 0);
    if (worst && taken[first / of_world] >= taken_one_by_one) quarantine_others(*worst, first, not_finite);
  }
  forget_kept(memory);
}

/* failed: 1 + the stage, by body of the world, or 0. */
std::optional<World::Implementation::FailedBody>
World::Implementation::quarantine_worst(std::span<const uint32_t> failed, uint32_t first, bool lacks_contacts)
{
  const auto before = [](uint32_t one, uint32_t other) { return one - 1 < other - 1; }; /* 0 is after all stages */
  const auto worst = std::min_element(failed.begin(), failed.end(), before);
  if (*worst == 0 || (lacks_contacts && *worst - 1 > NONFINITE_AT_START)) return std::nullopt;
  const FailedBody found{first + static_cast<uint32_t>(worst - failed.begin()), *worst - 1};
  quarantine(found.body, found.stage);
  return found;
}

/* So many bodies of the world were taken one by one that the rest of them is taken at once. not_finite: ascending. */
void World::Implementation::quarantine_others(const FailedBody &worst, uint32_t first,
                                              std::span<const uint32_t> not_finite)
{
  const auto begin = std::lower_bound(not_finite.begin(), not_finite.end(), first),
             end = std::lower_bound(begin, not_finite.end(), first + bodies_of_world());
  for (const uint32_t body : std::span(begin, end))
    if (body != worst.body) quarantine(body, worst.stage);
}

} // namespace tandem
