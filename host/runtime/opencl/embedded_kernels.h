/* embedded_kernels.h - the OpenCL programs that the library carries, one per file of cl/.
 * Written at build time by tools/embed, with every include expanded. */
#pragma once

#include <vector>

namespace tandem {

struct EmbeddedEntry {
  const char *kernel; /* its name in shared/kernels.def */
  const char *source; /* OpenCL C, of this entry alone */
};

struct EmbeddedProgram {
  const char *name;                   /* "solve" for cl/solve.cl */
  const char *headers;                /* OpenCL C before the entries */
  std::vector<EmbeddedEntry> entries; /* a program of any of them is complete */
};

const std::vector<EmbeddedProgram> &embedded_programs();

} // namespace tandem
