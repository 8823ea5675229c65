/* joint_slots.h - which joints of a world exist, their generations, and the free places among Scene::joints, which are
 * used again in the order in which they became free. */
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <tandem/joints.h>

namespace tandem {

class JointSlots {
public:
  struct Slot {
    uint32_t generation = 1;
    bool exists = true;
  };

  explicit JointSlots(size_t joints) : slots_(joints) {}
  JointSlots(std::vector<Slot> slots, std::vector<uint32_t> queue) : slots_(std::move(slots)), queue_(std::move(queue))
  {}
  const std::vector<Slot> &slots() const { return slots_; }
  std::vector<uint32_t> queue() const { return {queue_.begin() + first_free_, queue_.end()}; } /* free slots */

  bool exists(uint32_t slot) const { return slot < slots_.size() && slots_[slot].exists; }
  JointId id_of(uint32_t slot) const { return {slot, slots_[slot].generation}; }
  /* Throws InputError that says what a stale or unknown handle is. */
  uint32_t slot_of(const char *call, const JointId &id) const;
  void prepare(size_t changes); /* so that so many of the next two cannot fail */
  uint32_t take();              /* a free slot, or a new one at the end */
  void free(uint32_t slot);

private:
  std::vector<Slot> slots_;
  std::vector<uint32_t> queue_; /* those taken stay until they are the half of it */
  ptrdiff_t first_free_ = 0;    /* in the queue */
};

} // namespace tandem
