/* random.h - the same random numbers on every machine.
 *
 * The distributions of <random> differ between standard libraries, and a scene must not. The generator is SplitMix64
 * (Steele, Lea, Flood: Fast splittable pseudorandom number generators, OOPSLA 2014). It computes in integers up to the
 * last step, and of floating point it uses only + - * / and sqrt, which IEEE 754 rounds exactly.
 */
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <tandem/round_to_float.h>

namespace tandem {

class Random {
public:
  explicit Random(uint64_t seed) : state_(seed) {}

  uint64_t next()
  {
    uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /* A multiple of 2^-53 in [0, 1). */
  double uniform() { return double(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /* A number in 0 .. count-1; the bias is below count / 2^32. */
  uint32_t below(uint32_t count) { return uint32_t(((next() >> 32) * count) >> 32); }

  /* An evenly distributed rotation x y z w: a point of the unit ball in four dimensions, normalised. Rejection sampling
   * avoids a sine. */
  std::array<float, 4> orientation()
  {
    for (;;) {
      double q[4], length_squared = 0;
      for (double &x : q) {
        x = uniform(-1, 1);
        length_squared += x * x;
      }
      if (length_squared > 1 || length_squared < 0.01) continue;
      double scale = 1 / std::sqrt(length_squared);
      return {round_to_float(q[0] * scale), round_to_float(q[1] * scale), round_to_float(q[2] * scale),
              round_to_float(q[3] * scale)};
    }
  }

private:
  uint64_t state_;
};

} // namespace tandem
