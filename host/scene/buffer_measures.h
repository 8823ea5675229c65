/* buffer_measures.h - the figures of a step and the hash of a state, which the host computes from the buffers. */
#pragma once

#include <vector>

#include <tandem/world.h>

#include "host/runtime/memory.h"

namespace tandem {

/* Computes the contact figures of the last step. */
void measure_contacts(Memory &memory, Statistics &statistics);
double kinetic_energy(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order);

/* A hash of the first `items` items of each buffer. */
uint64_t hash_buffers(Memory &memory, const std::vector<Buffer> &buffers, size_t items, uint64_t seed = 0);

} // namespace tandem
