/* main.cpp - Catch2's runner. It returns exit status 77 if nothing failed and no test case ran completely. CTest runs
 * one test a process and shows such a test as skipped. Version 3 has a status of its own for it, which is also that of
 * four failures. */
#if !__has_include(<catch2/catch_all.hpp>)
#define CATCH_CONFIG_RUNNER
#endif
#include "tests/catch.h"

namespace {

constexpr int status_skipped = 77;
Catch::Totals totals;
uint64_t incomplete = 0;

#ifdef CATCH_CONFIG_RUNNER
using ListenerBase = Catch::TestEventListenerBase;
#else
using ListenerBase = Catch::EventListenerBase;
#endif

struct Listener : ListenerBase {
  using ListenerBase::ListenerBase;

  void testCaseEnded(const Catch::TestCaseStats &) override
  {
    incomplete += tests::left_something_out;
    tests::left_something_out = false;
  }
  void testRunEnded(const Catch::TestRunStats &stats) override { totals = stats.totals; }
};

} // namespace

CATCH_REGISTER_LISTENER(Listener)

int main(int count, char **arguments)
{
  const int status = Catch::Session().run(count, arguments);
  if (incomplete == 0 || totals.assertions.failed > 0 || totals.testCases.failed > 0) return status;
  std::cout << incomplete << " of " << totals.testCases.total() << " test cases skipped or not whole\n";
  return incomplete == totals.testCases.total() ? status_skipped : status;
}
