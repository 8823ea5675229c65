/* placed_backends.h - the backends of a world, and which of them runs which kernel. */
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tandem/backend.h>
#include <tandem/world.h>

#include "host/runtime/interface/backend.h"

namespace tandem {

/* It outlives the memory of its world, which lies in the backends' storage. */
class PlacedBackends {
public:
  PlacedBackends(const Placement &placement, Features features) : wanted_(placement), features_(features) {}
  /* The same backends and placement for a world of other features that is to replace the one of `shared`. Where it
   * does not come to that, shared.take_back() makes them serve the old one again. */
  PlacedBackends(const PlacedBackends &shared, Features features)
      : wanted_(shared.wanted_), features_(features), backends_(shared.backends_), profiling_(shared.profiling_),
        building_(shared.building())
  {}
  void take_back() const;
  const Placement &wanted() const { return wanted_; }
  /* Moves these kernels, and all others from their next launch on. If it throws (InputError or a device's
   * std::runtime_error), nothing has changed. */
  void place(const Placement &placement, const std::vector<Kernel> &kernels);
  void place_again(const std::vector<Kernel> &kernels) { assign(wanted_, kernels, builds_in_background()); }
  /* Builds these kernels for other features, and from now on all others too. If it throws, nothing has changed. */
  void take_features(Features features, const std::vector<Kernel> &kernels);
  /* Whether place() would find all of it built; if not, it is being built on threads of its own. */
  bool is_built(const Placement &placement, const std::vector<Kernel> &kernels);
  /* Kernels run on tbb until those of their backend are built: the same bits, and nobody waits for a compiler. */
  bool is_waiting() const { return waiting_; }
  /* For one who waits: calls Placement::while_building, and sleeps for a moment. */
  void tell_progress(const Placement &placement) const;
  void note_step(uint64_t steps); /* as many have been made */
  PlacementReport::Building building() const;
  /* Kernels that place() did not name are built when they are first used, and then kept. */
  Backend &of(Kernel kernel);

  const std::map<std::string, std::shared_ptr<Backend>> &all() const { return backends_; }
  /* Ignores failures, because they were reported when they occurred and a destructor cannot report them. */
  void finish_at_last() noexcept;
  void finish();
  /* The same for those that have launched something since; others may still copy states that are kept. */
  void finish_launches();
  void set_profiling(bool on);
  bool is_profiling() const { return profiling_; }
  std::vector<KernelTime> take_kernel_times();
  double build_milliseconds() const;
  uint64_t launches() const;
  uint32_t resident_groups() const;
  void do_without_resident_groups();

private:
  std::map<Backend *, std::vector<Kernel>> by_backend(const Placement &placement, const std::vector<Kernel> &kernels);
  bool builds_in_background() const { return wanted_.build_in_background || wanted_.start == Start::on_cpu; }
  void assign(const Placement &placement, const std::vector<Kernel> &kernels, bool in_background);
  Backend::Progress progress() const;
  double milliseconds_waiting() const;
  void note_waiting(bool waiting);
  Backend &named(const std::string &text, bool allow_inexact);
  Backend &for_kernel(const Placement &placement, Kernel kernel);

  Placement wanted_;
  Features features_;
  std::map<std::string, std::shared_ptr<Backend>> backends_; /* by the text that names them */
  std::map<const Backend *, uint64_t> finished_;             /* launches of each by the last finish */
  std::vector<Backend *> placed_;                            /* by the kernel's number */
  bool profiling_ = false;                                   /* also of backends made later */
  bool waiting_ = false;
  std::chrono::steady_clock::time_point waiting_since_;
  PlacementReport::Building building_; /* without the present wait */
};

} // namespace tandem
