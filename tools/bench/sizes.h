/* sizes.h - `tandem bench sizes`: a step of one scene at sizes from 8 boxes to millions, drawn beside other runs.
 *
 * The scene is a cube of boxes, `box-grid:nx=N,ny=N,nz=N`, whose error is shown beside its time: a solver that leaves
 * more penetration has done less work. Runs of other backends and of other engines are read from files of the same
 * form as the command's own JSON:
 *
 *   {"what": "sizes", "name": "box3d, 16 threads", "sizes": [{"bodies": 1000, "ms": {"median": 1.27}, ...}, ...]}
 */
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

struct SizeTime {
  uint64_t bodies = 0;                       /* that move */
  Spread milliseconds;                       /* of a step */
  std::optional<double> deepest, mean_depth; /* penetration in the end, m: the greatest, the mean over the points */
};

struct SizesRun {
  std::string name; /* of the line in the chart */
  std::vector<SizeTime> sizes;
};

constexpr uint64_t most_of_sizes = 64000; /* unless asked for: minutes on two cores */

/* Sizes of at most `most` boxes; the smallest is 8. */
std::vector<SizeTime> bench_sizes(const Placement &placement, uint64_t most);

/* Throws InputError that names the file and what it lacks. */
SizesRun read_sizes(const std::string &path);

/* The time of each run at each size that one of them has, and the error of the first. */
std::string sizes_text(const std::vector<SizesRun> &runs);
Json sizes_json(const SizesRun &run); /* of one that was made here */
std::string sizes_chart(const std::vector<SizesRun> &runs);

int execute_sizes(const BenchOptions &options);

} // namespace tandem
