/* catch.h - Catch2 version 2 (Debian 12) or 3 (Ubuntu 24.04), whichever is installed, under the names of version 3, and
 * the functions by which a test reports that it cannot run, or not completely.
 *
 * A test that only returned would count as passed. It states what is missing instead, and tests/main.cpp ends with the
 * exit status by which CTest shows it as skipped. */
#pragma once

#include <cstdlib>
#include <iostream>
#include <string>

#if __has_include(<catch2/catch_all.hpp>)
#include <catch2/catch_all.hpp>
using Catch::Approx;
#else
#include <catch2/catch.hpp>
namespace Catch::Matchers {
inline auto ContainsSubstring(const std::string &part) { return Contains(part); }
} // namespace Catch::Matchers
#endif

#include <tandem/settings.h>

/* Enumerated settings are printed by name. */
template <tandem::Choice T> struct Catch::StringMaker<T> {
  static std::string convert(T choice) { return tandem::name_of(choice); }
};

namespace tests {

/* tests/main.cpp reads and clears these when a test case ends. */
inline bool left_something_out = false;

/* The rest of the test case runs, but the whole does not count as passed. */
inline void leave_out(const std::string &why)
{
  std::cout << "skipped: " << why << std::endl;
  left_something_out = true;
}

[[noreturn]] inline void skip(const std::string &why)
{
  leave_out(why);
#ifdef SKIP
  SKIP(why);
#else
  throw Catch::TestFailureException(); /* this ends a test case of version 2 and is no failure by itself */
#endif
  std::abort();
}

/* An OpenCL device is missing. This is a failure if CI=true, because nothing may be left out with the packages of
 * CI. */
inline void fail_in_ci(const std::string &what)
{
  const char *ci = std::getenv("CI");
  if (ci && std::string(ci) == "true") FAIL(what + ", which CI=true requires");
}
inline void leave_out_device(const std::string &what)
{
  fail_in_ci(what);
  leave_out(what);
}
[[noreturn]] inline void skip_device(const std::string &what)
{
  fail_in_ci(what);
  skip(what);
}

} // namespace tests
