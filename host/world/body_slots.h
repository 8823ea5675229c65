/* body_slots.h - which bodies of a world exist, their generations, and the free slots.
 *
 *   slot           0        1        2        3          index of the body for users
 *   generation     1        1        3        2
 *                  exists   exists   free     exists     slot 2 had two bodies, both destroyed
 *
 * Free slots are used again in the order in which they became free, so that the same calls give the same slots. A slot
 * waits until a step has been made without its body: the contact cache then holds nothing of it, and the events of its
 * contacts have ended.
 */
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <tandem/bodies.h>

#include "host/scene/body_status.h"

namespace tandem {

/* The part of the body buffers in which a body lies; see Specialisation::order. */
enum class BodyRegion : uint8_t { half_spaces, large, small };

class BodySlots {
public:
  struct Slot {
    uint32_t generation = 1;
  };
  struct Free {
    uint32_t slot;
    uint64_t since; /* steps made when it became free */
  };
  using Queues = std::array<std::vector<Free>, 3>; /* by region */

  explicit BodySlots(uint32_t bodies) : slots_(bodies), status_(bodies, BodyStatus::present) {}
  /* As a snapshot holds them; the two lists have the same length. */
  BodySlots(std::vector<Slot> slots, std::vector<BodyStatus> status, Queues queues)
      : slots_(std::move(slots)), status_(std::move(status)), queues_(std::move(queues)),
        free_(static_cast<uint32_t>(std::count(status_.begin(), status_.end(), BodyStatus::free)))
  {}

  uint32_t count() const { return static_cast<uint32_t>(slots_.size()); }
  uint32_t existing() const { return count() - free_; }
  bool exists(uint32_t slot) const { return slot < count() && status_[slot] != BodyStatus::free; }
  BodyId id_of(uint32_t slot) const { return {slot, slots_[slot].generation}; }
  const std::vector<BodyStatus> &status() const { return status_; }
  const std::vector<Slot> &slots() const { return slots_; }
  const Queues &queues() const { return queues_; }

  /* Throws InputError that says what a stale or unknown handle is. */
  uint32_t slot_of(const char *call, const BodyId &id) const;

  /* The free slots of each region that may be used after so many steps, in the order of their use. */
  std::vector<uint32_t> usable(BodyRegion region, uint64_t steps, size_t most) const;
  /* Everything that may need memory for these changes; the changes themselves cannot fail. */
  void prepare_growth(size_t bodies);
  void prepare_freeing(BodyRegion region, size_t bodies);
  void use_again(BodyRegion region, size_t slots) noexcept; /* the first ones of `usable` */
  void append(size_t bodies) noexcept;
  void free(uint32_t slot, BodyRegion region, uint64_t steps) noexcept;
  void quarantine(uint32_t slot) { status_[slot] = BodyStatus::quarantined; }
  void release(uint32_t slot) { status_[slot] = BodyStatus::present; } /* a quarantine was undone */

private:
  std::vector<Slot> slots_;
  std::vector<BodyStatus> status_;
  Queues queues_;
  uint32_t free_ = 0;
};

} // namespace tandem
