/* quarantine_limits.h - when bodies that stop being finite are quarantined, in worlds alone and in batches. */
#pragma once

#include <cstddef>
#include <cstdint>

#include "shared/counts.h"

namespace tandem {

/* The status of attempts that lacked contacts. They say nothing of who is not finite with them. */
constexpr uint32_t lacks_pairs = STATUS_PAIRS | STATUS_CANDIDATES;
constexpr uint32_t lacks_contacts = lacks_pairs | STATUS_ROUNDS | STATUS_COLORS | STATUS_WAKE;

/* So many bodies of a step that stop being finite are quarantined one at a time, with a repetition each, so that bodies
 * which one of them would have infected stay. After that, all bodies that are not finite are quarantined at once. */
constexpr size_t taken_one_by_one = 32;

} // namespace tandem
