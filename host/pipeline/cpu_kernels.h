/* cpu_kernels.h - CPU-only kernels, which are functions of the host: those of execution HOST in shared/kernels.def.
 *
 * They may use what shared source cannot (Eigen, allocation), and run on the CPU wherever they are placed. Their
 * results depend only on the buffers that they read, whose bits are equal on all backends, so their own bits are equal
 * too. */
#pragma once

#include <memory>

#include "host/runtime/interface/backend.h"

namespace tandem {

constexpr const char *cpu_kernels_name = "host (CPU only)";

/* Runs kernels of execution HOST, and no others. */
std::unique_ptr<Backend> make_cpu_kernels();

} // namespace tandem
