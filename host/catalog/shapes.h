/* shapes.h - built-in scenes of shapes beyond sphere and box: hulls, all of them in one pile, what
 * rolls. */
#pragma once

#include <vector>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> shape_scenes();

} // namespace tandem
