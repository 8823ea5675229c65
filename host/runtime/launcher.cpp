/* launcher.cpp - binds a launch's arguments in the order of its kernel's row and passes it to its backend; see
 * launcher.h. */
#include "host/runtime/launcher.h"

#include <algorithm>
#include <stdexcept>

#include "host/runtime/interface/debug.h"

namespace tandem {

void PlacedLauncher::note_written(Buffer buffer)
{
  if (index_of(buffer) >= buffer_count && std::find(written_.begin(), written_.end(), buffer) == written_.end())
    written_.push_back(buffer);
}

/* Kernels write the rows of bodies that are awake; where others sleep, their rows are part of the contents. */
Access PlacedLauncher::access_of(Buffer buffer, Access access) const
{
  const BufferRow &row = row_of(buffer);
  const bool partial = keeps_sleepers_ && row.lifetime == Lifetime::STATE && row.capacity == Capacity::BODIES;
  return partial && access == Access::out ? Access::inout : access;
}

void PlacedLauncher::launch(const Launch &launch)
{
  step_of_launch = step_;
  Backend &backend = choice_(launch.kernel);
  const KernelRow &row = row_of(launch.kernel);
  if (row.execution == Execution::host) {
    backend.run_cpu_kernel(launch, memory_);
    if (observer_) observer_(launch);
    return;
  }
  bound_.clear();
  size_t slot = 0, value = 0;
  for (const Argument &argument : row.arguments) {
    switch (argument.kind) {
    case Argument::Kind::buffer:
      bound_.push_back(
          {memory_.acquire(argument.buffer, backend.storage(), access_of(argument.buffer, argument.access)), 0});
      if (argument.access != Access::in) note_written(argument.buffer);
      break;
    case Argument::Kind::slot:
      if (argument.access != Access::in) note_written(launch.slots.at(slot));
      bound_.push_back(
          {memory_.acquire(launch.slots.at(slot), backend.storage(), access_of(launch.slots.at(slot), argument.access)),
           0});
      ++slot;
      break;
    case Argument::Kind::value: bound_.push_back({nullptr, launch.values.at(value++)}); break;
    }
  }
  if (slot != launch.slots.size() || value != launch.values.size())
    throw std::logic_error(std::string("launch of ") + row.name + " does not fit its row in kernels.def");
  void *counts = memory_.acquire(Buffer::counts, backend.storage(), Access::in);
  backend.run(launch, bound_, counts);
  if (observer_) observer_(launch);
}

} // namespace tandem
