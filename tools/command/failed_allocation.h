/* failed_allocation.h - the size of the allocation with which the command ran out of memory, because std::bad_alloc
 * does not contain it. */
#pragma once

#include <cstddef>
#include <string>

namespace tandem {

/* A text about the last allocation that failed, as the end of a message; empty if none has failed. */
std::string failed_allocation();
size_t failed_allocation_bytes(); /* 0 if none has failed */

} // namespace tandem
