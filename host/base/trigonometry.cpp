/* trigonometry.cpp - reduces an angle to a quarter turn and sums Taylor's series; see trigonometry.h. */
#include "host/base/trigonometry.h"

#include <cmath>

namespace tandem {
namespace {

/* Half of pi in three parts (Cody and Waite). The first two have 33 bits, so that their products with a number of
 * quarter turns are exact. */
constexpr double quarter_high = 0x1.921fb544p+0, quarter_middle = 0x1.0b4611a6p-34, quarter_low = 0x1.3198a2e037073p-69;

/* Taylor's series, summed from the innermost term. The terms left out are below 1e-19 for angles up to pi / 4. */
double series(double square, int last)
{
  double sum = 1;
  for (int n = last; n > 1; n -= 2) sum = 1 - square / (n * (n - 1)) * sum;
  return sum;
}

} // namespace

SineCosine sine_cosine(double angle)
{
  const double quarters = std::floor(angle * 0x1.45f306dc9c883p-1 + 0.5);
  const double rest = ((angle - quarters * quarter_high) - quarters * quarter_middle) - quarters * quarter_low;
  const double square = rest * rest, sine = rest * series(square, 17), cosine = series(square, 18);
  switch (static_cast<long long>(quarters) & 3) {
  case 0: return {sine, cosine};
  case 1: return {cosine, -sine};
  case 2: return {-sine, -cosine};
  default: return {-cosine, sine};
  }
}

} // namespace tandem
