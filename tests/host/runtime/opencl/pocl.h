/* pocl.h - PoCL, the OpenCL device of the parity tests; every test that compares with it requires it by this header. */
#pragma once

#include <string>
#include <vector>

#include "host/runtime/opencl/device.h"
#include "tests/catch.h"

namespace tandem::parity {

inline bool has_pocl()
{
  static const bool found = [] {
    for (const opencl::DeviceInfo &device : opencl::list_devices())
      if (device.supported && device.platform_name == "Portable Computing Language") return true;
    return false;
  }();
  return found;
}

inline void require_pocl()
{
  if (!has_pocl()) ::tests::skip_device("no PoCL");
}

/* For a test that also runs on other backends: it counts as not whole without PoCL. */
inline void add_pocl(std::vector<std::string> &backends)
{
  if (has_pocl()) backends.emplace_back("cl:pocl");
  else ::tests::leave_out_device("no PoCL");
}

} // namespace tandem::parity
