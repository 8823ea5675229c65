/* trigonometry.h - sine and cosine in double with the same bits everywhere, for what builds scenes.
 *
 * Those of the C library differ in the last bit between versions, processors and even between the processors that one
 * build chooses for when it starts. Kernels have their own in float: shared/trigonometry.h.
 */
#pragma once

#include <tandem/export.h>

namespace tandem {

struct SineCosine {
  double sine, cosine;
};

/* Angles in radians, of at most 10^6 in size; each wrong by less than 2.3e-16. */
TANDEM_API SineCosine sine_cosine(double angle);

} // namespace tandem
