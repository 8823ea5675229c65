/* api.h - the OpenCL headers as this project uses them: version 1.2, with exceptions. */
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#include <stdexcept>
#include <string>

#include <CL/opencl.hpp>

#include "host/runtime/interface/faults.h"

namespace tandem::opencl {

/* A device failed: it is out of memory, was lost, ... */
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* A program does not compile; the message contains the compiler's log, with file and line in cl/ or shared/. */
struct BuildError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* The code of a call. If a test injects a fault here, it is that of a device without resources. */
template <class Call> cl_int code_of(faults::Site site, Call call)
{
  return faults::strikes(site) ? CL_OUT_OF_RESOURCES : call();
}

/* The same for calls that throw. */
inline void fail_where_a_test_wants(faults::Site site, const char *what)
{
  if (faults::strikes(site)) throw cl::Error(CL_OUT_OF_RESOURCES, what);
}

/* "CL_OUT_OF_RESOURCES (-5)" */
std::string error_name(cl_int code);

} // namespace tandem::opencl
