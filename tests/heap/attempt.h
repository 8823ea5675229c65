/* attempt.h - runs a call during which one allocation fails, and checks what must hold after every such call. */
#pragma once

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>

#include "host/base/out_of_memory.h"
#include "tests/catch.h"
#include "tests/heap/allocations.h"
#include "tests/share_of_faults.h"

namespace tests::heap {

struct Outcome {
  bool struck = false, thrown = false, of_memory = false;
  int64_t left = 0;                /* blocks held after the call and not before */
  std::array<char, 300> message{}; /* not a string, whose own block would count */
};

template <class Call> Outcome attempt(uint64_t nth, bool once, Call &&call)
{
  Outcome outcome;
  const int64_t before = held();
  const auto note = [&](const char *why, bool of_memory) {
    outcome.thrown = true;
    outcome.of_memory = of_memory;
    std::snprintf(outcome.message.data(), outcome.message.size(), "%s", why);
  };
  try {
    const Failing failing(nth, once);
    call();
  } catch (const tandem::OutOfMemory &error) {
    note(error.what(), true);
  } catch (const std::bad_alloc &error) {
    note(error.what(), true);
  } catch (const std::exception &error) {
    note(error.what(), false);
  }
  outcome.left = held() - before;
  outcome.struck = struck();
  return outcome;
}

/* A user without memory must read that, and nothing else; in particular not that a file is wrong. */
inline void check_told(const Outcome &outcome)
{
  INFO(outcome.message.data());
  if (outcome.thrown) CHECK(outcome.of_memory);
  if (!outcome.struck) CHECK_FALSE(outcome.thrown);
}

inline size_t open_files()
{
  size_t count = 0;
  for ([[maybe_unused]] const auto &entry : std::filesystem::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

using After = std::function<void(const Outcome &)>;

/* Lets every allocation of `call` fail in turn, alone and with all that follow it, until the call succeeds. Each failed
 * call must leave no block behind. The code around it runs with enough memory. */
template <class Call>
void fail_everywhere(
    Call &&call, const std::function<void()> &before = [] {}, const After &after = [](const Outcome &) {})
{
  call(); /* makes what is made once and kept */
  const size_t files = open_files();
  uint64_t failures = 0;
  for (const bool once : {true, false})
    for (uint64_t nth = 0;; nth += share_of_faults(1)) {
      CAPTURE(nth, once);
      before();
      const Outcome outcome = attempt(nth, once, call);
      check_told(outcome);
      CHECK(outcome.left == 0);
      after(outcome);
      failures += outcome.thrown;
      if (!outcome.struck) break;
    }
  CHECK(open_files() == files);
  CHECK(failures > 0);
}

} // namespace tests::heap
