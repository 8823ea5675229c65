/* embedded_kernels.h - the OpenCL programs that the library carries, one per file of cl/.
 * Written at build time by tools/embed, with every include expanded. */
#pragma once

namespace tandem {

struct EmbeddedProgram {
  const char *name;   /* "solve" for cl/solve.cl */
  const char *source; /* OpenCL C, complete */
};

extern const EmbeddedProgram embedded_programs[];
extern const unsigned embedded_program_count;

} // namespace tandem
