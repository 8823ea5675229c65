/* parts.cpp - see parts.h. */
#include "host/runtime/parts.h"

#include <algorithm>

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "host/runtime/first_failure.h"
#include "host/runtime/interface/floating_point.h"
#include "minicl/thread_sanitizer.h"
#include "minicl/worker_threads.h"

namespace tandem {

size_t parts_at_once()
{
  return std::min(minicl::settle_threads(), static_cast<size_t>(tbb::this_task_arena::max_concurrency()));
}

/* The caller may be a task of TBB's itself. If its group is cancelled, the parts run all the same, and while the caller
 * waits for them, it takes no other task, which may want a lock that the caller holds. */
void run_parts(size_t parts, PartFunction run)
{
  if (parts <= 1) return run_parts_in_order(parts, run);
  minicl::settle_threads();
  FirstFailure failure;
  minicl::LaunchOrder order;
  const auto run_one = [&](size_t part) TANDEM_UNWATCHED {
    const minicl::ExactFloatingPoint environment; /* threads of TBB may have another one */
    order.items_begin();
    failure.run(part, [&] { run(part); });
    order.items_end();
  };
  order.launch_begins();
  tbb::task_group_context own_group(tbb::task_group_context::isolated);
  tbb::this_task_arena::isolate(
      [&] { tbb::parallel_for(size_t{0}, parts, run_one, tbb::simple_partitioner{}, own_group); });
  order.launch_ends();
  failure.rethrow();
}

} // namespace tandem
