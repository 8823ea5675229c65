/* error.h - what the library throws beside std::runtime_error of a device that fails. */
#pragma once

#include <stdexcept>

#include <tandem/export.h>

namespace tandem {

/* Bad use or bad input: one line that says what is wrong, where, and what would be right.
 * The command prints it and exits with status 2. */
struct TANDEM_API InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* What was wanted where memory ran out: the buffer and its bytes, the bodies and pairs of the world. A bare
 * std::bad_alloc says nothing that anyone could act on. */
struct TANDEM_API OutOfMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace tandem
