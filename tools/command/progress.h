/* progress.h - a progress bar for long runs. It is drawn only on a terminal, and not before a second has passed. */
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace tandem {

class Progress {
public:
  Progress(std::string what, uint64_t total);
  ~Progress() { clear(); }
  Progress(const Progress &) = delete;
  Progress &operator=(const Progress &) = delete;

  void update(uint64_t done);
  void clear(); /* removes the bar, so that the next output starts on an empty line */

private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  uint64_t total_;
  bool terminal_, drawn_ = false;
  Clock::time_point start_, last_;
};

} // namespace tandem
