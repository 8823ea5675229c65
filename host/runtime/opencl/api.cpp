/* api.cpp - the names of OpenCL's error codes, for messages. */
#include "host/runtime/opencl/api.h"

#include <fmt/format.h>

namespace tandem::opencl {

std::string error_name(cl_int code)
{
#define NAME(constant) \
  case constant: return fmt::format("{} ({})", #constant, code);
  switch (code) {
    NAME(CL_DEVICE_NOT_FOUND)
    NAME(CL_DEVICE_NOT_AVAILABLE)
    NAME(CL_COMPILER_NOT_AVAILABLE)
    NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE)
    NAME(CL_OUT_OF_RESOURCES)
    NAME(CL_OUT_OF_HOST_MEMORY)
    NAME(CL_MEM_COPY_OVERLAP)
    NAME(CL_BUILD_PROGRAM_FAILURE)
    NAME(CL_MAP_FAILURE)
    NAME(CL_INVALID_VALUE)
    NAME(CL_INVALID_BUFFER_SIZE)
    NAME(CL_INVALID_BINARY)
    NAME(CL_INVALID_BUILD_OPTIONS)
    NAME(CL_INVALID_PROGRAM)
    NAME(CL_INVALID_KERNEL_NAME)
    NAME(CL_INVALID_KERNEL_ARGS)
    NAME(CL_INVALID_ARG_INDEX)
    NAME(CL_INVALID_ARG_VALUE)
    NAME(CL_INVALID_ARG_SIZE)
    NAME(CL_INVALID_MEM_OBJECT)
    NAME(CL_INVALID_WORK_GROUP_SIZE)
    NAME(CL_INVALID_WORK_ITEM_SIZE)
    NAME(CL_INVALID_COMMAND_QUEUE)
    NAME(CL_INVALID_CONTEXT)
    NAME(CL_INVALID_OPERATION)
  default: return fmt::format("OpenCL error {}", code);
  }
#undef NAME
}

} // namespace tandem::opencl
