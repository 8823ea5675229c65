/* step_buffers.h - the room for a world's buffers: of which there is any, how much, and on which backends.
 *
 * A dry run of the step tells which kernels it launches and which buffers they touch; the others take no memory. Room
 * is made before a step begins, so that a step that has begun does not run out of memory.
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

namespace tandem {

class StepBuffers {
public:
  /* What the present plan of the step launches and touches. */
  struct Needs {
    std::vector<Kernel> kernels;
    std::vector<bool> touched;                /* by the buffer's number */
    std::set<std::pair<Kernel, Buffer>> uses; /* the same, by which kernel */
  };

  StepBuffers(Memory &memory, PlacedBackends &backends) : memory_(memory), backends_(backends) {}

  const Needs &needs() const { return needs_; }
  void take_needs(Recorder recorder);
  void give_back_needs(Needs before); /* where there was no room for others */

  /* InputError where kernels cannot number so many elements; OutOfMemory leaves the contents that are carried over. */
  void allocate(const Sizes &sizes);
  /* Room wherever the kernels that use a buffer run; nothing to do unless something changed. */
  void make_ready(const Sizes &sizes);
  void changed() { ready_ = false; }
  /* For queries between steps, of a buffer that the step itself may not have. */
  void ensure_capacity(Buffer buffer, const Sizes &sizes);
  bool is_queried(Buffer buffer) const { return queried_[index_of(buffer)]; }

  const std::vector<CarriedBuffer> &carried() const { return carried_; }

private:
  size_t wanted_bytes(Buffer buffer, const Sizes &sizes) const;
  void settle(Backend &backend);

  Memory &memory_;
  PlacedBackends &backends_;
  std::vector<CarriedBuffer> carried_ = carried_buffers();
  Needs needs_;
  std::vector<bool> queried_ = std::vector<bool>(all_buffers()); /* by the structure that queries walk */
  bool ready_ = false;
};

/* A buffer of a module whose room is what was last written: the pipeline's of capacity NOTHING are sized by each batch
 * of queries. */
bool is_sized_by_writes(Buffer buffer);

} // namespace tandem
