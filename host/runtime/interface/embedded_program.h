/* embedded_program.h - an OpenCL program that a library carries as text: one per stage, with every include expanded.
 *
 * tools/embed writes the text at build time, of the pipeline's stages as of those of other modules.
 */
#pragma once

#include <vector>

namespace tandem {

struct EmbeddedEntry {
  const char *kernel; /* its name in the list of kernels */
  const char *source; /* OpenCL C, of this entry alone */
};

struct EmbeddedProgram {
  const char *name;                   /* "solve" for cl/solve.cl */
  const char *headers;                /* OpenCL C before the entries */
  std::vector<EmbeddedEntry> entries; /* a program of any of them is complete */
};

} // namespace tandem
