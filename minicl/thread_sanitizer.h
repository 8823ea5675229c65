/* thread_sanitizer.h - tells the thread sanitizer what oneTBB orders.
 *
 * Distributions build oneTBB without instrumentation, so the sanitizer cannot see that a launch begins before its items
 * and that these end before the launch does: each launch would look like a race with the next. The four marks below say
 * just that, and nothing about the items among themselves, whose races stay visible. No code in other builds.
 */
#pragma once

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void *address);
extern "C" void __tsan_release(void *address);
#endif

namespace tandem::minicl::launch_order {

#if defined(__SANITIZE_THREAD__)
inline char begun, ended;
inline void launch_begins() { __tsan_release(&begun); }
inline void items_begin() { __tsan_acquire(&begun); }
inline void items_end() { __tsan_release(&ended); }
inline void launch_ends() { __tsan_acquire(&ended); }
#else
inline void launch_begins() {}
inline void items_begin() {}
inline void items_end() {}
inline void launch_ends() {}
#endif

} // namespace tandem::minicl::launch_order
