/* pair_lists.h - the launches that sort pairs by kind: shared/narrowphase/pair_lists.h says what for. */
#pragma once

#include <cstdint>

#include "host/runtime/launcher.h"

namespace tandem {

/* To pair_of_kind and to the entries of counts from KIND_START on; `capacity`: the most pairs there can be. */
void list_pairs(Launcher &launcher, uint32_t capacity);

} // namespace tandem
