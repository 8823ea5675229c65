/* rounding.h - compares float with double, kernel by kernel, on equal input, to find where rounding errors arise.
 *
 *     float world   --- launch k ---> outputs in float
 *        |  its buffers, widened                |  compared, number by number
 *        v                                      v
 *     reference     --- launch k ---> outputs in double
 *
 * After each launch of a world that runs in float, the same launch runs on the reference backend with the inputs of the
 * float launch. The result is each kernel's own error, without those of earlier kernels. Numbers that neither launch
 * changed are omitted: a kernel writes a range of its buffers, and the numbers around it would make every error look
 * small.
 */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "host/runtime/interface/kernel_list.h"

namespace tandem {

struct RoundingRequest {
  Settings settings;
  Placement placement{"serial", {}, false};
  uint64_t steps = 30;
  uint64_t every = 5; /* steps 0, every, 2 every, ... are compared; all are run */
};

/* One field of one buffer that one kernel writes; planes of a buffer count as one field. */
struct RoundingRow {
  Kernel kernel;
  Buffer buffer;
  std::string field;
  uint64_t numbers = 0; /* compared */
  /* Distance from the double result in units in the last place of a float of that size; 0.5 is a correct rounding, 2^24
   * means that no digit is correct. */
  double median_ulps = 0, high_ulps = 0 /* 99.9th percentile */, max_ulps = 0;
  /* The same in units in the last place of the largest number of this field in the launch, so that cancellation of
   * large numbers does not count against a small result. */
  double max_field_ulps = 0;
  double max_relative = 0; /* distance / |double result| */
  double max_absolute = 0; /* distance, in the field's unit */
  uint64_t nonfinite = 0;  /* numbers that are not finite in one or both; in no other column */
};

/* Integers - keys, indices, counts, flags - have no rounding: they are equal, or a decision differed. */
struct DecisionRow {
  Kernel kernel;
  Buffer buffer;
  uint64_t numbers = 0, differing = 0;
};

struct RoundingTable {
  std::vector<RoundingRow> rows; /* pipeline order */
  std::vector<DecisionRow> decisions;
  uint64_t launches = 0; /* compared */
};

/* Throws InputError as World's constructor does. */
RoundingTable measure_rounding(const Scene &scene, const RoundingRequest &request);

/* |value - exact| in units in the last place of a float as large as the larger of the two. */
double ulps_from(double value, double exact);

} // namespace tandem
