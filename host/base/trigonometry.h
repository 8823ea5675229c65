/* trigonometry.h - sine and cosine in double with the same bits everywhere, for the code that builds scenes.
 *
 * The functions of the C library differ in the last bit between versions and between processors; one binary may even
 * select another variant at start-up. Kernels have their own functions in float: shared/trigonometry.h.
 */
#pragma once

#include <tandem/export.h>

namespace tandem {

struct SineCosine {
  double sine, cosine;
};

/* The angle is in radians and at most 10^6 in size; the error of each result is below 2.3e-16. */
TANDEM_API SineCosine sine_cosine(double angle);

} // namespace tandem
