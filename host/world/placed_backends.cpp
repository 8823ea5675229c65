/* placed_backends.cpp - makes backends, and maps kernels to them; see placed_backends.h. */
#include "host/world/placed_backends.h"

#include <algorithm>
#include <exception>
#include <thread>
#include <utility>

#include "host/pipeline/cpu_kernels.h"
#include "host/runtime/make_backend.h"

namespace tandem {
namespace {

constexpr const char *until_built = "tbb";
constexpr std::chrono::milliseconds between_looks{1};

std::string backend_text(const Placement &placement, Kernel kernel)
{
  std::string text = placement.on;
  for (const auto &[what, where] : placement.exceptions)
    if (what == name_of(row_of(kernel).stage) || what == row_of(kernel).name) text = where;
  return text;
}

} // namespace

void PlacedBackends::finish_at_last() noexcept
{
  for (const auto &[text, backend] : backends_) try {
      backend->finish();
    } catch (const std::exception &) {}
}

/* Backends are kept once made, because a buffer may be valid only in one that runs no kernel any more. */
Backend &PlacedBackends::named(const std::string &text, bool allow_inexact)
{
  if (const auto known = backends_.find(text); known != backends_.end()) return *known->second;
  std::unique_ptr<Backend> made = make_backend(text, allow_inexact);
  made->set_profiling(profiling_);
  return *backends_.emplace(text, std::move(made)).first->second;
}

/* CPU-only kernels run on the host whatever the placement says, but a name that is no backend is refused all the
 * same. */
Backend &PlacedBackends::for_kernel(const Placement &placement, Kernel kernel)
{
  Backend &as_said = named(backend_text(placement, kernel), placement.allow_inexact);
  if (row_of(kernel).execution != Execution::host) return as_said;
  if (const auto known = backends_.find(cpu_kernels_name); known != backends_.end()) return *known->second;
  std::unique_ptr<Backend> host = make_cpu_kernels();
  host->set_profiling(profiling_);
  return *backends_.emplace(cpu_kernels_name, std::move(host)).first->second;
}

void PlacedBackends::finish()
{
  for (const auto &[text, backend] : backends_) backend->finish();
}

void PlacedBackends::finish_launches()
{
  for (const auto &[text, backend] : backends_) {
    uint64_t &finished = finished_[backend.get()];
    if (finished != backend->launches) backend->finish();
    finished = backend->launches;
  }
}

std::map<Backend *, std::vector<Kernel>> PlacedBackends::by_backend(const Placement &placement,
                                                                    const std::vector<Kernel> &kernels)
{
  std::map<Backend *, std::vector<Kernel>> own;
  for (Kernel kernel : kernels) own[&for_kernel(placement, kernel)].push_back(kernel);
  return own;
}

bool PlacedBackends::is_built(const Placement &placement, const std::vector<Kernel> &kernels)
{
  bool built = true;
  for (const auto &[backend, theirs] : by_backend(placement, kernels))
    built = backend->is_built_ahead(features_, theirs) && built;
  return built;
}

Backend::Progress PlacedBackends::progress() const
{
  Backend::Progress sum;
  for (const auto &[text, backend] : backends_) {
    const Backend::Progress own = backend->progress();
    sum.built += own.built;
    sum.wanted += own.wanted;
  }
  return sum;
}

void PlacedBackends::tell_progress(const Placement &placement) const
{
  const Backend::Progress now = progress();
  if (placement.while_building) placement.while_building(now.built, now.wanted);
  std::this_thread::sleep_for(between_looks);
}

double PlacedBackends::milliseconds_waiting() const
{
  if (!waiting_) return 0;
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - waiting_since_).count();
}

void PlacedBackends::note_waiting(bool waiting)
{
  building_.milliseconds += milliseconds_waiting();
  waiting_since_ = std::chrono::steady_clock::now();
  waiting_ = waiting;
}

void PlacedBackends::note_step(uint64_t steps)
{
  if (!waiting_) return;
  ++building_.steps_on_cpu;
  building_.moved_after = steps;
}

