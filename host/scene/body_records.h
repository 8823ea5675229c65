/* body_records.h - reads and writes the state of bodies in the buffers, of one or of all. */
#pragma once

#include <array>
#include <vector>

#include <tandem/world.h>

#include "host/runtime/memory.h"
#include "shared/platform.h"

namespace tandem {

void upload_body(Memory &memory, uint32_t index, const BodyState &state);
BodyState download_body(Memory &memory, uint32_t index);
std::vector<BodyState> download_bodies(Memory &memory, const std::vector<uint32_t> &order);
std::vector<PreciseBodyState> download_precise_bodies(Memory &memory, const std::vector<uint32_t> &order);

bool is_finite(const BodyState &state);

/* The part of a body that the host may change, as it is in the buffers. */
struct BodyRecord {
  std::array<float4, 2> position;
  float4 orientation;
  std::array<float4, 2> velocity;
  uint32_t flags;
};
BodyRecord read_body(Memory &memory, uint32_t index);
/* The change is complete or, if memory or a device fails, not made at all. */
void write_body(Memory &memory, uint32_t index, const BodyRecord &record);

/* Takes the body at `index` out of the simulation: it becomes fixed, at rest and without pairs, at its last finite
 * pose. */
void quarantine_body(Memory &memory, uint32_t index);

/* Indices of the bodies whose velocity or displacement of the last launches, or whose state before it, is not
 * finite. */
std::vector<uint32_t> bodies_not_finite(Memory &memory, uint32_t bodies);

} // namespace tandem
