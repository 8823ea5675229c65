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

/* Functions return CL_SUCCESS, or the code of what failed, and throw nothing. */
class Branches {
public:
  static constexpr uint32_t most = 4;

  Branches() = default;
  Branches(const Branches &) = delete;
  Branches &operator=(const Branches &) = delete;
  ~Branches();

  bool are_open() const { return start_ != nullptr; }
  /* The queue of branch number % most, which begins after what `main` has. */
  cl_int open(cl_command_queue main, uint32_t number, cl_command_queue &queue);
  /* Closes all branches; if it fails, after their work is done. */
  cl_int join(cl_command_queue main);

private:
  struct Branch {
    cl_command_queue queue = nullptr;
    bool is_open = false;
  };
  cl_int mark_start(cl_command_queue main);
  cl_int wait_for_branches(cl_command_queue main);
  void close();

  std::array<Branch, most> branches_;
  cl_event start_ = nullptr; /* null while none is open */
};

} // namespace tandem::opencl
