/* device.h - OpenCL platforms and devices, their self-test, and the backend over one of them. */
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/backend.h"

namespace tandem::opencl {

/* `choice`: "" the best device, "P.D" platform and device number, or part of a platform's or device's name. */
std::unique_ptr<Backend> make_backend(const std::string &text, const std::string &choice, bool allow_inexact);

} // namespace tandem::opencl
