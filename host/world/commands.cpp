/* commands.cpp - sorts calls by body and hands them to the kernels; see commands.h. */
#include "host/world/commands.h"

#include <algorithm>

#include "host/base/reserve_more.h"
#include "host/pipeline/scene_counts.h"
#include "shared/counts.h"

namespace tandem {
namespace {

/* Buffers of commands keep the size of the largest list, so that steps with fewer calls allocate nothing. */
template <class T> void upload_list(Memory &memory, Buffer buffer, const std::vector<T> &values)
{
  const size_t bytes = values.size() * sizeof(T);
  if (memory.bytes(buffer) < bytes) memory.resize(buffer, bytes + bytes / 2);
  memory.upload(buffer, values.data(), bytes);
}

} // namespace

void CommandList::prepare(size_t more) { reserve_more(commands_, more); }

/* Returns the number of bodies that have commands. */
uint32_t CommandList::upload(const std::vector<uint32_t> &index_of_body, Memory &memory)
{
  std::stable_sort(commands_.begin(), commands_.end(), [&](const Command &one, const Command &other) {
    return index_of_body[one.slot] < index_of_body[other.slot];
  });
  starts_.clear(), targets_.clear(), values_.clear();
  for (const Command &command : commands_) {
    const auto place = static_cast<uint32_t>(targets_.size() / 2);
    const uint32_t body = index_of_body[command.slot];
    if (place == 0 || targets_[2 * place - 2] != body) starts_.push_back(place);
    targets_.insert(targets_.end(), {body, command.kind});
    values_.insert(values_.end(), command.rows.begin(), command.rows.end());
  }
  starts_.push_back(static_cast<uint32_t>(commands_.size()));
  upload_list(memory, Buffer::command_start, starts_);
  upload_list(memory, Buffer::command, targets_);
  upload_list(memory, Buffer::command_value, values_);
  return static_cast<uint32_t>(starts_.size() - 1);
}

void CommandList::add_slots_to(std::vector<uint32_t> &slots) const
{
  for (const Command &command : commands_) slots.push_back(command.slot);
}

void CommandList::apply(std::span<const Kernel> kernels, const std::vector<uint32_t> &index_of_body, Memory &memory,
                        Launcher &launcher)
{
  if (commands_.empty()) return;
  const uint32_t bodies = upload(index_of_body, memory);
  set_length(memory, bodies);
  for (const Kernel kernel : kernels) launcher.launch({kernel, {}, {}, COUNT_ZERO, COUNT_LENGTH, bodies});
  commands_.clear();
}

} // namespace tandem
