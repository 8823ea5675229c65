/* measure.h - runs a world, or a batch of worlds, for some steps and times them. `Steps` is World or Worlds.
 *
 *   steps   0 ....... N/2 ..........................  N - 1
 *           warm-up    timed, timed, ..., profiled (every 8th, left out of step_ms), timed ...
 *
 * The clock is read with all devices finished. Measuring single kernels slows launches, so the steps that
 * are profiled are not those that are timed.
 */
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <tandem/world.h>
#include <tandem/worlds.h>

#include "tools/command/output.h"

namespace tandem {

struct Spread {
  double median = 0, minimum = 0, maximum = 0;
};
Spread spread_of(std::vector<double> values); /* zeros if there are no values */
Json spread_json(const Spread &spread);

struct StageTime {
  std::string name;
  std::string backend;
  double milliseconds = 0; /* per step */
};

struct Measurement {
  Spread step_milliseconds;
  std::vector<StageTime> stages; /* in pipeline order */
  uint64_t timed_steps = 0, profiled_steps = 0;
  /* Of a timed step, on average: */
  double launches = 0;
  double bytes_moved = 0;  /* between memories of backends */
  double device_reads = 0; /* by the host, which waits each time */
};

/* Builds before what a long run builds while it runs, so that no timed step waits for it. Goes on without kernels that
 * cannot be built, and says so. */
template <class Steps> void prepare_for_timing(Steps &world);

/* The time of one step in ms; the clock is read with all devices finished. */
template <class Steps> double timed_step(Steps &world);

/* `after_step(done)` is called outside of the timed span. */
template <class Steps>
Measurement measure(Steps &world, uint64_t steps, const std::function<void(uint64_t done)> &after_step);

} // namespace tandem
