/* support.h - `tandem bench support`: the ways to a hull's farthest vertex, how long each takes and how far off
 * the cube map is. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/command/output.h"

namespace tandem {

/* One hull under one cube map. Errors: by how much the vertex named is lower than the highest, in parts of the height
 * that the hull has in that direction (its extent from one side to the other), over `directions` random ones. */
struct SupportTime {
  uint32_t vertices = 0, cells = 0, bytes = 0; /* bytes: of the map */
  uint64_t directions = 0;
  double largest_error = 0, error_999 = 0,
         share_wrong = 0; /* 99.9th percentile; share of directions with another vertex */
  double brute_force = 0, hill_climbing = 0, cube_map = 0; /* ns a direction, on one thread without AVX2 */
  uint64_t differences = 0;                                /* of hill climbing from brute force: none, or it is wrong */
};

std::vector<SupportTime> bench_support(uint64_t directions);
std::string support_text(const std::vector<SupportTime> &times);
Json support_json(const std::vector<SupportTime> &times);

} // namespace tandem
