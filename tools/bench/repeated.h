/* repeated.h - `tandem bench sort`, `scan` and `step`: benchmarks that measure one thing, a number of times. */
#pragma once

#include "tools/bench/options.h"

namespace tandem {

int execute_repeated(const BenchOptions &options);

} // namespace tandem
