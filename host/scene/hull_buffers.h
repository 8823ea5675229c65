/* hull_buffers.h - the convex hulls of a scene as the tables that kernels read: shared/narrowphase/hull_support.h. */
#pragma once

#include <cstdint>
#include <map>

#include <tandem/scene.h>

#include "host/scene/staged_uploads.h"

namespace tandem {

/* The sizes of the tables of all hulls of a scene together. Cube maps may exceed 32 bits (check_size of layout.h). */
struct HullSizes {
  uint64_t hulls = 0, vertices = 0, faces = 0, corners = 0, edges = 0, chunk_float4s = 0, links = 0;
};
/* Cells along a side of the cube maps of each hull: of its farthest vertices (shared/narrowphase/hull_support.h), and
 * of its faces (cube_field.h there). 0: there is no such map, because nothing reads it. */
struct HullMaps {
  uint32_t vertices = 0, faces = 0;
};
HullSizes hull_sizes(const Scene &scene, const HullMaps &maps);

/* The index of each hull in the tables, including the hulls of children. */
using HullNumbers = std::map<const ConvexHull *, uint32_t>;
HullNumbers hull_numbers(const Scene &scene);

void stage_hulls(StagedUploads &uploads, const Scene &scene, const HullMaps &maps);

} // namespace tandem
