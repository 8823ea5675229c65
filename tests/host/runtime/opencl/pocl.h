/* pocl.h - PoCL, the OpenCL device of the parity tests; every test that compares with it requires it by this header. */
#pragma once

#include "host/runtime/opencl/device.h"
#include "tests/catch.h"

namespace tandem::parity {

inline void require_pocl()
{
  static const bool found = [] {
    for (const opencl::DeviceInfo &device : opencl::list_devices())
      if (device.supported && device.platform_name == "Portable Computing Language") return true;
    return false;
  }();
  if (!found) tests::skip_device("no PoCL");
}

} // namespace tandem::parity
