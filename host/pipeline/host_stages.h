/* host_stages.h - stages that are functions of the host: kernels of form HOST in shared/kernels.def.
 *
 * They may use what shared source cannot (Eigen, allocation), and run on the CPU wherever they are placed. Their
 * results depend only on the buffers they read, whose bits are equal everywhere, so theirs are too. */
#pragma once

#include <memory>

#include "host/runtime/interface/backend.h"

namespace tandem {

constexpr const char *host_stages_name = "host (CPU only)";

/* Runs kernels of form HOST, and no others. */
std::unique_ptr<Backend> make_host_stages();

} // namespace tandem
