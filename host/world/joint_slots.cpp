/* joint_slots.cpp - see joint_slots.h. */
#include "host/world/joint_slots.h"

#include <iterator>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/base/reserve_more.h"

namespace tandem {

uint32_t JointSlots::slot_of(const char *call, const JointId &id) const
{
  if (id.generation == 0 || id.index >= slots_.size())
    throw InputError(
        fmt::format("{}: there is no joint {} of generation {}; the world has had {} joints at the same time at most",
                    call, id.index, id.generation, slots_.size()));
  const Slot &slot = slots_[id.index];
  if (!slot.exists || slot.generation != id.generation)
    throw InputError(fmt::format("{}: joint {} of generation {} does not exist any more; it or a body of it was "
                                 "destroyed",
                                 call, id.index, id.generation));
  return id.index;
}

void JointSlots::prepare(size_t changes)
{
  reserve_more(slots_, changes);
  reserve_more(queue_, changes);
}

uint32_t JointSlots::take()
{
  const auto first = queue_.begin() + first_free_;
  if (first == queue_.end()) {
    slots_.emplace_back();
    return static_cast<uint32_t>(slots_.size() - 1);
  }
  const uint32_t slot = *first;
  if (2 * ++first_free_ >= std::ssize(queue_)) queue_.erase(queue_.begin(), first + 1), first_free_ = 0;
  slots_[slot].exists = true;
  return slot;
}

/* A slot whose generations are used up is not used again, so that no handle is ever valid twice. */
void JointSlots::free(uint32_t slot)
{
  slots_[slot].exists = false;
  if (slots_[slot].generation == UINT32_MAX) return;
  ++slots_[slot].generation;
  queue_.push_back(slot);
}

} // namespace tandem
