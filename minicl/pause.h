/* pause.h - what a thread does that waits with its eyes open. */
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tandem::minicl {

inline void pause_briefly()
{
#if defined(__x86_64__)
  _mm_pause();
#elif defined(__aarch64__)
  __asm__ volatile("yield");
#endif
}

} // namespace tandem::minicl
