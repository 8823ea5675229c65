/* narrowphase.h - `tandem bench narrowphase`: manifolds per second, by the pair of shapes and by method. */
#pragma once

#include <string>
#include <vector>

#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

struct PairTime {
  std::string pair, kernel;
  std::string method; /* --narrowphase, and after a comma --support; empty for shapes with a test of their own */
  uint32_t pairs = 0, manifolds = 0, points = 0; /* manifolds: pairs with a point */
  Spread milliseconds;                           /* of the kernels alone */
};

/* Names such as box-box and hull32-hull32. */
std::vector<std::string> bench_pair_names();

/* Times `pairs` separate pairs of each kind, or of those named in `only`. Throws InputError as make_backend does. */
std::vector<PairTime> bench_narrowphase(const std::string &backend, uint32_t pairs,
                                        const std::vector<std::string> &only, bool allow_inexact);

std::string narrowphase_text(const std::vector<PairTime> &times);
Json narrowphase_json(const std::vector<PairTime> &times);

int execute_narrowphase(const BenchOptions &options);

} // namespace tandem
