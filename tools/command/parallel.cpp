/* parallel.cpp - threads that take tasks from a shared counter; see parallel.h. */
#include "tools/command/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include <tbb/info.h>

namespace tandem {
namespace {

class Failure {
public:
  bool any() const { return failed_; }
  void note(size_t index, std::exception_ptr thrown)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (failed_ && index > index_) return;
    index_ = index;
    thrown_ = std::move(thrown);
    failed_ = true;
  }
  void rethrow() const
  {
    if (thrown_) std::rethrow_exception(thrown_);
  }

private:
  std::mutex mutex_;
  std::atomic<bool> failed_ = false;
  size_t index_ = 0;
  std::exception_ptr thrown_;
};

/* Starts as many threads as possible: if there are none, the calling thread does all the work. Threads that have
 * started must be joined in any case. */
void start(std::vector<std::thread> &helpers, size_t count, const std::function<void()> &work)
{
  try {
    helpers.reserve(count);
    while (helpers.size() < count) helpers.emplace_back(std::cref(work));
  } catch (const std::bad_alloc &) {
  } catch (const std::system_error &) {}
}

} // namespace

void in_parallel(size_t count, size_t threads, const std::function<void(size_t)> &task)
{
  std::atomic<size_t> next = 0;
  Failure failure;
  const std::function<void()> work = [&] {
    for (size_t i = next++; i < count && !failure.any(); i = next++) try {
        task(i);
      } catch (...) {
        failure.note(i, std::current_exception());
      }
  };
  std::vector<std::thread> helpers;
  start(helpers, std::min(std::max<size_t>(threads, 1), std::max<size_t>(count, 1)) - 1, work);
  work();
  for (std::thread &helper : helpers) helper.join();
  failure.rethrow();
}

size_t processor_count() { return static_cast<size_t>(std::max(1, tbb::info::default_concurrency())); }

} // namespace tandem