PlacementReport::Building PlacedBackends::building() const
{
  PlacementReport::Building building = building_;
  building.milliseconds += milliseconds_waiting();
  const Backend::Progress now = progress();
  building.built = now.built;
  building.kernels = now.wanted;
  return building;
}

/* Everything that can fail comes before the first change of the placement. */
void PlacedBackends::assign(const Placement &placement, const std::vector<Kernel> &kernels, bool in_background)
{
  if (!in_background && placement.while_building) /* a thread builds, so that this one can tell */
    while (!is_built(placement, kernels)) tell_progress(placement);
  const std::map<Backend *, std::vector<Kernel>> own = by_backend(placement, kernels);
  std::vector<Backend *> placed(all_kernels());
  bool waiting = false;
  for (const auto &[backend, theirs] : own) {
    const bool built = !in_background || backend->is_built_ahead(features_, theirs);
    if (built) backend->prepare(features_, theirs);
    waiting = waiting || !built;
    Backend *const now = built ? backend : &named(until_built, placement.allow_inexact);
    for (Kernel kernel : theirs) placed[index_of(kernel)] = now;
  }
  placed_ = std::move(placed);
  note_waiting(waiting);
}

void PlacedBackends::place(const Placement &placement, const std::vector<Kernel> &kernels)
{
  validate(placement);
  Placement wanted = placement; /* which may take memory that is not there */
  assign(placement, kernels, placement.start == Start::on_cpu);
  wanted_ = std::move(wanted);
}

/* Where some backends had taken the features already when another one failed, they go back to kernels that they have
 * built before. */
void PlacedBackends::take_features(Features features, const std::vector<Kernel> &kernels)
{
  const Features before = std::exchange(features_, features);
  try {
    place_again(kernels);
  } catch (...) {
    features_ = before;
    take_back();
    throw;
  }
}

/* The kernels have been built before, so that this cannot fail. */
void PlacedBackends::take_back() const
{
  for (const auto &[text, backend] : backends_) backend->prepare(features_, {});
}

Backend &PlacedBackends::of(Kernel kernel)
{
  Backend *&backend = placed_.at(index_of(kernel));
  if (!backend) {
    Backend &chosen = for_kernel(wanted_, kernel);
    const bool waits = !waiting_ && wanted_.start == Start::on_device;
    if (!waits && !chosen.is_built_ahead(features_, {kernel})) return named(until_built, wanted_.allow_inexact);
    chosen.prepare(features_, {kernel}); /* if this throws, no backend is chosen */
    backend = &chosen;
  }
  return *backend;
}

void PlacedBackends::set_profiling(bool on)
{
  profiling_ = on;
  for (const auto &[text, backend] : backends_) {
    backend->set_profiling(on);
    backend->take_kernel_times();
  }
}

std::vector<KernelTime> PlacedBackends::take_kernel_times()
{
  std::vector<KernelTime> times;
  for (const auto &[text, backend] : backends_) {
    const std::vector<Backend::Time> spent = backend->take_kernel_times();
    for (size_t k = 0; k < spent.size(); ++k)
      if (spent[k].launches > 0)
        times.push_back({kernel_at(k), backend->name(), spent[k].nanoseconds * 1e-6, spent[k].launches});
  }
  return times;
}

double PlacedBackends::build_milliseconds() const
{
  double total = 0;
  for (const auto &[text, backend] : backends_) total += backend->build_milliseconds;
  return total;
}

uint64_t PlacedBackends::launches() const
{
  uint64_t total = 0;
  for (const auto &[text, backend] : backends_) total += backend->launches;
  return total;
}

uint32_t PlacedBackends::resident_groups() const
{
  uint32_t most = 1;
  for (const auto &[text, backend] : backends_) most = std::max(most, backend->resident_groups());
  return most;
}

void PlacedBackends::do_without_resident_groups()
{
  for (const auto &[text, backend] : backends_) backend->do_without_resident_groups();
}

} // namespace tandem
