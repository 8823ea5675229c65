/* shapes.h - built-in scenes of shapes other than spheres and boxes: hulls, all shapes in one pile, rolling bodies,
 * fast bodies against thin walls. They are part of the catalogue (catalog.h). */
#pragma once

#include <vector>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> shape_scenes();

} // namespace tandem
