/* features.h - what a scene can need, as a set: a bit for each row of shared/features.def. */
#pragma once

#include <cstdint>

namespace tandem {

using Features = uint64_t;

} // namespace tandem
