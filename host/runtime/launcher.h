/* launcher.h - accepts launches, selects their backend, and moves the buffers they need there.
 *
 * Placement is applied here alone: step.cpp and the primitives only name kernels.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <tandem/export.h>

#include "host/runtime/interface/backend.h"
#include "host/runtime/memory.h"

namespace tandem {

class TANDEM_API Launcher {
public:
  virtual ~Launcher() = default;
  virtual void launch(const Launch &launch) = 0;
  /* Marks the point from which on launches write the state that the next step starts from (host/world/carried.h). */
  virtual void begin_commit() {}
  /* The size of a buffer where launches run, and unlimited where they are only recorded. */
  virtual size_t bytes(Buffer) const { return SIZE_MAX; }
};

/* Is told of each launch before its buffers move. */
class TANDEM_API LaunchParts : public UsedParts {
public:
  virtual void begin_launch(const Launch &launch) = 0;
};

class TANDEM_API PlacedLauncher : public Launcher {
public:
  using Choice = std::function<Backend &(Kernel)>;
  using Observer = std::function<void(const Launch &)>;

  PlacedLauncher(Memory &memory, Choice choice) : memory_(memory), choice_(std::move(choice)) {}
  void launch(const Launch &launch) override;
  void begin_commit() override
  {
    run_collected();
    written_.clear();
    if (on_commit_) on_commit_();
  }
  /* Calls a function that launches kernels and does nothing else to the memory. Those of few items, as far as `known`
   * tells, which holds an estimate of each entry of counts, reach their backend in series; if it is empty, none do. */
  void launch_in_series(std::span<const uint32_t> known, const std::function<void()> &launches);
  size_t bytes(Buffer buffer) const override { return memory_.bytes(buffer); }
  /* Buffers of modules other than the pipeline that launches have written since the last begin_commit. */
  const std::vector<Buffer> &written_by_modules() const { return written_; }
  void set_observer(Observer observer) { observer_ = std::move(observer); }
  const Observer &observer() const { return observer_; }
  void set_on_commit(std::function<void()> on_commit) { on_commit_ = std::move(on_commit); }
  /* While some bodies sleep, launches leave their rows of STATE buffers as they are, wherever they are placed. */
  void set_keeps_sleepers(bool on) { keeps_sleepers_ = on; }
  /* Of buffers that move, launches move these parts; null: all of them. An observer compares whole buffers, so while
   * there is one they move whole. */
  void set_parts(LaunchParts *parts) { parts_ = parts; }
  void set_step(uint64_t step) { step_ = step; } /* for debuggers: host/runtime/interface/debug.h */

private:
  Memory &memory_;
  Choice choice_;
  Observer observer_;
  std::function<void()> on_commit_;
  uint64_t step_ = 0;
  bool keeps_sleepers_ = false;
  void note_written(Buffer buffer);
  Access access_of(Buffer buffer, Access access) const;
  void bind(const Launch &launch, Storage &storage, std::vector<BoundArgument> &bound);
  bool joins_series(const Launch &launch, const Backend &backend) const;
  void make_room(size_t launches);
  void collect(const Launch &launch, Backend &backend);
  void run_collected();

  std::span<const uint32_t> known_;    /* empty outside of launch_in_series */
  std::vector<BoundLaunch> collected_; /* the first collected_count_ wait for collecting_backend_ */
  size_t collected_count_ = 0;
  Backend *collecting_backend_ = nullptr;
  LaunchParts *parts_ = nullptr;
  std::vector<BoundArgument> bound_;
  std::vector<Buffer> written_;
};

/* Runs everything on one backend, for tests and benchmarks of single kernels. */
class DirectLauncher : public PlacedLauncher {
public:
  DirectLauncher(Memory &memory, Backend &backend)
      : PlacedLauncher(memory, [&backend](Kernel) -> Backend & { return backend; })
  {}
};

} // namespace tandem
