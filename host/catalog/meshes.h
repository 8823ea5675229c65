/* meshes.h - built-in scenes of meshes and compounds, part of the catalogue (catalog.h). */
#pragma once

#include <vector>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> mesh_scenes();

} // namespace tandem
