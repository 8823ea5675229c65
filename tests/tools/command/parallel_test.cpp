/* parallel_test.cpp - parallel tasks: each runs once, no more at a time than asked for, and the first exception is
 * rethrown. */
#ifdef TANDEM_COMMAND
#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/catch.h"
#include "tools/command/parallel.h"

using namespace tandem;

TEST_CASE("parallel: each task runs once, and at most as many at a time as asked for", "[parallel]")
{
  for (const size_t threads : {1u, 3u, 50u}) {
    std::vector<std::atomic<int>> calls(20);
    std::atomic<size_t> running = 0, most = 0;
    in_parallel(calls.size(), threads, [&](size_t i) {
      const size_t now = ++running;
      for (size_t seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {}
      std::this_thread::yield();
      ++calls[i];
      --running;
    });
    for (const std::atomic<int> &count : calls) CHECK(count == 1);
    CHECK(most <= threads);
  }
  in_parallel(0, 4, [](size_t) { FAIL("there is no task"); });
}

TEST_CASE("parallel: one at a time they go in order, on the calling thread", "[parallel]")
{
  std::vector<size_t> order;
  in_parallel(5, 1, [&, caller = std::this_thread::get_id()](size_t i) {
    CHECK(std::this_thread::get_id() == caller);
    order.push_back(i);
  });
  CHECK(order == std::vector<size_t>{0, 1, 2, 3, 4});
}

/* Both wait for each other, so that both throw. */
TEST_CASE("parallel: of several throws that of the earliest task comes out, and nothing begins after it", "[parallel]")
{
  std::atomic<int> begun = 0;
  try {
    in_parallel(1000, 2, [&](size_t i) {
      ++begun;
      while (begun < 2) std::this_thread::yield();
      throw std::runtime_error(i == 0 ? "first" : "later");
    });
    FAIL("nothing was thrown");
  } catch (const std::runtime_error &error) {
    CHECK(std::string(error.what()) == "first");
  }
  CHECK(begun == 2);
}
#endif
