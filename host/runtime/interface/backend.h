/* backend.h - the interface of what runs kernels: MiniCL (serial, tbb) or an OpenCL device.
 *
 * step.cpp decides which kernels run, placement decides on which backend, and a backend contains no physics.
 */
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/runtime/interface/short_list.h"
#include "host/runtime/interface/storage.h"

namespace tandem {

class Memory;

using Slots = ShortList<Buffer, 8>;
using Values = ShortList<uint32_t, 8>;

/* One kernel over one range. Slots and values fill the row's SLOT_ and VALUE arguments in order. */
struct Launch {
  Kernel kernel;
  Slots slots;
  Values values;
  uint32_t first = COUNT_ZERO; /* entries of counts: the range is [counts[first], counts[last]) */
  uint32_t last = COUNT_ZERO;
  uint32_t expected = 0; /* estimate of the number of items, which sizes a device's launch but never changes its result.
                            GROUP: at least as many */
  uint32_t branch = 0;   /* launches of other branches than 0 that follow each other need no order among branches */
};

/* Calls work(buffer, access) for each buffer that a launch takes, in the order of the kernel's row. */
template <class Work> void for_each_buffer(const Launch &launch, const Work &work)
{
  size_t slot = 0;
  for (const Argument &argument : row_of(launch.kernel).arguments)
    if (argument.kind != Argument::Kind::value)
      work(argument.kind == Argument::Kind::slot ? launch.slots.at(slot++) : argument.buffer, argument.access);
}

/* One argument, in the order of the kernel's row: a handle of the backend's storage, or a value. */
struct BoundArgument {
  void *handle = nullptr;
  uint32_t value = 0;
};

/* A launch with its arguments. */
struct BoundLaunch {
  Launch launch;
  uint32_t items = 0; /* as many as there were in the last step */
  std::vector<BoundArgument> arguments;
};

class Backend {
public:
  virtual ~Backend() = default;
  virtual const std::string &name() const = 0; /* as given to --on: "tbb:threads=2,lanes=8" */
  virtual Storage &storage() = 0;
  /* Builds or looks up what the kernels of a scene need; features: FEATURE_ bits. It is called before run. */
  virtual void prepare(Features features, const std::vector<Kernel> &kernels) = 0;
  /* Whether prepare() would find all of it built; if not, a thread starts to build it, unless one builds already. What
   * cannot be built counts as built, so that prepare() says why; after that it is tried again. */
  virtual bool is_built_ahead(Features, const std::vector<Kernel> &) { return true; }
  /* How far the last of these threads has come, in kernels. */
  struct Progress {
    size_t built = 0, wanted = 0;
  };
  virtual Progress progress() const { return {}; }
  /* counts: the handle of Buffer::counts in this backend's storage. The call may return before the work is done. */
  virtual void run(const Launch &launch, const std::vector<BoundArgument> &arguments, void *counts) = 0;
  /* Launches of at most so many items are better given to run_series, so many at a time; 0: none are. A device runs one
   * series while the host collects the next: so a step of 40 boxes takes an H200 0.35 ms, and 0.385 in one series. */
  virtual uint32_t most_items_of_series() const { return 0; }
  virtual size_t most_launches_of_series() const { return 64; }
  /* Does what run() would for each of these launches of the pipeline's kernels in turn, perhaps in fewer launches. */
  virtual void run_series(std::span<const BoundLaunch> series, void *counts);
  /* The work-groups of a launch that joins others, which wait for each other: those that the device runs together. */
  virtual uint32_t resident_groups() const { return 1; }
  /* From now on, because some waited for others in vain. */
  virtual void do_without_resident_groups() {}
  /* Runs a kernel of execution HOST, which accesses its buffers itself. Only the backend of host/pipeline/cpu_kernels.h
   * supports it. */
  virtual void run_cpu_kernel(const Launch &launch, Memory &memory);
  virtual void finish() = 0; /* waits for all work given so far */

  /* Work-item order of the CPU backends, for tests. */
  enum class Order { forward, backward, shuffled };

  /* The time spent in each kernel since the last call, indexed by Kernel; all 0 unless profiling is on. */
  struct Time {
    double nanoseconds = 0;
    uint64_t launches = 0;
  };
  virtual void set_profiling(bool on) = 0;
  virtual std::vector<Time> take_kernel_times() = 0;

  /* Builds what the launches so far would let run_series() build in the background later. */
  virtual void build_series() {}

  /* Programs compiled at run time so far, as the driver describes them; none on a CPU, whose kernels are part of the
   * library. */
  struct Compiled {
    Stage stage;
    std::string options;
    std::vector<std::string> kernels;
  };
  virtual std::vector<Compiled> compiled() const { return {}; }

  double build_milliseconds = 0; /* spent in prepare and build_series, and by threads that built ahead */
  uint64_t launches = 0;         /* made so far; a series that runs as one counts as one */
};

} // namespace tandem
