/* mechanisms.h - built-in scenes whose motion has a closed form: Newton's cradle, a four-bar linkage. */
#pragma once

#include <vector>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> mechanism_scenes();

} // namespace tandem
