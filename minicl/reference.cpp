/* reference.cpp - the same kernels with `real` = double: the truth that float results are measured against.
 *
 * Nothing here is compared bit for bit. Types of memory are wider too (shared/platform.h), so they live in this
 * namespace, and buffers are kept by minicl/reference_storage.h. */
#include "minicl/kernel_table.h"
#include "minicl/reference_storage.h"

#define TANDEM_REFERENCE
#define WIDTH reference
#include "minicl/width.inc"

namespace tandem::minicl {
const ParameterLayout reference_parameters = {
    offsetof(reference::Parameters, features) / sizeof(reference::memory_real), sizeof(reference::Parameters)};
}
