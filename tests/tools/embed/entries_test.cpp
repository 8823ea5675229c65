/* The entries that tools/embed writes, as OpenCL compiles them, against the tables of the host: names, order and
 * direction of every argument. */
#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/opencl/program.h"
#include "tests/host/runtime/opencl/opencl_device.h"

using namespace tandem;

namespace {

/* PoCL renames what has the name of a built-in function: length, round. */
std::string argument_name(const cl::Kernel &kernel, cl_uint index)
{
  const std::string name = kernel.getArgInfo<CL_KERNEL_ARG_NAME>(index).c_str();
  return name.rfind("_cl_", 0) == 0 ? name.substr(4) : name;
}

bool is_pointer(const cl::Kernel &kernel, cl_uint index)
{
  return kernel.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(index) == CL_KERNEL_ARG_ADDRESS_GLOBAL;
}

bool is_constant(const cl::Kernel &kernel, cl_uint index)
{
  return kernel.getArgInfo<CL_KERNEL_ARG_TYPE_QUALIFIER>(index) & CL_KERNEL_ARG_TYPE_CONST;
}

void compare(const KernelRow &row, const cl::Kernel &kernel)
{
  const cl_uint count = static_cast<cl_uint>(row.arguments.size());
  REQUIRE(kernel.getInfo<CL_KERNEL_NUM_ARGS>() == count + 3);
  for (cl_uint i = 0; i < count; ++i) {
    const Argument &argument = row.arguments[i];
    INFO("argument " << i << ": " << argument.name);
    CHECK(argument_name(kernel, i) == argument.name);
    CHECK(is_pointer(kernel, i) == (argument.kind != Argument::Kind::value));
    if (argument.kind != Argument::Kind::value) CHECK(is_constant(kernel, i) == (argument.access == Access::in));
  }
  CHECK(argument_name(kernel, count) == "range");
  CHECK(is_constant(kernel, count));
  CHECK(argument_name(kernel, count + 1) == "first");
  CHECK(argument_name(kernel, count + 2) == "last");
}

} // namespace

TEST_CASE("every row of kernels.def has its OpenCL entry, with the same arguments")
{
  const opencl::Candidate &device = test_device();
  const opencl::DeviceContext context(device);
  std::array<cl::Program, stage_count> programs;
  for (size_t k = 0; k < kernel_count; ++k) {
    const KernelRow &row = row_of(kernel_at(k));
    if (row.execution == Execution::host) continue;
    INFO("kernel " << row.name << " in cl/" << name_of(row.stage) << ".cl");
    cl::Program &program = programs[static_cast<size_t>(row.stage)];
    if (!program())
      program = opencl::build_program(context, opencl::embedded_program(name_of(row.stage)),
                                      "-cl-kernel-arg-info -D FEATURES=0u");
    cl::Kernel kernel;
    REQUIRE_NOTHROW(kernel = cl::Kernel(program, row.name));
    compare(row, kernel);
  }
}
