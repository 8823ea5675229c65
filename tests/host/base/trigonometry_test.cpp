/* trigonometry_test.cpp - our sine and cosine in double against those of the C library in more digits. */
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "host/base/random.h"
#include "host/base/trigonometry.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

static_assert(sizeof(long double) > sizeof(double));

double worst_error(double largest, int count)
{
  Random random(1);
  long double worst = 0;
  for (int i = 0; i < count; ++i) {
    const double angle = random.uniform(-largest, largest);
    const SineCosine own = sine_cosine(angle);
    worst = std::max({worst, std::abs(own.sine - std::sin(static_cast<long double>(angle))),
                      std::abs(own.cosine - std::cos(static_cast<long double>(angle)))});
  }
  return static_cast<double>(worst);
}

} // namespace

TEST_CASE("trigonometry in double: wrong by less than 2.3e-16 up to a million radians")
{
  for (const double largest : {1e-3, 0.8, 3.2, 6.3, 100.0, 1e4, 1e6}) {
    CAPTURE(largest);
    CHECK(worst_error(largest, 200000) < 2.3e-16);
  }
}

TEST_CASE("trigonometry in double: small angles keep their digits, and quarter turns are where they must be")
{
  for (double angle = 1e-300; angle < 0.1; angle *= 3) {
    const auto exact = static_cast<double>(std::sin(static_cast<long double>(angle)));
    CHECK(std::abs(sine_cosine(angle).sine - exact) <= 0x1p-52 * exact);
  }
  const double quarter = std::acos(0.0);
  const double sines[] = {0, 1, 0, -1}, cosines[] = {1, 0, -1, 0};
  for (int k = -9; k <= 9; ++k) {
    CHECK(std::abs(sine_cosine(k * quarter).sine - sines[k & 3]) < 2e-15);
    CHECK(std::abs(sine_cosine(k * quarter).cosine - cosines[k & 3]) < 2e-15);
  }
}
