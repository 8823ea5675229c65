/* progress.cpp - draws and clears the bar; see progress.h. */
#include "tools/command/progress.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace tandem {

Progress::Progress(std::string what, uint64_t total)
    : what_(std::move(what)), total_(total), terminal_(isatty(STDERR_FILENO)), start_(Clock::now()), last_(start_)
{}

void Progress::update(uint64_t done)
{
  if (!terminal_ || done == 0) return;
  const Clock::time_point now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  if (elapsed < 1.0 || (drawn_ && now - last_ < std::chrono::milliseconds(100))) return;
  last_ = now;
  drawn_ = true;
  const double share = static_cast<double>(done) / static_cast<double>(total_);
  const int filled = static_cast<int>(share * 30);
  fmt::print(stderr, "\r{} [{:=<{}}{:{}}] {}/{}, {:.0f} s left \033[K", what_, "", filled, "", 30 - filled, done,
             total_, elapsed / share - elapsed);
  std::fflush(stderr);
}

void Progress::clear()
{
  if (drawn_) fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

} // namespace tandem
