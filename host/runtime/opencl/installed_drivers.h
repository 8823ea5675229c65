/* installed_drivers.h - finds out why no platform was found although drivers are installed. The OpenCL loader silently
 * skips a driver that it cannot load, even if only memory or file descriptors are short. */
#pragma once

#include <string>

namespace tandem::opencl {

/* The reason why the folder of drivers cannot be read, or why the first driver that fails does not load; empty if no
 * driver is installed or each loads. Drivers may end the process (probe.h). */
std::string why_drivers_do_not_load();

} // namespace tandem::opencl
