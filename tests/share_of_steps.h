/* share_of_steps.h - a sanitizer takes ten times as long and sees the same code in each step, so backends are compared
 * there over a share of the steps (tests/sanitizers/tests.cmake). */
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace tests {

/* At least four, so that contacts are cached, matched and warm started. */
inline uint64_t share_of_steps(uint64_t usual)
{
  const char *text = std::getenv("TANDEM_TEST_SHARE_OF_STEPS");
  const uint64_t share = text ? std::stoull(text) : 1;
  return std::max(std::min(usual, uint64_t{4}), usual / share);
}

} // namespace tests
