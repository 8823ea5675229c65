/* changed_buffers.h - which buffers have been written since a stage on the host looked at them.
 *
 * Each read waits for the device, and a launch of solve_islands has some twenty buffers to read, eight times a step.
 * What nothing has written since the last launch is therefore not read again: that is most of it, within a step.
 */
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "host/runtime/memory.h"

namespace tandem {

/* Which buffers may have been written since they were last looked at. */
class ChangedBuffers {
public:
  ChangedBuffers() { forget_all(); }
  /* Returns whether this one may, and takes note. */
  bool take(const Memory &memory, Buffer buffer)
  {
    const uint64_t version = memory.version(buffer);
    return std::exchange(seen_[index_of(buffer)], version) != version;
  }
  void forget(Buffer buffer) { seen_[index_of(buffer)] = never; }
  void forget_all() { seen_.fill(never); }

private:
  static constexpr uint64_t never = UINT64_MAX;
  std::array<uint64_t, buffer_count> seen_;
};

} // namespace tandem
