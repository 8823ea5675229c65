/* body_slots.cpp - see body_slots.h. */
#include "host/world/body_slots.h"

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/base/reserve_more.h"

namespace tandem {
namespace {

constexpr uint32_t last_generation = UINT32_MAX;

} // namespace

uint32_t BodySlots::slot_of(const char *call, const BodyId &id) const
{
  if (id.generation == 0 || id.index >= count())
    throw InputError(
        fmt::format("{}: there is no body {} of generation {}; the world has had {} bodies at the same time at most",
                    call, id.index, id.generation, count()));
  if (slots_[id.index].generation != id.generation || !exists(id.index))
    throw InputError(fmt::format(
        "{}: body {} of generation {} does not exist any more; {}", call, id.index, id.generation,
        exists(id.index) ? fmt::format("its index now belongs to generation {}", slots_[id.index].generation)
                         : "it was destroyed"));
  return id.index;
}

std::vector<uint32_t> BodySlots::usable(BodyRegion region, uint64_t steps, size_t most) const
{
  std::vector<uint32_t> slots;
  for (const Free &candidate : queues_[static_cast<size_t>(region)]) {
    if (slots.size() == most || candidate.since >= steps) break;
    slots.push_back(candidate.slot);
  }
  return slots;
}

void BodySlots::prepare_growth(size_t bodies)
{
  reserve_more(slots_, bodies);
  reserve_more(status_, bodies);
}

void BodySlots::prepare_freeing(BodyRegion region, size_t bodies)
{
  reserve_more(queues_[static_cast<size_t>(region)], bodies);
}

void BodySlots::use_again(BodyRegion region, size_t slots) noexcept
{
  std::vector<Free> &queue = queues_[static_cast<size_t>(region)];
  for (size_t k = 0; k < slots; ++k) status_[queue[k].slot] = BodyStatus::present;
  queue.erase(queue.begin(), queue.begin() + static_cast<ptrdiff_t>(slots));
  free_ -= static_cast<uint32_t>(slots);
}

void BodySlots::append(size_t bodies) noexcept
{
  slots_.resize(slots_.size() + bodies);
  status_.resize(status_.size() + bodies, BodyStatus::present);
}

/* A slot whose generations are used up is not used again, so that no handle is ever valid twice. */
void BodySlots::free(uint32_t slot, BodyRegion region, uint64_t steps) noexcept
{
  status_[slot] = BodyStatus::free;
  ++free_;
  if (slots_[slot].generation == last_generation) return;
  ++slots_[slot].generation;
  queues_[static_cast<size_t>(region)].push_back({slot, steps});
}

} // namespace tandem
