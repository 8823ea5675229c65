/* hull_buffers.h - the convex hulls of a scene as the tables that kernels read: shared/narrowphase/convex.h. */
#pragma once

#include <cstdint>
#include <map>

#include <tandem/scene.h>

#include "host/runtime/memory.h"

namespace tandem {

/* How many of each the hulls of a scene have together: cube maps may be too many for 32 bits (check_size of
 * layout.h). */
struct HullSizes {
  uint64_t hulls = 0, vertices = 0, faces = 0, corners = 0, edges = 0, chunk_float4s = 0, links = 0;
};
/* map_side: cells along a side of the cube maps of hull_support.h and cube_field.h; 0: none are made. */
HullSizes hull_sizes(const Scene &scene, uint32_t map_side);

/* The place of each hull, also of those of children, in the tables. */
std::map<const ConvexHull *, uint32_t> hull_numbers(const Scene &scene);

void upload_hulls(Memory &memory, const Scene &scene, uint32_t map_side);

} // namespace tandem
