/* body_buffers.h - converts between the scene's bodies and the records that kernels read, and measures statistics on
 * these records. */
#pragma once

#include <vector>

#include <tandem/world.h>

#include "host/runtime/memory.h"
#include "shared/platform.h"

namespace tandem {

/* The two float4s of a double_float3: shared/records.h. */
std::array<float4, 2> double_float3_of(const Point &p);
/* The quaternion at length 1; unchanged if it has that length already. */
Quat unit(const Quat &q);

/* Buffer index i holds scene body order[i]. */
void upload_bodies(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order);
/* Uploads size, flags, filter and pose of every body's shape, then of the children of compounds. Poses are uploaded
 * even for bodies with pair tests of their own, because any of them may meet a shape that has none. */
void upload_shapes(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order);
void upload_materials(Memory &memory, const Scene &scene);
void upload_body(Memory &memory, uint32_t index, const BodyState &state);
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

/* Computes the contact figures of the last step. */
void measure_contacts(Memory &memory, Statistics &statistics);
double kinetic_energy(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order);

/* A hash of the first `items` items of each buffer. */
uint64_t hash_buffers(Memory &memory, const std::vector<Buffer> &buffers, size_t items, uint64_t seed = 0);

} // namespace tandem
