/* trace.h - the kernels of each step as a time line, in Chrome's trace-event JSON (chrome://tracing, Perfetto).
 *
 * Three tracks: steps, stages, kernels (one row per backend). To know when a launch ends the trace waits for
 * it, so a traced run is slower than a plain one.
 */
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <tandem/world.h>

namespace tandem {

class Trace {
public:
  /* Observes `world` until destroyed, which must be before the world is. */
  explicit Trace(World &world);
  ~Trace();
  Trace(const Trace &) = delete;
  Trace &operator=(const Trace &) = delete;

  void begin_step();
  void end_step(uint64_t step);
  std::string json() const;

private:
  struct Event {
    std::string name, category;
    uint32_t track;
    double start, duration; /* microseconds */
    uint64_t step;
  };
  void record(const Launch &launch);
  double now() const;
  uint32_t track_of(const std::string &backend);

  World &world_;
  std::chrono::steady_clock::time_point origin_;
  double step_start_ = 0, launch_start_ = 0;
  uint64_t step_ = 0;
  std::map<std::string, uint32_t> tracks_;
  std::vector<Event> events_;
  size_t stage_event_ = SIZE_MAX; /* the stage that is going on; SIZE_MAX: none */
};

} // namespace tandem
