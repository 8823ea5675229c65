/* launcher.cpp - binds a launch's arguments in the order of its kernel's row and passes it to its backend; see
 * launcher.h. */
#include "host/runtime/launcher.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "host/runtime/interface/debug.h"

namespace tandem {
namespace {

/* Of any kernel of the pipeline. */
size_t most_arguments()
{
  static const size_t most = [] {
    size_t arguments = 0;
    for (size_t k = 0; k < kernel_count; ++k) arguments = std::max(arguments, row_of(kernel_at(k)).arguments.size());
    return arguments;
  }();
  return most;
}

} // namespace

void PlacedLauncher::note_written(Buffer buffer)
{
  if (index_of(buffer) >= buffer_count && std::find(written_.begin(), written_.end(), buffer) == written_.end())
    written_.push_back(buffer);
}

/* Kernels write the rows of bodies and joints that are awake; where others sleep, their rows are part of the
 * contents. */
Access PlacedLauncher::access_of(Buffer buffer, Access access) const
{
  if (access != Access::out || !keeps_sleepers_) return access;
  const BufferRow &row = row_of(buffer);
  const bool of_bodies = row.lifetime == Lifetime::STATE && row.capacity == Capacity::BODIES,
             of_joints = row.lifetime == Lifetime::CACHE && has_rows_of_joints(row);
  return of_bodies || of_joints ? Access::inout : access;
}

void PlacedLauncher::bind(const Launch &launch, Storage &storage, std::vector<BoundArgument> &bound)
{
  const KernelRow &row = row_of(launch.kernel);
  bound.clear();
  size_t slot = 0, value = 0;
  LaunchParts *const parts = observer_ ? nullptr : parts_;
  if (parts) parts->begin_launch(launch);
  for (const Argument &argument : row.arguments) {
    if (argument.kind == Argument::Kind::value) {
      bound.push_back({nullptr, launch.values.at(value++)});
      continue;
    }
    const Buffer buffer = argument.kind == Argument::Kind::slot ? launch.slots.at(slot++) : argument.buffer;
    if (argument.access != Access::in) note_written(buffer);
    bound.push_back({memory_.acquire(buffer, storage, access_of(buffer, argument.access), parts), 0});
  }
  if (slot != launch.slots.size() || value != launch.values.size())
    throw std::logic_error(std::string("launch of ") + row.name + " does not fit its row in kernels.def");
}

void PlacedLauncher::launch(const Launch &launch)
{
  step_of_launch = step_;
  Backend &backend = choice_(launch.kernel);
  if (joins_series(launch, backend)) return collect(launch, backend);
  run_collected();
  if (row_of(launch.kernel).execution == Execution::host) {
    backend.run_cpu_kernel(launch, memory_);
  } else {
    bind(launch, backend.storage(), bound_);
    backend.run(launch, bound_, memory_.acquire(Buffer::counts, backend.storage(), Access::in));
  }
  if (observer_) observer_(launch);
}

void PlacedLauncher::launch_in_series(std::span<const uint32_t> known, const std::function<void()> &launches)
{
  known_ = known;
  try {
    launches();
    run_collected();
  } catch (...) {
    known_ = {};
    collected_count_ = 0;
    throw;
  }
  known_ = {};
}

/* An observer sees the effect of each launch before the next one. Memory is poisoned when a launch is bound, which must
 * not come before those that still read it have run. */
bool PlacedLauncher::joins_series(const Launch &launch, const Backend &backend) const
{
  const uint32_t most = backend.most_items_of_series();
  if (known_.empty() || most == 0 || observer_ || memory_.poisons() || index_of(launch.kernel) >= kernel_count)
    return false;
  return row_of(launch.kernel).execution != Execution::host && known_[launch.last] - known_[launch.first] <= most;
}

/* A series may be longer in a later step, which must allocate nothing. */
void PlacedLauncher::make_room(size_t launches)
{
  if (launches <= collected_.size()) return;
  const size_t before = collected_.size();
  collected_.resize(launches);
  for (size_t i = before; i < launches; ++i) collected_[i].arguments.reserve(most_arguments());
}

/* What other backends have to do first is done before buffers move. */
void PlacedLauncher::collect(const Launch &launch, Backend &backend)
{
  if (collecting_backend_ != &backend) run_collected();
  collecting_backend_ = &backend;
  make_room(backend.most_launches_of_series());
  BoundLaunch &bound = collected_[collected_count_];
  bound.launch = launch;
  bound.items = known_[launch.last] - known_[launch.first];
  bind(launch, backend.storage(), bound.arguments);
  if (++collected_count_ == backend.most_launches_of_series()) run_collected();
}

void PlacedLauncher::run_collected()
{
  if (collected_count_ == 0) return;
  Backend &backend = *collecting_backend_;
  const std::span<const BoundLaunch> series(collected_.data(), std::exchange(collected_count_, 0));
  backend.run_series(series, memory_.acquire(Buffer::counts, backend.storage(), Access::in));
}

} // namespace tandem
