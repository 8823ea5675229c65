/* backend.h - what runs the kernels of a world: a backend is named by a text, as on the command line.
 *
 *   serial[:order=backward]             one item after the other, on one thread
 *   tbb[:threads=N,lanes=1|4|8|16]      threads and lanes of the CPU; all that it has unless N is said
 *   cl[:P.D], cl:part-of-a-name         an OpenCL device: the first one, by its numbers, or by its name
 *   reference[:threads=N]               the same kernels in double, for measuring errors
 *
 * All but the last have the same bits, so that any stage of any step may run on any of them.
 */
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <tandem/export.h>

namespace tandem {

/* Which backend runs what: one for all, and exceptions by stage ("narrowphase") or kernel name. */
struct Placement {
  std::string on = "tbb";
  std::vector<std::pair<std::string, std::string>> exceptions; /* STAGE-or-kernel, backend */
  bool allow_inexact = false;                                  /* accept a device whose results may differ in bits */
};

/* "STAGE=B,STAGE=B": a part without '=' continues the backend before it (tbb:threads=2,lanes=4 has '='
 * too, so its options are told apart by their names). InputError on unknown stages. */
TANDEM_API std::vector<std::pair<std::string, std::string>> parse_placement(const std::string &text);

} // namespace tandem
