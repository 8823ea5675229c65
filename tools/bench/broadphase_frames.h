/* broadphase_frames.h - runs one broadphase by itself, frame after frame, for `tandem bench broadphase`.
 *
 *    bodies move, begin_step, compute_bounds | broadphase, and its commit if it has one | counts to the host
 *                                             <------------- the time of a frame ---------->
 *
 * Only the buffers and kernels of a broadphase are allocated, so that there is memory for millions of bodies when a
 * whole step would not fit.
 */
#pragma once

#include <array>
#include <vector>

#include "host/pipeline/broadphases/broadphase.h"
#include "tools/bench/broadphase_inputs.h"

namespace tandem {

class BroadphaseFrames {
public:
  /* All three references must outlive this object. `pairs`: the first capacity; 0: that of a world. */
  BroadphaseFrames(const MovingBodies &bodies, const BroadphaseRow &broadphase, Backend &backend, uint32_t pairs = 0);
  ~BroadphaseFrames() { backend_.finish(); }

  /* Returns milliseconds; the clock is read with the backend finished. A frame that finds more pairs than fit runs
   * again with larger buffers, and the time is that of the last run. Frames must be run in order: 0, 1, 2, ... */
  double run(uint32_t frame);

  /* Of the last frame: */
  uint32_t pairs() const { return plan_.known[COUNT_PAIRS]; }
  uint64_t hash(); /* of the pair list and of where each body's pairs start */
  Memory &memory() { return memory_; }

private:
  void record_kernels();
  void allocate();
  void upload();
  void guess_counts();
  void move_bodies(uint32_t frame);
  double find_pairs();
  void grow(uint32_t pairs, uint32_t candidates);

  const MovingBodies &bodies_;
  const BroadphaseRow &broadphase_;
  Backend &backend_;
  Settings settings_;
  StepPlan plan_;
  std::vector<Kernel> kernels_;
  std::vector<bool> touched_;
  Memory memory_;
  DirectLauncher launcher_{memory_, backend_};
  StepLaunches step_{launcher_, plan_, settings_};
};

} // namespace tandem
