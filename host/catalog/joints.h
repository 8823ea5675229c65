/* joints.h - built-in scenes of joints: grids, chains, pendulums. */
#pragma once

#include <vector>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> joint_scenes();

} // namespace tandem
