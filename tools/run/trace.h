/* trace.h - the kernels of each step as a timeline, in Chrome's trace-event JSON (chrome://tracing, Perfetto).
 *
 * There are three tracks: steps, stages, kernels (one row per backend). The trace waits for the end of each launch to
 * measure it, so a traced run is slower than a normal one.
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
  /* Observes `world` until destroyed; the world must outlive it. */
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
  size_t stage_event_ = SIZE_MAX; /* the current stage; SIZE_MAX: none */
};

} // namespace tandem
