/* installed_drivers.h - why no platform was found where drivers are installed: the loader of OpenCL passes over what it
 * cannot load, in silence, also where memory or descriptors are short. */
#pragma once

#include <string>

namespace tandem::opencl {

/* What kept the folder of drivers from being read, or the first of them from being loaded; empty if there is none, or
 * each loads. Drivers may end the process (probe.h). */
std::string why_drivers_do_not_load();

} // namespace tandem::opencl
