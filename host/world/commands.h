/* commands.h - the calls that a program makes between two steps, as the lists that the kernels of
 * shared/commands/apply_commands.h read.
 *
 * A list is sorted by body when it is applied; calls to one body keep their order.
 */
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/runtime/launcher.h"
#include "host/runtime/memory.h"
#include "shared/platform.h"

namespace tandem {

class CommandList {
public:
  using Rows = std::array<float4, 3>; /* shared/commands/command_codes.h */

  bool empty() const { return commands_.empty(); }
  void clear() noexcept { commands_.clear(); }
  /* Ensures that so many more can be added without failing. */
  void prepare(size_t more);
  /* body: its index in the buffers. kind: COMMAND_. */
  void add(uint32_t body, uint32_t kind, const Rows &rows) noexcept { commands_.push_back({body, kind, rows}); }
  /* Uploads the list, launches the kernel over its bodies and empties the list. If it throws, the list is as it was and
   * nothing was applied. */
  void apply(Kernel kernel, Memory &memory, Launcher &launcher);

private:
  struct Command {
    uint32_t body, kind;
    Rows rows;
  };
  uint32_t upload(Memory &memory);

  std::vector<Command> commands_;
  std::vector<uint32_t> starts_, targets_;
  std::vector<float4> values_;
};

} // namespace tandem
