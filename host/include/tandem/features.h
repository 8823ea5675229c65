/* features.h - the features that a scene needs, as a set: one bit for each row of shared/features.def. It stands alone
 * so that public headers need no kernel list. */
#pragma once

#include <cstdint>

namespace tandem {

using Features = uint64_t;

} // namespace tandem
