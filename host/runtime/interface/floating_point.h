/* floating_point.h - one floating-point environment for every worker.
 *
 * The environment is round to nearest with denormals kept and exceptions masked. An application, or a library that it
 * loads, may have set flush-to-zero on any thread, which would change bits (docs/exactness.md).
 */
#pragma once

#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace tandem::minicl {

class ExactFloatingPoint {
public:
#if defined(__x86_64__)
  ExactFloatingPoint() : saved_(_mm_getcsr()) { _mm_setcsr(0x1f80); }
  ~ExactFloatingPoint() { _mm_setcsr(saved_); }

private:
  uint32_t saved_;
#else
  ExactFloatingPoint() {}
#endif
  ExactFloatingPoint(const ExactFloatingPoint &) = delete;
  ExactFloatingPoint &operator=(const ExactFloatingPoint &) = delete;
};

} // namespace tandem::minicl
