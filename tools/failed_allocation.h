/* failed_allocation.h - how much was wanted where the command ran out of memory: std::bad_alloc does not say. */
#pragma once

#include <string>

namespace tandem {

/* Of the last allocation that failed, as the end of a message; empty if none has. */
std::string failed_allocation();

} // namespace tandem
