/* make_backend.h - backends by the names that users give them. */
#pragma once

#include <memory>
#include <string>

#include <tandem/export.h>

#include "host/runtime/interface/backend.h"

namespace tandem {

/* "serial[:order=backward]", "tbb[:threads=N,lanes=1|4|8|16]", "cl[:P.D]", "cl:part-of-a-name",
 * "reference[:threads=N]": the same kernels in double, for measuring errors, never compared bit for bit.
 * InputError names what is available when the text names nothing. */
TANDEM_API std::unique_ptr<Backend> make_backend(const std::string &text, bool allow_inexact = false);

} // namespace tandem
