/* step_buffers.h - the memory for a world's buffers: which of them exist, how large they are, and on which backends.
 *
 * A dry run of the step records which kernels it launches and which buffers they touch; the others take no memory.
 * Memory is allocated before a step begins, so that a step in progress does not run out of it. Buffers whose contents
 * matter at different times of a step lie in the same memory (host/world/shared_memory.h).
 */
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "host/pipeline/layout.h"
#include "host/runtime/memory.h"
#include "host/runtime/recorder.h"
#include "host/world/carried.h"
#include "host/world/placed_backends.h"
#include "host/world/shared_memory.h"

namespace tandem {

class StepBuffers {
public:
  /* What the present plan of the step launches and touches. */
  struct Needs {
    std::vector<Kernel> kernels;
    std::vector<bool> touched;                /* by the buffer's number */
    std::set<std::pair<Kernel, Buffer>> uses; /* the same, by kernel */
    StepSpans spans;
  };

  StepBuffers(Memory &memory, PlacedBackends &backends) : memory_(memory), backends_(backends) {}

  const Needs &needs() const { return needs_; }
  void take_needs(Recorder recorder);
  void give_back_needs(Needs before); /* if there was no memory for others */

  /* Throws InputError if kernels cannot index so many elements. If it throws OutOfMemory, the carried contents are
   * unchanged. */
  void allocate(const Sizes &sizes);
  /* Allocates each buffer on the backends whose kernels use it; does nothing unless something changed. */
  void make_ready(const Sizes &sizes);
  /* How often buffers were allocated so far: what scratch held, in which programs may keep lists, is lost then. */
  uint64_t allocations() const { return allocations_; }
  void changed() { ready_ = false; }
  /* Whether buffers share memory. Where they do not, all of them hold what they were last given. */
  void set_sharing(bool on)
  {
    if (std::exchange(shares_, on) != on) changed();
  }
  /* The buffer shares its memory with none. */
  void keep_after_steps(Buffer buffer);
  void keep_after_steps_as(const StepBuffers &other);
  /* What a step has left in scratch need not follow the kernels that write it anew. */
  void forget_scratch();
  /* Allocates a buffer for queries between steps, which the step itself may not have. */
  void ensure_capacity(Buffer buffer, const Sizes &sizes);
  bool is_queried(Buffer buffer) const { return queried_[index_of(buffer)]; }

  const std::vector<CarriedBuffer> &carried() const { return carried_; }

private:
  std::vector<bool> apart() const;
  size_t wanted_bytes(Buffer buffer, const Sizes &sizes) const;
  size_t written_bytes(Buffer buffer, const Sizes &sizes) const;
  void settle(Backend &backend);
  void reserve_both_sides(const CarriedBuffer &buffer, Storage &storage);

  Memory &memory_;
  PlacedBackends &backends_;
  std::vector<CarriedBuffer> carried_ = carried_buffers();
  Needs needs_;
  std::vector<bool> queried_ = std::vector<bool>(all_buffers()); /* used by the structure that queries traverse */
  std::vector<bool> kept_ = std::vector<bool>(all_buffers());    /* after steps, for whoever reads them */
  bool ready_ = false, shares_ = true;
  uint64_t allocations_ = 0;
};

/* A module's buffer whose size is that of the last write; the pipeline's buffers of capacity NOTHING are sized by each
 * batch of queries. */
bool is_sized_by_writes(Buffer buffer);

} // namespace tandem
