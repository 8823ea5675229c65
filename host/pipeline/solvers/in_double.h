/* in_double.h - the shared headers of contacts in double, so that the stage solve_islands has exactly the rows of the
 * iterative solver. */
#pragma once

#include <cstddef>
#include <cstdint>

#define TANDEM_REFERENCE
namespace tandem::in_double {
#include "shared/platform.h"
#include "shared/solve/contact.h"
} // namespace tandem::in_double
