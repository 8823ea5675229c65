/* rounding.h - float against double, kernel by kernel, on equal input: where rounding errors are made.
 *
 *     float world   --- launch k ---> outputs in float
 *        |  its buffers, widened                |  compared, number by number
 *        v                                      v
 *     reference     --- launch k ---> outputs in double
 *
 * After each launch of a world that runs in float the same launch runs on the reference backend, on what the float
 * launch read. So each kernel's own error is seen, not what earlier ones handed on. Numbers that neither launch changed
 * are left out: a kernel writes a range of its buffers, and what lies around it would make every error look small.
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
  /* Distance from the double result in units of the last place that a float has there; 0.5 is a perfect rounding, 2^24
   * means that no digit is right. */
  double median_ulps = 0, high_ulps = 0 /* 99.9th percentile */, max_ulps = 0;
  /* The same in units of the last place of the largest number of this field in the launch: what is a difference of
   * large numbers is not held against a small result. */
  double max_field_ulps = 0;
  double max_relative = 0; /* distance / |double result| */
  double max_absolute = 0; /* distance, in the field's unit */
  uint64_t nonfinite = 0;  /* numbers that are not finite in one or both; in no other column */
};

/* Whole numbers - keys, indices, counts, flags - have no rounding: they are equal or a decision fell otherwise. */
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

/* InputError as World's constructor. */
RoundingTable measure_rounding(const Scene &scene, const RoundingRequest &request);

/* |value - exact| in units of the last place of a float as large as the larger of them. */
double ulps_from(double value, double exact);

} // namespace tandem
