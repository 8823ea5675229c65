/* rays.h - `tandem bench rays`: rays against 100,000 boxes, with the two structures that they traverse, the hierarchy
 * and the grid. */
#pragma once

#include <string>
#include <vector>

#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

struct RayTime {
  std::string structure; /* hierarchy, grid */
  std::string what;      /* nearest, blocked, or making */
  Spread milliseconds{}; /* of the kernels alone, without transfers of rays and hits */
  uint64_t hits = 0;     /* of all rays */
};

/* The boxes fill a tenth of a cube; the rays run between random points around it. */
std::vector<RayTime> bench_rays(const std::string &backend, uint32_t boxes, uint32_t rays, bool allow_inexact);

std::string rays_text(const std::vector<RayTime> &times, uint32_t rays);
Json rays_json(const std::vector<RayTime> &times, uint32_t rays);

int execute_rays(const BenchOptions &options);

} // namespace tandem
