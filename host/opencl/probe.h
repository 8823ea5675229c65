/* probe.h - asks drivers in a process of its own whether they survive the question.
 *
 * Some drivers abort, or never come back, when they are asked for their devices (PoCL does without /sys, as in some containers), and
 * take the whole process with them. A child asks first, once a process, and only where OpenCL is wanted at all. */
#pragma once

#include <functional>
#include <string>

namespace tandem::opencl {

/* Runs `ask` in a child. Empty if it came back, with or without an exception; else one line that says how the driver failed.
 * TANDEM_OPENCL_TIMEOUT: how many seconds it may take, 60 if not given. */
std::string driver_fault(const std::function<void()> &ask);

} // namespace tandem::opencl
