/* device.cpp - to come. */
#include "host/opencl/device.h"

#include "host/scene.h"

namespace tandem::opencl {

std::unique_ptr<Backend> make_backend(const std::string &text, const std::string &, bool)
{
  throw InputError("backend '" + text + "': OpenCL is not built in yet");
}

} // namespace tandem::opencl
