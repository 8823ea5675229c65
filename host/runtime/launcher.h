/* launcher.h - accepts launches, selects their backend, and moves the buffers they need there.
 *
 * Placement is applied here alone: step.cpp and the primitives only name kernels.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

class TANDEM_API PlacedLauncher : public Launcher {
public:
  using Choice = std::function<Backend &(Kernel)>;
  using Observer = std::function<void(const Launch &)>;

  PlacedLauncher(Memory &memory, Choice choice) : memory_(memory), choice_(std::move(choice)) {}
  void launch(const Launch &launch) override;
  void begin_commit() override
  {
    written_.clear();
    if (on_commit_) on_commit_();
  }
  size_t bytes(Buffer buffer) const override { return memory_.bytes(buffer); }
  /* Buffers of modules other than the pipeline that launches have written since the last begin_commit. */
  const std::vector<Buffer> &written_by_modules() const { return written_; }
  void set_observer(Observer observer) { observer_ = std::move(observer); }
  const Observer &observer() const { return observer_; }
  void set_on_commit(std::function<void()> on_commit) { on_commit_ = std::move(on_commit); }
  void set_step(uint64_t step) { step_ = step; } /* for debuggers: host/runtime/interface/debug.h */

private:
  Memory &memory_;
  Choice choice_;
  Observer observer_;
  std::function<void()> on_commit_;
  uint64_t step_ = 0;
  void note_written(Buffer buffer);

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
