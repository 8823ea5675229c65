/* shape_slots.h - handles of the shapes of bodies.
 *
 * A body's shapes are the children of its compound, in their order, or the one shape that it has. Handles are made for
 * a body when a program first asks for them, so a world without such calls keeps none:
 *
 *   body 7 of generation 2:  ShapeId {4, 1}  ShapeId {0, 3}      children 0 and 1 of its compound
 *
 * Free slots are used again in the order in which they became free.
 */
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <tandem/bodies.h>

namespace tandem {

class ShapeSlots {
public:
  struct Place {
    BodyId body;
    uint32_t child;
  };

  struct Slot {
    uint32_t generation = 1;
    bool exists = false;
    BodyId body;
  };
  using Handles = std::map<uint32_t, std::vector<ShapeId>>; /* by the slot of the body */

  ShapeSlots() = default;
  ShapeSlots(std::vector<Slot> slots, std::vector<uint32_t> queue, Handles handles)
      : slots_(std::move(slots)), queue_(std::move(queue)), handles_(std::move(handles))
  {}
  const std::vector<Slot> &slots() const { return slots_; }
  const std::vector<uint32_t> &queue() const { return queue_; }
  const Handles &handles() const { return handles_; }
  /* Handles made and freed so far. Of two copies of one that went different ways, equal numbers say nothing. */
  uint64_t changes() const { return changes_; }

  /* The handles of a body with so many shapes; makes those that it lacks, at the end. */
  const std::vector<ShapeId> &of(const BodyId &body, size_t shapes);
  /* Throws InputError that says what a stale or unknown handle is. */
  Place place_of(const char *call, const ShapeId &id) const;
  void remove(const ShapeId &id); /* the later shapes of the body move up */
  void forget(uint32_t body);     /* all handles of a body that is destroyed, by its slot */

private:
  ShapeId take(const BodyId &body);
  void free(const ShapeId &id);

  std::vector<Slot> slots_;
  std::vector<uint32_t> queue_; /* free slots */
  Handles handles_;
  uint64_t changes_ = 0;
};

} // namespace tandem
