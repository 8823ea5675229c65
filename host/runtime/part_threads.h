/* part_threads.h - threads for parts that are long, and that the same thread had better take again and again: groups of
 * worlds (host/world/worlds.h), whose numbers stay in its cache.
 *
 *   phase 0, parts 0 to 7     thread 0   [0][1][2]      [5] |      phase 1 begins when all parts of phase 0 have ended
 *                             thread 1   [4]....[6][7]  [3] |      [4][5][6][7]
 *
 * Each thread has a block of the parts. It takes those of others when its own are done.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "host/base/parts.h"

namespace tandem {

/* Parts that run one phase after another. */
class PhasesOfParts {
public:
  virtual ~PhasesOfParts() = default;
  virtual size_t phases() const = 0;
  /* It is asked when all phases before this one have ended. If it throws, no part of this phase runs. */
  virtual size_t parts_of(size_t phase) = 0;
  virtual void run(size_t phase, size_t part) = 0;
};

class PartThreads {
public:
  explicit PartThreads(uint32_t threads);
  PartThreads(PartThreads &&) noexcept;
  PartThreads &operator=(PartThreads &&) noexcept;
  ~PartThreads();

  /* If parts throw, all others of the phase have run, and no later phase does. The exception of the lowest part leaves
   * the call. */
  void run(PhasesOfParts &phases);
  /* The same for one phase. */
  void run(size_t parts, PartFunction function);

private:
  class Team;
  uint32_t threads_;
  std::unique_ptr<Team> team_; /* null: it has not been needed yet */
};

} // namespace tandem
