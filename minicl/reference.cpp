/* reference.cpp - the kernels with `real` = double, by which the errors of float results are measured.
 *
 * Nothing here is compared bit for bit. The types of memory are wider too (shared/platform.h), so they are in this
 * namespace, and minicl/reference_storage.h keeps the buffers. */
#include "minicl/kernel_table.h"
#include "minicl/reference_storage.h"

#define TANDEM_REFERENCE
#define WIDTH reference
#include "minicl/width.inc"

namespace tandem::minicl {
/* Without gaps, the whole numbers stand one behind the other in both precisions. */
static_assert(offsetof(reference::Parameters, sleep_steps) % (2 * sizeof(reference::memory_real)) == 0);
static_assert((offsetof(reference::Parameters, features) - offsetof(reference::Parameters, sleep_steps)) %
                  sizeof(ulong) ==
              0);
const ParameterLayout reference_parameters = {
    offsetof(reference::Parameters, sleep_steps) / sizeof(reference::memory_real), sizeof(reference::Parameters)};
} // namespace tandem::minicl
