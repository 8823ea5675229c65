/* entries.h - the OpenCL entry of a kernel: its parameters, and the call of the shared function for each item or
 * group. */
#pragma once

#include <string>

#include "tools/embed/list_rows.h"

namespace embed {

/* The entry in OpenCL C, after a #line directive that names the kernel's row in this list. */
std::string entry_of(const KernelRow &row, const std::string &list);

/* The same call for a program of phases (cl/phases.cl), which has parameters of its own: $0, $1 .. stand for those of
 * the row, in its order. */
std::string call_of(const KernelRow &row);

} // namespace embed
