/* materials.h - the physics materials of KHR_physics_rigid_bodies. Not a public header. */
#pragma once

#include "host/io/json/reader.h"

namespace tandem {

/* The default material, then those of the file: theirs are numbered from 1. */
std::vector<Material> read_gltf_materials(const JsonValue &bodies_extension);

} // namespace tandem
