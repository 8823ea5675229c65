/* contact_events.h - turns the lists that the events stage leaves on the device into the events of
 * World::contact_events and World::pair_events. */
#pragma once

#include <vector>

#include <tandem/world.h>

#include "host/runtime/memory.h"

namespace tandem {

/* The events of the last step. order: the scene's body at each index of the body buffers. */
std::vector<ContactEvent> download_events(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order);

std::vector<HitEvent> hits_among(const std::vector<ContactEvent> &events, float hit_speed);
std::vector<uint32_t> download_moved_bodies(Memory &memory, const std::vector<uint32_t> &order);
std::vector<PairEvent> download_pair_events(Memory &memory, const std::vector<uint32_t> &order);

} // namespace tandem
