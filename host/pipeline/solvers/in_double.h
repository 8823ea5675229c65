/* in_double.h - the shared headers of contacts and joints in double, so that the stage solve_islands has the rows of
 * the iterative solver, but for rounding: arms of b, for example, are differences that only the latter rounds to
 * floats. */
#pragma once

#include <cstddef>
#include <cstdint>

#include "host/runtime/memory.h" /* before, because what it has of shared/ stands outside of the namespace */

#define TANDEM_REFERENCE
namespace tandem::in_double {
#include "shared/joints/couplings.h"
#include "shared/platform.h"
#include "shared/solve/soft_step.h"
} // namespace tandem::in_double
