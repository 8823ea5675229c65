/* probe.h - queries drivers in a child process, to find out whether they survive it.
 *
 * Some drivers abort or hang when they are queried for their devices (PoCL does without /sys, as in some containers),
 * and would take the whole process with them. A child therefore queries them first, once per process, and only if
 * OpenCL is used at all. */
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace tandem::opencl {

/* Thrown by a query for a fault that the parent would not meet, or could not report; its text becomes the result of
 * driver_fault(). */
struct DriverFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* Runs `ask` in a child. The result is empty if `ask` returned, with or without another exception; else one line that
 * says how the driver failed, or why it could not be queried. TANDEM_OPENCL_TIMEOUT is the limit in seconds, 60 by
 * default. */
std::string driver_fault(const std::function<void()> &ask);

} // namespace tandem::opencl
