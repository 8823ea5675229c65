/* first_failure.h - what a call throws whose parts ran on several threads: the exception of the lowest part that
 * failed, which does not depend on threads. */
#pragma once

#include <cstddef>
#include <exception>
#include <mutex>

namespace tandem {

class FirstFailure {
public:
  /* Notes what `work` throws. */
  template <class Work> void run(size_t part, const Work &work)
  {
    try {
      work();
    } catch (...) {
      note(part);
    }
  }
  bool has_happened()
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    return failure_ != nullptr;
  }
  void rethrow() const
  {
    if (failure_) std::rethrow_exception(failure_);
  }

private:
  void note(size_t part)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (failure_ && part_ < part) return;
    failure_ = std::current_exception();
    part_ = part;
  }

  std::mutex mutex_;
  std::exception_ptr failure_;
  size_t part_ = 0;
};

} // namespace tandem
