/* empty_launch.cpp - see empty_launch.h. */
#include "host/runtime/opencl/empty_launch.h"

#include <algorithm>
#include <vector>

#include "shared/counts.h"
#include "shared/parameters.h"

namespace tandem::opencl {
namespace {

/* One buffer of zeros stands for all: with counts of 0 every range is empty. What kernels read before they look at
 * their range lies well within it. */
constexpr size_t bytes_of_zeros = 1 << 16;
static_assert(sizeof(Parameters) <= bytes_of_zeros && COUNT_TOTAL * sizeof(cl_uint) <= bytes_of_zeros);

/* Values are entries of counts, shifts and sizes that kernels of groups divide by, so none of them is 0. */
constexpr cl_uint any_value = 1;

} // namespace

void launch_over_nothing(const DeviceContext &context, cl::Kernel &kernel, const KernelRow &row, size_t group_size)
{
  std::vector<char> zeros(bytes_of_zeros);
  const cl::Buffer buffer(context.context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, zeros.size(), zeros.data());
  cl::CommandQueue queue(context.context, context.device, 0);
  const auto arguments = static_cast<cl_uint>(row.arguments.size());
  for (cl_uint i = 0; i < arguments; ++i)
    if (row.arguments[i].kind == Argument::Kind::value) kernel.setArg(i, any_value);
    else kernel.setArg(i, buffer);
  kernel.setArg(arguments, buffer); /* counts, and the range between two of its entries */
  kernel.setArg(arguments + 1, cl_uint{COUNT_ZERO});
  kernel.setArg(arguments + 2, cl_uint{COUNT_ZERO});
  queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(group_size), cl::NDRange(group_size));
  queue.finish();
}

} // namespace tandem::opencl
