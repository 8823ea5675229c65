/* reference_storage.h - buffers of the reference backend: every real a double, every integer as it is.
 *
 * Moves widen and round, so any kernel can run in double in the middle of a float step, and a world that lives here
 * alone keeps full precision from step to step. */
#pragma once

#include "host/runtime/interface/storage.h"

namespace tandem::minicl {

Storage &reference_storage();

/* Parameters in double: so many reals, then whole numbers as in float. */
struct ParameterLayout {
  size_t reals, bytes;
};
extern const ParameterLayout reference_parameters;

} // namespace tandem::minicl
