/* body_buffers.h - conversions between the scene's bodies and the records that kernels read, and what is measured on
 * these records. */
#pragma once

#include <vector>

#include <tandem/world.h>

#include "host/runtime/memory.h"
#include "shared/platform.h"

namespace tandem {

/* The two rows of a place: shared/records.h. */
std::array<float4, 2> double_float3_of(const Point &p);
/* Of length 1; left alone where it is. */
Quat unit(const Quat &q);

/* Buffer index i holds scene body order[i]. */
void upload_bodies(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order);
/* Size, flags, filter and pose of every body's shape, then of the children of compounds. Poses also of bodies with
 * tests of their own: any of them may meet a shape that has none. */
void upload_shapes(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order);
void upload_materials(Memory &memory, const Scene &scene);
void upload_body(Memory &memory, uint32_t index, const BodyState &state);
std::vector<BodyState> download_bodies(Memory &memory, const std::vector<uint32_t> &order);
std::vector<PreciseBodyState> download_precise_bodies(Memory &memory, const std::vector<uint32_t> &order);

bool is_finite(const BodyState &state);

/* What the host may change of a body, as it lies in the buffers. */
struct BodyRecord {
  std::array<float4, 2> position;
  float4 orientation;
  std::array<float4, 2> velocity;
  uint32_t flags;
};
BodyRecord read_body(Memory &memory, uint32_t index);
/* Whole or, where memory or a device fails, not at all. */
void write_body(Memory &memory, uint32_t index, const BodyRecord &record);

/* Takes the body at `index` out of the simulation: fixed, at rest, in no pair, where it last was finite. */
void quarantine_body(Memory &memory, uint32_t index);

/* Indices of the bodies whose velocity or motion of the last launches is not finite, or their state before it. */
std::vector<uint32_t> bodies_not_finite(Memory &memory, uint32_t bodies);

/* Fills the contact figures of the last step. */
void measure_contacts(Memory &memory, Statistics &statistics);
double kinetic_energy(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order);

/* Fingerprint of the first `items` items of each buffer. */
uint64_t hash_buffers(Memory &memory, const std::vector<Buffer> &buffers, size_t items, uint64_t seed = 0);

} // namespace tandem
