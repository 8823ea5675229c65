/* filters.h - the collision filters of KHR_physics_rigid_bodies as bits of groups and masks.
 *
 * The extension asks whether ALL systems of a collider are listed; bits can only ask for ANY. So each combination of
 * systems that occurs gets a bit of its own, which is exact. Bit 0: in no system. Not a public header.
 */
#pragma once

#include "host/io/json/reader.h"

namespace tandem {

struct GltfFilter {
  uint32_t group = 1, mask = 0xffffffffu;
};

std::vector<GltfFilter> read_gltf_filters(const JsonValue &bodies_extension);

} // namespace tandem
