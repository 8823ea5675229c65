/* ragdolls.h - people of 14 parts that fall over. */
#pragma once

#include "host/catalog/catalog.h"

namespace tandem {

BuiltInScene ragdoll_scene();

} // namespace tandem
