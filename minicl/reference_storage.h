/* reference_storage.h - the buffers of the reference backend: every real is a double, every integer is unchanged.
 *
 * Transfers widen and round. Any kernel can therefore run in double in the middle of a float step, and a world on this
 * backend alone keeps full precision from step to step. */
#pragma once

#include "host/runtime/interface/storage.h"

namespace tandem::minicl {

Storage &reference_storage();

/* The layout of the parameters in double: a number of reals, then whole numbers as in float. */
struct ParameterLayout {
  size_t reals, bytes;
};
extern const ParameterLayout reference_parameters;

} // namespace tandem::minicl
