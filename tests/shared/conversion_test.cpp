/* Saturating conversions, and the order of floats as integers. */
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "shared/conversion.h"
#include "tests/catch.h"

TEST_CASE("floor_to_int is the floor where it fits", "[conversion][sanitizer]")
{
  for (int i = -400'000; i <= 400'000; ++i) {
    const float x = 0.0173f * float(i);
    if (floor_to_int(x) != int(std::floor(x))) FAIL("floor of " << x << " gave " << floor_to_int(x));
  }
  for (float x : {0.0f, -0.0f, 1e-40f, 0.99999994f, 8388607.5f, 16777216.0f})
    CHECK(floor_to_int(x) == int(std::floor(x)));
  CHECK(floor_to_int(-1e-40f) == -1);
  CHECK(floor_to_int(-8388607.5f) == -8388608);
}

TEST_CASE("floor_to_int saturates at 2^30, and NaN gives 0", "[conversion][sanitizer]")
{
  const float infinity = std::numeric_limits<float>::infinity();
  for (float x : {1073741824.0f, 2e9f, 1e30f, infinity}) {
    CHECK(floor_to_int(x) == 1 << 30);
    CHECK(floor_to_int(-x) == -(1 << 30));
  }
  CHECK(floor_to_int(std::numeric_limits<float>::quiet_NaN()) == 0);
}

TEST_CASE("ordered_bits keep the order of floats", "[conversion]")
{
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> values{-infinity, infinity, -0.0f, 0.0f, 1e-45f, -1e-45f};
  for (float x = 1e-40f; x < 1e38f; x *= 3.7f) values.insert(values.end(), {x, -x});
  std::sort(values.begin(), values.end(),
            [](float a, float b) { return a < b || (a == b && std::signbit(a) && !std::signbit(b)); });
  for (size_t i = 1; i < values.size(); ++i) {
    CAPTURE(values[i - 1], values[i]);
    CHECK(ordered_bits(float_bits(values[i - 1])) < ordered_bits(float_bits(values[i])));
  }
}
