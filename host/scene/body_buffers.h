/* body_buffers.h - converts the scene's bodies to the rows that kernels read. */
#pragma once

#include <array>
#include <span>
#include <vector>

#include <tandem/world.h>

#include "host/scene/body_status.h"
#include "host/scene/hull_buffers.h"
#include "host/scene/staged_uploads.h"
#include "shared/platform.h"

namespace tandem {

/* The two float4s of a double_float3: shared/records.h. */
std::array<float4, 2> double_float3_of(const Point &p);
float4 float4_of_vec(const Vec3 &v, float w);
/* The flags of a body that takes part in nothing. */
uint32_t as_absent(uint32_t flags);
float inverse_mass_of(const Body &body); /* 0 unless it is dynamic */
/* The quaternion at length 1; unchanged if it has that length already. */
Quat unit(const Quat &q);

/* Buffer index i holds scene body order[i]: masses and the initial state. */
void stage_bodies(StagedUploads &uploads, const Scene &scene, const std::vector<uint32_t> &order);
void stage_masses(StagedUploads &uploads, const Scene &scene, const std::vector<uint32_t> &order);
/* Stages size, flags, filter and pose of every body's shape, then of the children of compounds, from the index
 * first_child on. Poses are uploaded even for bodies with pair tests of their own, because any of them may meet a shape
 * that has none. status: by body of the scene; empty: all are present. */
void stage_shapes(StagedUploads &uploads, const Scene &scene, const std::vector<uint32_t> &order, uint32_t first_child,
                  const std::vector<BodyStatus> &status = {});
/* Stages all rows of bodies without children, to the indices from `first` on. */
void stage_new_bodies(StagedUploads &uploads, const Scene &scene, const HullNumbers &hulls,
                      std::span<const uint32_t> bodies, uint32_t first);
/* Stages what steps remember of new bodies: nothing, though others may have had their places, in a state that was gone
 * back from, too. */
void stage_no_past(StagedUploads &uploads, size_t first, size_t bodies);
/* Stages what follows from properties of bodies (BodyProperties): mass, flags and filter of consecutive bodies, and
 * flags and filters of the children of one. */
void stage_properties(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> bodies, uint32_t first,
                      const std::vector<BodyStatus> &status);
void stage_child_properties(StagedUploads &uploads, const Scene &scene, uint32_t body, uint32_t first_child,
                            const std::vector<BodyStatus> &status);
/* Stages what a call wrote of a body and no step changes, but for the row of its tree. */
void stage_fixed_rows(StagedUploads &uploads, const Scene &scene, const HullNumbers &hulls, uint32_t body,
                      uint32_t index, BodyStatus status);
/* Stages the initial state of bodies, to the indices from `first` on. */
void stage_states(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> bodies, uint32_t first);
/* Stages where a reset puts the bodies of a batch of worlds. */
void stage_starts(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> order, uint32_t first = 0);
/* Makes slots free: points at rest that take part in nothing, where the bodies were. */
void stage_free_rows(StagedUploads &uploads, uint32_t first, uint32_t bodies);
void stage_materials(StagedUploads &uploads, const Scene &scene);

} // namespace tandem
