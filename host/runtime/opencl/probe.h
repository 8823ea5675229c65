/* probe.h - asks drivers in a process of its own whether they survive the question.
 *
 * Some drivers abort, or never come back, when they are asked for their devices (PoCL does without /sys, as in some
 * containers), and take the whole process with them. A child asks first, once a process, and only where OpenCL is
 * wanted at all. */
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace tandem::opencl {

/* What a question throws that the parent would not meet, or could not tell: it becomes the answer of driver_fault(). */
struct DriverFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/* Runs `ask` in a child. Empty if it came back, with or without another exception; else one line that says how the
 * driver failed, or what kept it from being asked. TANDEM_OPENCL_TIMEOUT: how many seconds it may take, 60 if not
 * given. */
std::string driver_fault(const std::function<void()> &ask);

} // namespace tandem::opencl
