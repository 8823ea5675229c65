/* Sine, cosine and arc tangent of shared/ against double precision, over dense sweeps. */
#include <cmath>
#include <limits>

#include "shared/trigonometry.h"
#include "tests/catch.h"

namespace {

struct Errors {
  double sine = 0, cosine = 0, length = 0;
};

Errors sweep_angles(double limit, int samples)
{
  Errors worst;
  for (int i = -samples; i <= samples; ++i) {
    const float angle = float(limit * i / samples);
    const angle_functions f = sine_cosine(angle);
    worst.sine = std::max(worst.sine, std::abs(f.sine - std::sin(double(angle))));
    worst.cosine = std::max(worst.cosine, std::abs(f.cosine - std::cos(double(angle))));
    worst.length = std::max(worst.length, std::abs(std::hypot(double(f.sine), double(f.cosine)) - 1));
  }
  return worst;
}

} // namespace

TEST_CASE("sine and cosine are within a rounding or two of double precision", "[trigonometry][sanitizer]")
{
  struct Sweep {
    double limit, bound;
  };
  for (const Sweep &sweep : {Sweep{3.2, 1.0e-7}, Sweep{100, 1.0e-7}, Sweep{8192, 1.0e-7}}) {
    const Errors worst = sweep_angles(sweep.limit, 400'000);
    INFO("angles to +-" << sweep.limit << ": sine " << worst.sine << ", cosine " << worst.cosine << ", length "
                        << worst.length);
    CHECK(worst.sine < sweep.bound);
    CHECK(worst.cosine < sweep.bound);
    CHECK(worst.length < sweep.bound);
  }
}

TEST_CASE("sine is odd, cosine even, and both exact at zero", "[trigonometry]")
{
  CHECK(sine_cosine(0.0f).sine == 0.0f);
  CHECK(sine_cosine(0.0f).cosine == 1.0f);
  for (int i = 0; i < 100'000; ++i) {
    const float angle = 0.01f * float(i);
    const angle_functions f = sine_cosine(angle), g = sine_cosine(-angle);
    if (f.sine != -g.sine || f.cosine != g.cosine) FAIL("angle " << angle);
  }
}

TEST_CASE("small angles keep their relative precision", "[trigonometry]")
{
  for (float angle = 0.5f; angle > 1e-30f; angle *= 0.75f) {
    const double error = std::abs(sine_cosine(angle).sine / std::sin(double(angle)) - 1);
    if (error > 1.2e-7) FAIL("sine of " << angle << " is off by " << error << " relative");
  }
}

TEST_CASE("angles beyond the limit count as the limit", "[trigonometry]")
{
  const angle_functions at_limit = sine_cosine(8192.0f);
  for (float angle : {8192.5f, 1e6f, 1e30f, std::numeric_limits<float>::infinity()}) {
    CHECK(sine_cosine(angle).sine == at_limit.sine);
    CHECK(sine_cosine(-angle).cosine == at_limit.cosine);
  }
}

TEST_CASE("arc tangent is within a rounding or two of double precision in the whole plane", "[trigonometry][sanitizer]")
{
  double worst = 0;
  for (int i = 0; i < 400'000; ++i) {
    const double angle = -3.14159265 + 6.2831853 * i / 400'000;
    for (double radius : {1e-20, 0.7, 3e15}) {
      const float x = float(radius * std::cos(angle)), y = float(radius * std::sin(angle));
      worst = std::max(worst, std::abs(arc_tangent(y, x) - std::atan2(double(y), double(x))));
    }
  }
  INFO("arc tangent: largest error " << worst);
  CHECK(worst < 3e-7);
}

TEST_CASE("arc tangent on the axes", "[trigonometry]")
{
  const float half_turn = 3.14159265f;
  CHECK(arc_tangent(0.0f, 0.0f) == 0.0f);
  CHECK(arc_tangent(0.0f, 2.0f) == 0.0f);
  CHECK(arc_tangent(3.0f, 0.0f) == 0.5f * half_turn);
  CHECK(arc_tangent(-3.0f, 0.0f) == -0.5f * half_turn);
  CHECK(arc_tangent(0.0f, -1.0f) == half_turn);
  CHECK(arc_tangent(2.0f, 2.0f) == 0.25f * half_turn);
}
