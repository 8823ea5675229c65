/* pair_lists.cpp - counts, scans and writes the lists of pairs by kind; see pair_lists.h. */
#include "host/pipeline/pair_lists.h"

#include "host/pipeline/primitives.h"
#include "shared/counts.h"
#include "shared/platform.h"

namespace tandem {

void list_pairs(Launcher &launcher, uint32_t capacity, bool by_core)
{
  launcher.launch({Kernel::find_pair_kinds, {}, {by_core ? 1u : 0u}, COUNT_ZERO, COUNT_PAIRS, capacity});
  launcher.launch({Kernel::count_pair_kinds, {}, {}, COUNT_ZERO, COUNT_PAIRS, capacity});
  scan_table(launcher, Buffer::sort_histogram, Buffer::scan_sums, COUNT_PAIRS, TILE, PAIR_KIND_NONE + 1, capacity);
  launcher.launch({Kernel::start_pair_lists, {}, {}, COUNT_ZERO, COUNT_ONE, 1});
  launcher.launch({Kernel::list_pairs, {}, {}, COUNT_ZERO, COUNT_PAIRS, capacity});
}

} // namespace tandem
