/* backend.cpp - what most backends do not have. */
#include "host/runtime/interface/backend.h"

#include <stdexcept>

namespace tandem {

void Backend::run_cpu_kernel(const Launch &launch, Memory &)
{
  throw std::logic_error(std::string("kernel ") + row_of(launch.kernel).name + " runs on the host alone, not on " +
                         name());
}

} // namespace tandem
