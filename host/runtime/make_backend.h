/* make_backend.h - creates backends from the texts that users give them (<tandem/backend.h>). */
#pragma once

#include <memory>
#include <string>

#include <tandem/export.h>

#include "host/runtime/interface/backend.h"

namespace tandem {

/* Throws InputError that lists what is available if the text names no backend. */
TANDEM_API std::unique_ptr<Backend> make_backend(const std::string &text, bool allow_inexact = false);

} // namespace tandem
