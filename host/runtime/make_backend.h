/* make_backend.h - creates backends from the names that users give them. It is the one place where the kinds of
 * backends are listed. */
#pragma once

#include <memory>
#include <string>

#include <tandem/export.h>

#include "host/runtime/interface/backend.h"

namespace tandem {

/* The text is "serial[:order=backward]", "tbb[:threads=N,lanes=1|4|8|16]", "cl[:P.D]", "cl:part-of-a-name", or
 * "reference[:threads=N]". The last runs the same kernels in double, to measure errors, and is never compared bit for
 * bit. Throws InputError that lists what is available if the text names no backend. */
TANDEM_API std::unique_ptr<Backend> make_backend(const std::string &text, bool allow_inexact = false);

} // namespace tandem
