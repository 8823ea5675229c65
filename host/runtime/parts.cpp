/* parts.cpp - see parts.h. */
#include "host/runtime/parts.h"

#include <exception>
#include <mutex>

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include "minicl/thread_sanitizer.h"
#include "minicl/worker_threads.h"

namespace tandem {
namespace {

/* The exception of the lowest part that failed. */
class FirstFailure {
public:
  void note(size_t part)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (failure_ && part_ < part) return;
    failure_ = std::current_exception();
    part_ = part;
  }
  void rethrow() const
  {
    if (failure_) std::rethrow_exception(failure_);
  }

private:
  std::mutex mutex_;
  std::exception_ptr failure_;
  size_t part_ = 0;
};

} // namespace

void run_parts(size_t parts, PartFunction run)
{
  if (parts <= 1) return run_parts_in_order(parts, run);
  minicl::settle_threads();
  FirstFailure failure;
  minicl::LaunchOrder order;
  order.launch_begins();
  tbb::parallel_for(
      size_t{0}, parts,
      [&](size_t part) TANDEM_UNWATCHED {
        order.items_begin();
        try {
          run(part);
        } catch (...) {
          failure.note(part);
        }
        order.items_end();
      },
      tbb::simple_partitioner{});
  order.launch_ends();
  failure.rethrow();
}

} // namespace tandem
