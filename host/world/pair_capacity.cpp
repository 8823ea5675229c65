/* pair_capacity.cpp - how much room a world has for pairs, in which most of its bytes lie.
 *
 * A world begins with little. A step that finds more pairs than there is room for runs again with more (nothing is
 * lost), which takes a frame several times its usual time: a program that cannot afford this reserves room ahead. */
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/scene_counts.h"
#include "host/world/implementation.h"

namespace tandem {
namespace {

/* More pairs of fat boxes overlap than of bounds, yet hardly so many; memory is limited by the latter. */
constexpr uint32_t most_candidates_per_pair = 4;

constexpr uint32_t least_pairs = 1024, few_bodies = 16;

/* A world whose number of pairs hardly changes outgrows its first room once, and needs hardly more than it found then.
 * One that piles up outgrows its room again and again: a sixteenth more each time would run twice as many steps again
 * as an eighth does. */
constexpr uint64_t spare_share_at_first = 64, spare_share = 8;

uint64_t more_by_share(uint64_t needed, uint64_t share) { return needed + needed / share; }

} // namespace

/* A pair has a body that can be pushed, or a trigger. Two pairs of 16 bytes take as much as a body of 32, so rows of
 * pairs and of bodies fit into the memory of one another (shared_memory.h), unless many bodies cannot be pushed. */
uint32_t first_capacity(const Scene &scene, const Settings &settings)
{
  const auto pushed = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                    [](const Body &body) { return body.type == BodyType::dynamic; });
  const uint64_t counted = std::min<uint64_t>(scene.bodies.size(), static_cast<uint64_t>(pushed) + few_bodies);
  const uint64_t wanted = std::max<uint64_t>(2 * counted, least_pairs);
  return static_cast<uint32_t>(std::min<uint64_t>(wanted, settings.max_pairs));
}

uint64_t room_for(uint64_t needed) { return more_by_share(needed, spare_share); }

/* If candidates did not fit, the number of pairs among them is unknown. */
bool World::Implementation::candidates_overflow() const { return (plan.known[COUNT_STATUS] & STATUS_CANDIDATES) != 0; }

/* As far as the step tells. */
uint32_t World::Implementation::pairs_needed() const
{
  const uint32_t found = plan.known[COUNT_PAIRS_NEEDED];
  if (!candidates_overflow()) return found;
  return std::max(found, plan.known[COUNT_CANDIDATES_NEEDED] / most_candidates_per_pair);
}

/* A broadphase that keeps its list may need capacity for more changes than there are pairs; without its kept list it
 * does not. */
void World::Implementation::grow_pairs(bool &may_forget)
{
  const uint32_t needed = pairs_needed(), candidates = plan.known[COUNT_CANDIDATES_NEEDED];
  if (needed > settings.max_pairs && std::exchange(may_forget, false)) return forget_kept(memory);
  if (needed > settings.max_pairs)
    throw std::runtime_error(
        fmt::format("room for {}{} pairs is needed, and {} are the most (--max-pairs, Settings::max_pairs)",
                    needed == UINT32_MAX || candidates_overflow() ? "at least " : "", needed, settings.max_pairs));
  ++statistics.overflow;
  if (!first_outgrown) first_outgrown = statistics.steps;
  const uint64_t share = *first_outgrown == statistics.steps ? spare_share_at_first : spare_share;
  PairCapacity wanted = capacity();
  if (plan.known[COUNT_STATUS] & STATUS_PAIRS)
    wanted.pairs = static_cast<uint32_t>(std::min<uint64_t>(more_by_share(needed, share), settings.max_pairs));
  if (candidates_overflow())
    wanted.candidates = static_cast<uint32_t>(std::min<uint64_t>(more_by_share(candidates, share), UINT32_MAX));
  enlarge(wanted);
  guess_counts();
}

void World::Implementation::set_capacity(const PairCapacity &capacity)
{
  plan.capacity_pairs = capacity.pairs;
  plan.capacity_candidates = capacity.candidates;
}

/* Makes capacity for so many pairs, and for what the present plan launches; longer scans and sorts need other
 * kernels. */
void World::Implementation::enlarge(const PairCapacity &wanted)
{
  const PairCapacity before_it = capacity();
  StepBuffers::Needs before = buffers.needs();
  const auto give_up = [&] {
    set_capacity(before_it);
    buffers.give_back_needs(std::move(before));
  };
  try {
    set_capacity(wanted);
    record_kernels();
    place_again();
    forget_kept(memory);
    structure_state = 0; /* what queries traverse is laid out anew, too */
    buffers.make_ready(sizes());
    static_assert(CAPACITY_CANDIDATES == CAPACITY_PAIRS + 1);
    memory.upload(Buffer::counts, &wanted, sizeof wanted, CAPACITY_PAIRS * sizeof(uint32_t));
  } catch (const OutOfMemory &error) {
    give_up();
    throw OutOfMemory(
        fmt::format("room for {} pairs and {} colours is needed: {}", wanted.pairs, plan.colors, error.what()));
  } catch (...) {
    give_up();
    throw;
  }
}

void World::Implementation::reserve_pairs(uint32_t pairs)
{
  check_lost();
  if (pairs <= plan.capacity_pairs) return;
  if (pairs > settings.max_pairs)
    throw InputError(
        fmt::format("reserve_pairs: {} pairs; {} are the most (Settings::max_pairs)", pairs, settings.max_pairs));
  forget_contacts();
  enlarge({pairs, std::max(pairs, plan.capacity_candidates)});
}

/* States that were kept have their pairs, too. */
void World::Implementation::shrink_to_fit()
{
  check_lost();
  uint64_t pairs = std::max(cached_pairs, plan.known[COUNT_PAIRS]);
  for (const KeptState &state : ring.slots()) pairs = std::max<uint64_t>(pairs, state.pairs);
  const uint64_t candidates = plan.known[COUNT_CANDIDATES_NEEDED];
  const auto at_most = [](uint64_t wanted, uint32_t most) {
    return static_cast<uint32_t>(std::min<uint64_t>(wanted, most));
  };
  forget_contacts();
  const auto enough = [](uint64_t needed) { return more_by_share(needed, spare_share_at_first) + least_pairs; };
  enlarge({at_most(enough(pairs), plan.capacity_pairs), at_most(enough(candidates), plan.capacity_candidates)});
}

/* The lists of the last step lie in buffers that are laid out anew. This comes before, because a layout that fails half
 * way has lost some of them. */
void World::Implementation::forget_contacts()
{
  for (const uint32_t entry : {COUNT_PAIRS, COUNT_CONSTRAINTS, COUNT_EVENTS, COUNT_PAIR_EVENTS})
    set_count(memory, entry, 0);
}

void World::reserve_pairs(uint32_t pairs) { implementation_->reserve_pairs(pairs); }
void World::shrink_to_fit() { implementation_->shrink_to_fit(); }

} // namespace tandem
