/* failed_allocation.cpp - the operators new and delete of the command, which record the size of an allocation that
 * failed; see failed_allocation.h.
 *
 * They are part of the executable alone, because a library must not replace its users' allocator. A sanitizer's own
 * operators are kept. */
#include "tools/command/failed_allocation.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <fmt/format.h>

namespace {
std::atomic<size_t> wanted{0};
}

namespace tandem {

size_t failed_allocation_bytes() { return wanted; }

std::string failed_allocation()
{
  const size_t bytes = wanted;
  return bytes > 0 ? fmt::format(" (the last allocation that failed was of {} bytes)", bytes) : "";
}

} // namespace tandem

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
void *operator new(size_t bytes)
{
  if (void *memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
  wanted = bytes;
  throw std::bad_alloc();
}
void operator delete(void *memory) noexcept { std::free(memory); }
void operator delete(void *memory, size_t) noexcept { std::free(memory); }
#endif
