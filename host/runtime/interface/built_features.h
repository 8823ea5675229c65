/* built_features.h - the features that this library has kernels for: all, unless it was configured for some alone with
 * -DTANDEM_FEATURES=... (cmake/Features.cmake). */
#pragma once

#include <tandem/features.h>

namespace tandem {

Features built_features();

/* The value of the option; empty if all are built. */
const char *built_option();

} // namespace tandem
