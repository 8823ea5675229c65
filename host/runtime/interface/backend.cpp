/* backend.cpp - defaults for operations that most backends do not support. */
#include "host/runtime/interface/backend.h"

#include <stdexcept>

namespace tandem {

void Backend::run_cpu_kernel(const Launch &launch, Memory &)
{
  throw std::logic_error(std::string("kernel ") + row_of(launch.kernel).name + " runs on the host alone, not on " +
                         name());
}

void Backend::run_series(std::span<const BoundLaunch> series, void *counts)
{
  for (const BoundLaunch &bound : series) run(bound.launch, bound.arguments, counts);
}

} // namespace tandem
