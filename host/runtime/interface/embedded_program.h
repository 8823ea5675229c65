/* embedded_program.h - an OpenCL program that a library contains as text: one per stage, with every include expanded.
 *
 * tools/embed writes the text at build time, for the pipeline's stages and for those of other modules.
 */
#pragma once

#include <vector>

namespace tandem {

struct EmbeddedEntry {
  const char *kernel;      /* its name in the list of kernels */
  const char *source;      /* OpenCL C, of this entry alone */
  const char *call;        /* of its shared function, with $0, $1 .. for the arguments of its row: cl/phases.cl */
  const char *local_words; /* the size of its local memory; empty for kernels without groups */
};

struct EmbeddedProgram {
  const char *name;                   /* "solve" for cl/solve.cl */
  std::vector<const char *> headers;  /* OpenCL C before the entries: pieces, which programs share */
  std::vector<EmbeddedEntry> entries; /* any subset of them makes a complete program */
};

} // namespace tandem
