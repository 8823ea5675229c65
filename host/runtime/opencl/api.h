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

/* A device that could not do what it was asked: out of memory, lost, ... */
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* A program that does not compile; the message carries the compiler's log, with file and line in cl/ or shared/. */
struct BuildError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* The code of a call, or of a device that has no room for it where a test wants that. */
template <class Call> cl_int code_of(faults::Site site, Call call)
{
  return faults::strikes(site) ? CL_OUT_OF_RESOURCES : call();
}

/* The same of calls that throw. */
inline void fail_where_a_test_wants(faults::Site site, const char *what)
{
  if (faults::strikes(site)) throw cl::Error(CL_OUT_OF_RESOURCES, what);
}

/* "CL_OUT_OF_RESOURCES (-5)" */
std::string error_name(cl_int code);

} // namespace tandem::opencl
