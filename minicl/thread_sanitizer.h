/* thread_sanitizer.h - tells the thread sanitizer what oneTBB orders.
 *
 * Distributions build oneTBB without instrumentation, so the sanitizer cannot see that a launch begins before its items
 * and that these end before the launch does: each launch would look like a race with the next. The four marks below say
 * just that, and nothing about the items among themselves, whose races stay visible, nor about any other launch: worlds
 * that step in different threads have no order. No code in other builds.
 */
#pragma once

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void *address);
extern "C" void __tsan_release(void *address);
/* Of the function that marks items: where the launch's order lies it must read before there is one. What it calls is
 * watched. */
#define TANDEM_UNWATCHED __attribute__((no_sanitize_thread))
#else
#define TANDEM_UNWATCHED
#endif

namespace tandem::minicl {

/* One for each launch. */
class LaunchOrder {
public:
#if defined(__SANITIZE_THREAD__)
  void launch_begins() { __tsan_release(&begun_); }
  void items_begin() { __tsan_acquire(&begun_); }
  void items_end() { __tsan_release(&ended_); }
  void launch_ends() { __tsan_acquire(&ended_); }

private:
  alignas(8) char begun_;
  alignas(8) char ended_;
#else
  void launch_begins() {}
  void items_begin() {}
  void items_end() {}
  void launch_ends() {}
#endif
};

} // namespace tandem::minicl
