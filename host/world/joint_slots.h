/* joint_slots.h - which joints of a world exist, their generations, and the free places among Scene::joints, which are
 * used again in the order in which they became free. */
#pragma once

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
  const std::vector<uint32_t> &queue() const { return queue_; } /* free slots */

  bool exists(uint32_t slot) const { return slot < slots_.size() && slots_[slot].exists; }
  JointId id_of(uint32_t slot) const { return {slot, slots_[slot].generation}; }
  /* Throws InputError that says what a stale or unknown handle is. */
  uint32_t slot_of(const char *call, const JointId &id) const;
  uint32_t take(); /* a free slot, or a new one at the end */
  void free(uint32_t slot);

private:
  std::vector<Slot> slots_;
  std::vector<uint32_t> queue_;
};

} // namespace tandem
