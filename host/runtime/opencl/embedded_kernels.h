/* embedded_kernels.h - the OpenCL programs of the pipeline, one per file of cl/, as tools/embed wrote them. */
#pragma once

#include <vector>

#include "host/runtime/interface/embedded_program.h"

namespace tandem {

const std::vector<EmbeddedProgram> &embedded_programs();

} // namespace tandem
