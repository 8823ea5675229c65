/* parts.h - runs parts of the host's own work on TBB's threads, for what is too large for one: snapshots, and islands
 * of the direct solver. Kernels are the dispatcher's (minicl/dispatcher.h). */
#pragma once

#include "host/base/parts.h"

namespace tandem {

/* A RunParts. Results must not depend on the order of the parts. */
void run_parts(size_t parts, PartFunction run);
/* The most parts that run at the same time. */
size_t parts_at_once();

} // namespace tandem
