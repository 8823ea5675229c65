/* commands.h - the calls that a program makes between two steps, as the lists that the kernels of
 * shared/commands/apply_commands.h read.
 *
 * A list is sorted by body when it is applied; calls to one body keep their order.
 */
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/runtime/launcher.h"
#include "host/runtime/memory.h"
#include "shared/platform.h"

namespace tandem {

class CommandList {
public:
  using Rows = std::array<float4, 3>; /* shared/commands/command_codes.h */

  bool empty() const { return commands_.empty(); }
  size_t size() const { return commands_.size(); }
  void clear() noexcept { commands_.clear(); }
  /* All but the first so many. */
  void drop_after(size_t first) noexcept
  {
    while (commands_.size() > first) commands_.pop_back();
  }
  /* Ensures that so many more can be added without failing. */
  void prepare(size_t more);
  /* slot: the body's index for users, because bodies may move in the buffers before the list is applied. kind:
   * COMMAND_. */
  void add(uint32_t slot, uint32_t kind, const Rows &rows) noexcept { commands_.push_back({slot, kind, rows}); }
  void add_slots_to(std::vector<uint32_t> &slots) const;
  /* Uploads the list, launches the kernels over its bodies and empties the list. If it throws, the list is as it was
   * and nothing was applied. index_of_body: in the buffers, by slot. */
  void apply(std::span<const Kernel> kernels, const std::vector<uint32_t> &index_of_body, Memory &memory,
             Launcher &launcher);

private:
  struct Command {
    uint32_t slot, kind;
    Rows rows;
  };
  uint32_t upload(const std::vector<uint32_t> &index_of_body, Memory &memory);

  std::vector<Command> commands_;
  std::vector<uint32_t> starts_, targets_;
  std::vector<float4> values_;
};

} // namespace tandem
