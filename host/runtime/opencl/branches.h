/* branches.h - queues beside that of a device, for launches that need no order among each other.
 *
 *     queue      A, marker                    barrier, D
 *     branch 0            B, C, marker
 *     branch 1            E, marker
 *
 * A branch begins after all that the queue had when the first branch was opened, and keeps its own order. What the
 * queue is given next waits for all branches. The tests of pairs are such launches: those that follow few pairs to
 * their impact keep a part of a device busy for as long as the slowest pair takes, one kernel after the other.
 */
#pragma once

#include <array>
#include <cstdint>

#include "host/runtime/opencl/api.h"

namespace tandem::opencl {

/* Functions return CL_SUCCESS, or the code of what failed; then some of the work may be missing. */
class Branches {
public:
  static constexpr uint32_t most = 4;

  bool are_open() const { return start_() != nullptr; }
  /* The queue of branch number % most, which begins after what `main` has. */
  cl_int open(const cl::CommandQueue &main, uint32_t number, cl_command_queue &queue);
  cl_int join(const cl::CommandQueue &main);

private:
  cl_int mark_start(const cl::CommandQueue &main);

  struct Branch {
    cl::CommandQueue queue;
    bool is_open = false;
  };
  std::array<Branch, most> branches_;
  cl::Event start_; /* null while none is open */
};

} // namespace tandem::opencl
