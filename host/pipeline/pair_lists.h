/* pair_lists.h - the launches that sort pairs by kind; shared/narrowphase/pair_lists.h gives the reason. */
#pragma once

#include <cstdint>

#include "host/runtime/launcher.h"

namespace tandem {

/* Writes pair_of_kind and the entries of counts from KIND_START on; `capacity` is the largest possible number of
 * pairs. by_core: body_core is there, and pairs that are far by it get no contacts and are of no kind. */
void list_pairs(Launcher &launcher, uint32_t capacity, bool by_core);

} // namespace tandem
