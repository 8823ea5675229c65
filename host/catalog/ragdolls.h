/* ragdolls.h - people of 14 parts: some fall over, some stand. */
#pragma once

#include "host/catalog/catalog.h"

namespace tandem {

BuiltInScene ragdoll_scene();
BuiltInScene humanoid_scene();

} // namespace tandem
