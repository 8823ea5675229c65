/* address_sanitizer.h - marks the padding of an allocation as inaccessible. Buffers are rounded up to whole pages,
 * which would hide an overrun; with AddressSanitizer an access to the padding is an error, as one beyond the allocation
 * is. Other builds contain no code of it. */
#pragma once

#include <cstddef>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) && !defined(__SANITIZE_ADDRESS__)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
extern "C" void __asan_poison_memory_region(const volatile void *address, size_t bytes);
#endif

namespace tandem {

/* The memory must be from std::aligned_alloc; std::free accepts it without unpoisoning. */
inline void forbid_access([[maybe_unused]] void *memory, [[maybe_unused]] size_t first, [[maybe_unused]] size_t last)
{
#if defined(__SANITIZE_ADDRESS__)
  __asan_poison_memory_region(static_cast<char *>(memory) + first, last - first);
#endif
}

} // namespace tandem
