/* empty_launch.h - launches a kernel over no items. A driver may leave part of its work until then: PoCL compiles a
 * kernel when it is first launched. */
#pragma once

#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/opencl/context.h"

namespace tandem::opencl {

/* For a kernel of the pipeline. Waits until it is done; throws cl::Error. */
void launch_over_nothing(const DeviceContext &context, cl::Kernel &kernel, const KernelRow &row, size_t group_size);

} // namespace tandem::opencl
