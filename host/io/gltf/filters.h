/* filters.h - the collision filters of KHR_physics_rigid_bodies as bits of groups and masks.
 *
 * The extension tests whether ALL systems of a collider are listed, whereas bits can only test for ANY. Each
 * combination of systems that occurs therefore gets a bit of its own, which is exact. Bit 0 is for colliders in no
 * system. This is not a public header.
 */
#pragma once

#include "host/io/json/reader.h"

namespace tandem {

struct GltfFilter {
  uint32_t group = 1, mask = 0xffffffffu;
};

std::vector<GltfFilter> read_gltf_filters(const JsonValue &bodies_extension);

} // namespace tandem
