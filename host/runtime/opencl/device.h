/* device.h - OpenCL platforms and devices: what is there, what each lacks, which one a text means.
 *
 * A device is trusted when its self-test gives the host's bits (docs/exactness.md). What its driver promises
 * (denormals, correctly rounded division and square root) chooses the compiler's options and explains a
 * failure, but does not decide: some drivers promise less than they do.
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
  std::string reason; /* why not; or, of a supported device, what only its self-test vouches for */
};

/* Every device of every platform, each with the verdict of its self-test. Empty without any platform. DeviceError (a
 * std::runtime_error) where a driver does not survive the question. */
std::vector<DeviceInfo> list_devices();

/* Empty if this program's own arithmetic, which MiniCL runs and devices are measured by, rounds as IEEE 754 says;
 * else what does not (a compiler option or a library changed it). */
std::string host_self_test();

/* `choice`: "" the best supported device, "P.D" platform and device number, or part of a platform's, a device's or a
 * type's name, in any case ("pocl" too): the first supported match. `text` is the whole name for messages.
 * InputError: no platform, no such device, or one that cannot give the host's bits (unless allow_inexact). */
std::unique_ptr<Backend> make_backend(const std::string &text, const std::string &choice, bool allow_inexact);

} // namespace tandem::opencl
