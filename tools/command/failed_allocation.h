/* failed_allocation.h - how much was wanted where the command ran out of memory: std::bad_alloc does not say. */
#pragma once

#include <cstddef>
#include <string>

namespace tandem {

/* Of the last allocation that failed, as the end of a message; empty if none has. */
std::string failed_allocation();
size_t failed_allocation_bytes(); /* 0 if none has */

} // namespace tandem
