/* thread_sanitizer.h - informs the thread sanitizer of the order that oneTBB enforces.
 *
 * Distributions build oneTBB without instrumentation. The sanitizer therefore cannot see that a launch begins before
 * its items and ends after them, and each launch would look like a race with the next. The four marks below state this
 * order and nothing else. Races among items stay visible, and so do races between launches of worlds that step in
 * different threads. In other builds the file has no code.
 */
#pragma once

#if defined(__SANITIZE_THREAD__)
extern "C" void __tsan_acquire(void *address);
extern "C" void __tsan_release(void *address);
/* An attribute for the function that marks items, because it must read the address of the order before there is an
 * order. The functions that it calls are instrumented. */
#define TANDEM_UNWATCHED __attribute__((no_sanitize_thread))
#else
#define TANDEM_UNWATCHED
#endif

namespace tandem::minicl {

/* The order of one launch. */
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
