/* device_backend.h - the backend that launches kernels on one OpenCL device. */
#pragma once

#include <memory>
#include <string>

#include "host/runtime/interface/backend.h"
#include "host/runtime/opencl/context.h"

namespace tandem::opencl {

std::unique_ptr<Backend> make_device_backend(const std::string &name, const Candidate &candidate);

} // namespace tandem::opencl
