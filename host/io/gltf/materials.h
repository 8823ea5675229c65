/* materials.h - the physics materials of KHR_physics_rigid_bodies. This is not a public header. */
#pragma once

#include "host/io/json/reader.h"

namespace tandem {

/* The default material, then those of the file, whose indices therefore start at 1. */
std::vector<Material> read_gltf_materials(const JsonValue &bodies_extension);

} // namespace tandem
