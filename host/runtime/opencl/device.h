/* device.h - OpenCL platforms and devices: which there are, what each lacks, and which one a text names.
 *
 * A device is accepted if its self-test computes the host's bits (docs/exactness.md). What its driver promises
 * (denormals, correctly rounded division and square root) selects the compiler's options and explains a failure, but
 * does not decide: some drivers promise less than they do.
 */
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host/runtime/interface/backend.h"

namespace tandem::opencl {

struct DeviceInfo {
  uint32_t platform = 0, device = 0; /* as in "cl:P.D" */
  std::string platform_name, platform_version, device_name, driver_version;
  std::string type; /* "GPU", "accelerator" or "CPU" */
  bool supported = false;
  std::string reason; /* why not; of a supported device, the properties that only its self-test confirms */
};

/* Every device of every platform, each with the result of its self-test; empty if there is no platform. Throws
 * DeviceError (a std::runtime_error) if a driver crashes or hangs when it is queried. */
std::vector<DeviceInfo> list_devices();

/* Empty if this program's own arithmetic, which MiniCL runs and to which devices are compared, rounds as IEEE 754
 * requires; else what does not (a compiler option or a library changed it). */
std::string host_self_test();

/* `choice` is "" for the best supported device, "P.D" for platform and device number, or part of the name of a
 * platform, device or type, in any case ("pocl" too), which selects the first supported match. `text` is the whole name
 * for messages. Throws InputError if there is no platform or no such device, or the device does not compute the host's
 * bits (unless allow_inexact). */
std::unique_ptr<Backend> make_backend(const std::string &text, const std::string &choice, bool allow_inexact);

} // namespace tandem::opencl
