/* background_build.h - builds programs on a thread of its own, and says how far it has come.
 *
 * A driver's compiler takes seconds, in which a world need not stand still (host/world/placed_backends.h).
 */
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <future>
#include <map>
#include <utility>
#include <vector>

#include "host/runtime/interface/backend.h"
#include "host/runtime/opencl/api.h"

namespace tandem::opencl {

/* The programs of a stage by the features that it reads, and the kernels that each was built for. */
using ProgramKey = std::pair<Stage, Features>;
using KernelPrograms = std::map<Kernel, cl::Program>;
using Programs = std::map<ProgramKey, KernelPrograms>;
using MissingPrograms = std::map<ProgramKey, std::vector<Kernel>>;

/* All functions but the one that builds are called by one thread. */
class BackgroundBuild {
public:
  using BuildOne = std::function<void(const ProgramKey &, const std::vector<Kernel> &, KernelPrograms &)>;

  BackgroundBuild() = default;
  /* Waits for the program that is being built, and begins no other. */
  ~BackgroundBuild();
  BackgroundBuild(const BackgroundBuild &) = delete;
  BackgroundBuild &operator=(const BackgroundBuild &) = delete;

  /* Begins to build these, one after the other; what was built before must have been taken. */
  void begin(MissingPrograms missing, BuildOne build_one);
  bool is_running() const;
  /* Waits, and hands over what was built; after a failure these are the programs before the one that failed. */
  Programs take();
  /* Whether the build that was taken last failed and nobody was told. */
  bool has_failed() const { return failure_ != nullptr; }
  /* Throws what the build threw, once. */
  void tell_failure();

  Backend::Progress progress() const { return {built_kernels_, kernels_}; }
  double milliseconds() const { return milliseconds_; } /* that the builds which were taken took */

private:
  void build(const MissingPrograms &missing, const BuildOne &build_one);

  size_t kernels_ = 0;
  std::atomic<size_t> built_kernels_{0};
  std::atomic<bool> stops_{false};
  std::exception_ptr failure_;
  double milliseconds_ = 0, spent_ = 0; /* the last is the thread's until it ends, as is what it built */
  Programs built_;
  std::future<void> thread_; /* the last member, because its thread uses the others */
};

} // namespace tandem::opencl
