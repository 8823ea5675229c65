/* address_sanitizer.h - makes an access to the bytes by which an allocation is longer than what it holds an error, as
 * one beyond the allocation is: buffers are rounded up to whole pages, which would hide an overrun. No code in other
 * builds.
 */
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

/* Of memory from std::aligned_alloc, which std::free takes as it is. */
inline void forbid_access([[maybe_unused]] void *memory, [[maybe_unused]] size_t first, [[maybe_unused]] size_t last)
{
#if defined(__SANITIZE_ADDRESS__)
  __asan_poison_memory_region(static_cast<char *>(memory) + first, last - first);
#endif
}

} // namespace tandem
