/* cpu_kernels.h - CPU-only kernels, which the host has in C++: those of execution HOST in shared/kernels.def.
 *
 * They may use what shared source cannot (Eigen, memory of a size that they find), and run on the CPU wherever they are
 * placed. Their results depend only on the buffers that they read, whose bits are equal on all backends, so their own
 * bits are equal too. */
#pragma once

#include <memory>

#include "host/runtime/interface/backend.h"

namespace tandem {

/* One kernel, with the memory that it keeps between launches so that a launch need not allocate. The function
 * make_name() makes the kernel `name`, as in host/pipeline/solvers/islands.h. */
class CpuKernel {
public:
  virtual ~CpuKernel() = default;
  /* It writes no buffer that its row does not name. */
  virtual void run(const Launch &launch, Memory &memory) = 0;
};

constexpr const char *cpu_kernels_name = "host (CPU only)";

/* Runs kernels of execution HOST, and no others. */
std::unique_ptr<Backend> make_cpu_kernels();

} // namespace tandem
