/* shape_slots.cpp - see shape_slots.h. */
#include "host/world/shape_slots.h"

#include <algorithm>

#include <fmt/format.h>

#include <tandem/error.h>

namespace tandem {

const std::vector<ShapeId> &ShapeSlots::of(const BodyId &body, size_t shapes)
{
  std::vector<ShapeId> &handles = handles_[body.index];
  handles.reserve(shapes);
  while (handles.size() < shapes) handles.push_back(take(body));
  return handles;
}

/* The queue can always hold all slots, so that freeing one needs no memory. */
ShapeId ShapeSlots::take(const BodyId &body)
{
  queue_.reserve(slots_.size() + 1);
  if (queue_.empty()) {
    slots_.emplace_back();
    queue_.push_back(static_cast<uint32_t>(slots_.size() - 1));
  }
  const uint32_t slot = queue_.front();
  queue_.erase(queue_.begin());
  ++changes_;
  slots_[slot].exists = true;
  slots_[slot].body = body;
  return {slot, slots_[slot].generation};
}

void ShapeSlots::free(const ShapeId &id)
{
  Slot &slot = slots_[id.index];
  ++changes_;
  slot.exists = false;
  if (slot.generation == UINT32_MAX) return; /* so that no handle is ever valid twice */
  ++slot.generation;
  queue_.push_back(id.index);
}

ShapeSlots::Place ShapeSlots::place_of(const char *call, const ShapeId &id) const
{
  if (id.generation == 0 || id.index >= slots_.size())
    throw InputError(fmt::format("{}: there is no shape {} of generation {}", call, id.index, id.generation));
  const Slot &slot = slots_[id.index];
  if (!slot.exists || slot.generation != id.generation)
    throw InputError(fmt::format("{}: shape {} of generation {} does not exist any more; it or its body was removed",
                                 call, id.index, id.generation));
  const std::vector<ShapeId> &handles = handles_.at(slot.body.index);
  const auto child = std::find(handles.begin(), handles.end(), id) - handles.begin();
  return {slot.body, static_cast<uint32_t>(child)};
}

void ShapeSlots::remove(const ShapeId &id)
{
  std::vector<ShapeId> &handles = handles_.at(slots_[id.index].body.index);
  handles.erase(std::find(handles.begin(), handles.end(), id));
  free(id);
}

void ShapeSlots::forget(uint32_t body)
{
  const auto handles = handles_.find(body);
  if (handles == handles_.end()) return;
  for (const ShapeId &id : handles->second) free(id);
  handles_.erase(handles);
}

} // namespace tandem
