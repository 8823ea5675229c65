/* Work in parts, called by a program that has tasks of TBB's itself. */
#include <atomic>
#include <chrono>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "host/runtime/parts.h"
#include "minicl/worker_threads.h"
#include "tests/catch.h"

using namespace tandem;

TEST_CASE("parts: all run, also in a task whose group is cancelled", "[address]")
{
  constexpr size_t parts = 64;
  std::vector<std::atomic<int>> runs(parts);
  tbb::task_group_context group;
  tbb::parallel_for(
      0, 1,
      [&](int) {
        group.cancel_group_execution();
        run_parts(parts, PartFunction([&](size_t part) { ++runs[part]; }));
      },
      tbb::simple_partitioner{}, group);
  for (const std::atomic<int> &count : runs) CHECK(count == 1);
}

/* A task that a waiting thread took besides could want a lock that this thread holds. */
TEST_CASE("parts: a thread that waits for them begins no other task of the caller's", "[address]")
{
  static thread_local int begun = 0;
  std::atomic<int> most = 0;
  const auto spin = [](int microseconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(microseconds);
    while (std::chrono::steady_clock::now() < end) {}
  };
  const auto task = [&](int number) {
    ++begun;
    for (int seen = most; begun > seen && !most.compare_exchange_weak(seen, begun);) {}
    if (number % 2 != 0) spin(50 * (number % 7));
    else run_parts(16, PartFunction([&](size_t part) { spin(static_cast<int>(10 * (part % 5))); }));
    --begun;
  };
  minicl::want_threads(8); /* more than most machines of tests have: some wait while others have a part */
  minicl::settle_threads();
  tbb::task_arena arena(8);
  for (int round = 0; round < 20; ++round)
    arena.execute([&] { tbb::parallel_for(0, 64, task, tbb::simple_partitioner{}); });
  CHECK(most == 1);
}
