/* placed_backends.h - the backends of a world, and which of them runs which kernel. */
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tandem/backend.h>
#include <tandem/world.h>

#include "host/runtime/interface/backend.h"

namespace tandem {

/* Outlives the memory of its world, which lives in the backends' storage. */
class PlacedBackends {
public:
  PlacedBackends(const Placement &placement, Features features) : wanted_(placement), features_(features) {}
  /* Moves these kernels, and from their next launch on all others. InputError or a device's std::runtime_error leave
   * everything as it was. */
  void place(const Placement &placement, const std::vector<Kernel> &kernels);
  void place_again(const std::vector<Kernel> &kernels) { assign(wanted_, kernels); }
  /* Kernels that place() did not name are built when they are first asked for, then kept. */
  Backend &of(Kernel kernel);

  const std::map<std::string, std::unique_ptr<Backend>> &all() const { return backends_; }
  /* What fails now was told when it did; a destructor has no one to tell. */
  void finish_at_last() noexcept;
  void set_profiling(bool on);
  std::vector<KernelTime> take_kernel_times();
  double build_milliseconds() const;

private:
  void assign(const Placement &placement, const std::vector<Kernel> &kernels);
  Backend &named(const std::string &text, bool allow_inexact);
  Backend &for_kernel(const Placement &placement, Kernel kernel);

  Placement wanted_;
  Features features_;
  std::map<std::string, std::unique_ptr<Backend>> backends_; /* by the text that names them */
  std::vector<Backend *> placed_;                            /* by the kernel's number */
  bool profiling_ = false;                                   /* of backends made later, too */
};

} // namespace tandem
