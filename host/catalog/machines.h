/* machines.h - built-in scenes of coupled joints: a mill of gears, a crane. */
#pragma once

#include <vector>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> machine_scenes();

} // namespace tandem
