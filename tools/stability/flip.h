/* flip.h - the flips of a body that spins about its middle axis: their interval in theory, and a clock that measures
 * it.
 *
 * The theory is that of Landau and Lifshitz, Mechanics, section 37. The file is header-only, because the physics tests
 * use it even if the tools are not built.
 */
#pragma once

#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Core>

namespace tandem {

/* Twice the complete elliptic integral of the first kind, by the arithmetic-geometric mean. */
inline double twice_complete_elliptic(double modulus_squared)
{
  double a = 1, b = std::sqrt(1 - modulus_squared);
  while (std::abs(a - b) > 1e-15 * a) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi / a;
}

/* The time between two flips: from one zero of the spin about the middle axis to the next. `moments` must be ascending,
 * `spin` is in body axes. */
inline double flip_interval(const Eigen::Vector3d &moments, const Eigen::Vector3d &spin)
{
  const double energy2 = moments.dot(spin.cwiseProduct(spin)), momentum2 = moments.cwiseProduct(spin).squaredNorm();
  double i1 = moments[0], i2 = moments[1], i3 = moments[2];
  if (momentum2 < energy2 * i2) std::swap(i1, i3);
  const double rate = std::sqrt((i3 - i2) * (momentum2 - energy2 * i1) / (i1 * i2 * i3));
  const double modulus_squared = (i2 - i1) * (energy2 * i3 - momentum2) / ((i3 - i2) * (momentum2 - energy2 * i1));
  return twice_complete_elliptic(modulus_squared) / rate;
}

/* The mean time between sign changes of one body-axis component of the spin, each located between two moments by linear
 * interpolation. */
class FlipClock {
public:
  void note(double time, double spin)
  {
    if (before_ != 0 && spin * before_ < 0) {
      last_ = time - (time - time_) * spin / (spin - before_);
      if (flips_++ == 0) first_ = last_;
    }
    before_ = spin;
    time_ = time;
  }
  int flips() const { return flips_; }
  double interval() const { return (last_ - first_) / (flips_ - 1); } /* requires two flips */

private:
  double before_ = 0, time_ = 0, first_ = 0, last_ = 0;
  int flips_ = 0;
};

} // namespace tandem
