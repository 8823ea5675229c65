/* support.h - `tandem bench support`: the support functions of hulls, with the time of each and the error of the cube
 * map. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/options.h"
#include "tools/command/output.h"

namespace tandem {

/* One hull with one cube map. The error of a direction is the height by which the vertex found is below the highest
 * one, relative to the hull's extent in that direction; it is measured over `directions` random directions. */
struct SupportTime {
  uint32_t vertices = 0, cells = 0, bytes = 0; /* bytes: of the map */
  uint64_t directions = 0;
  double largest_error = 0, error_999 = 0,
         share_wrong = 0; /* 99.9th percentile; share of directions with a wrong vertex */
  double brute_force = 0, hill_climbing = 0, cube_map = 0; /* ns a direction, on one thread without AVX2 */
  uint64_t differences = 0;                                /* between hill climbing and brute force; must be 0 */
};

std::vector<SupportTime> bench_support(uint64_t directions);
std::string support_text(const std::vector<SupportTime> &times);
Json support_json(const std::vector<SupportTime> &times);

/* The exit status is 1 if hill climbing ever ends at another vertex. */
int execute_support(const BenchOptions &options);

} // namespace tandem
