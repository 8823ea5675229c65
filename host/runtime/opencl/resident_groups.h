/* resident_groups.h - the work-groups of a launch that may wait for each other, because a test showed that they run
 * together (cl/phases.cl). OpenCL alone does not promise that a group starts before another one has ended. */
#pragma once

#include <cstdint>
#include <vector>

#include "host/runtime/opencl/context.h"

namespace tandem::opencl {

/* Whether the groups of a launch can see what others write before it ends: OpenCL 3 has a fence for it. */
bool has_fence_between_groups(const DeviceContext &context);

class ResidentGroups {
public:
  /* For a kernel run_phases with this many buffers, in groups of this size: tests whether a group for each of the
   * device's compute units runs together with the others, and waits for the result. Throws cl::Error. */
  ResidentGroups(const DeviceContext &context, const cl::Kernel &kernel, size_t buffers, size_t group_size);

  /* How many run together: at least one. */
  uint32_t count() const { return count_; }
  const cl::Buffer &arrivals() const { return arrivals_; }
  /* How many groups have arrived when all launches so far have ended. */
  uint32_t arrived() const { return arrived_; }
  /* After a launch, in which all of `groups` groups meet so often. */
  void note_launch(uint32_t groups, uint32_t meetings) { arrived_ += groups * meetings; }

private:
  bool run_together(const DeviceContext &context, const cl::Kernel &kernel, size_t buffers, size_t group_size,
                    uint32_t groups);

  uint32_t count_ = 1;
  uint32_t arrived_ = 0;
  cl::Buffer arrivals_;
};

/* How often a group looks whether all have arrived before it gives up, ten seconds or more. */
constexpr cl_uint patience_of_launches = 1u << 24;

} // namespace tandem::opencl
