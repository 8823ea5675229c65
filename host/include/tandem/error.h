/* error.h - the exceptions of the library. Beside them it throws std::runtime_error when a device fails. */
#pragma once

#include <stdexcept>

#include <tandem/export.h>

namespace tandem {

/* Bad use or bad input. The message is one line that says what is wrong, where, and what would be right. The command
 * prints it and exits with status 2. */
struct TANDEM_API InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* Memory ran out. The message names what was requested: the buffer and its bytes, the bodies and pairs of the world. A
 * bare std::bad_alloc tells the user nothing to act on. */
struct TANDEM_API OutOfMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* A step needed more than its StepLimits allow. The message says what it needs. */
struct TANDEM_API LimitExceeded : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace tandem
