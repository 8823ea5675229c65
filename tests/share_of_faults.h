/* share_of_faults.h - of the places where memory or a device can fail, every so-manieth fails in a test: all of them
 * with TANDEM_TEST_SHARE_OF_FAULTS=1. A sanitizer takes thirty times as long and sees the same code at each
 * (tests/sanitizers/tests.cmake), and a command that starts anew for each place takes a minute for all. */
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace tests {

inline uint64_t share_of_faults(uint64_t usual)
{
  const char *text = std::getenv("TANDEM_TEST_SHARE_OF_FAULTS");
  return text ? std::stoull(text) : usual;
}

} // namespace tests
