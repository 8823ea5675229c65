/* extensions.cpp - users' modules in a world: their buffers, and their kernels between steps. */
#include <algorithm>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/runtime/interface/module.h"
#include "host/world/implementation.h"

namespace tandem {

/* Records all kernels of a module that the scene's features allow, because its launches may differ from step to
 * step. */
void World::Implementation::note_rows(Recorder &recorder, const Module &module) const
{
  const auto needed = [&](Features feature) { return feature == 0 || (feature & special.features) != 0; };
  for (size_t i = 0; i < module.kernels(); ++i)
    if (needed(module.kernel_row(i).feature)) recorder.note(module.kernel(i));
  for (size_t i = 0; i < module.buffers(); ++i) recorder.touched[index_of(module.buffer(i))] = true;
}

void World::Implementation::check_write(Buffer buffer, size_t bytes, size_t offset) const
{
  const BufferRow &row = row_of(buffer);
  if (index_of(buffer) < buffer_count || index_of(buffer) >= buffers.needs().touched.size() ||
      !buffers.needs().touched[index_of(buffer)])
    throw InputError(fmt::format("write: buffer '{}' is of no module in Settings::extensions", row.name));
  const size_t unit = row.per_item * size_of(row.element);
  constexpr uint64_t most = uint64_t{1} << 32; /* elements that kernels can index */
  const bool sizes = is_sized_by_writes(buffer) && offset == 0;
  if (sizes && bytes % unit == 0 && bytes / size_of(row.element) <= most) return;
  if (sizes || offset > memory.bytes(buffer) || bytes > memory.bytes(buffer) - offset)
    throw InputError(fmt::format("write: buffer '{}' has {} bytes, not {} from byte {} on; an item has {}", row.name,
                                 memory.bytes(buffer), bytes, offset, unit));
}

void World::Implementation::write(Buffer buffer, const void *from, size_t bytes, size_t offset)
{
  check_write(buffer, bytes, offset);
  settle(); /* not over what is written now */
  if (!is_sized_by_writes(buffer) || offset > 0 || memory.bytes(buffer) == bytes) {
    for (const CarriedBuffer &carried : buffers.carried()) /* steps leave the rows of sleepers on both sides */
      if (carried.now == buffer && !sleepers.empty()) memory.upload(carried.previous, from, bytes, offset);
    return memory.upload(buffer, from, bytes, offset);
  }
  memory.assign(buffer, from, bytes);
  buffers.changed();
}

/* A step swaps both sides of all carried buffers. Those that no kernel of the module wrote are swapped back. */
void World::Implementation::keep_unwritten() noexcept
{
  const std::vector<Buffer> &written = launcher.written_by_modules();
  for (const CarriedBuffer &buffer : buffers.carried())
    if (index_of(buffer.now) >= buffer_count && std::find(written.begin(), written.end(), buffer.now) == written.end())
      memory.exchange(buffer.now, buffer.previous);
}

/* Runs between two steps. What broadphases keep is invalidated, because the kernel may have changed bodies. */
void World::Implementation::run(Kernel kernel, const Values &values, const Slots &slots)
{
  settle();
  buffers.make_ready(sizes());
  count_awake_bodies();
  ++state;
  begin_launches();
  StepLaunches(launcher, plan, settings_in_use).run_of_module(kernel, values, slots, {});
  forget_kept(memory);
  launches_ended = true;
}

} // namespace tandem
