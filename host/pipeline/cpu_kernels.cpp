/* cpu_kernels.cpp - the backend that runs CPU-only kernels; see cpu_kernels.h. */
#include "host/pipeline/cpu_kernels.h"

#include <array>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "host/pipeline/solvers/islands.h"
#include "host/runtime/interface/floating_point.h"

namespace tandem {
namespace {

#define EXECUTION_ITEM(name) nullptr
#define EXECUTION_LANES(name) nullptr
#define EXECUTION_LANES_PADDED(name) nullptr
#define EXECUTION_GROUP(name) nullptr
#define EXECUTION_LANES_GROUP(name) nullptr
#define EXECUTION_HOST(name) make_##name()
#define KERNEL(name, stage, execution, items, feature, arguments) EXECUTION_##execution(name),

class CpuKernels : public Backend {
public:
  const std::string &name() const override { return name_; }
  Storage &storage() override { return host_storage(); }
  void prepare(Features, const std::vector<Kernel> &) override {}
  void finish() override {}
  void set_profiling(bool on) override { profiling_ = on; }
  std::vector<Time> take_kernel_times() override { return std::exchange(times_, std::vector<Time>(times_.size())); }

  void run(const Launch &launch, const std::vector<BoundArgument> &, void *) override
  {
    throw std::logic_error(std::string("kernel ") + row_of(launch.kernel).name + " is no stage of the host");
  }

  void run_cpu_kernel(const Launch &launch, Memory &memory) override
  {
    const minicl::ExactFloatingPoint environment;
    const auto start = std::chrono::steady_clock::now();
    kernels_[index_of(launch.kernel)]->run(launch, memory);
    if (!profiling_) return;
    Time &time = times_[index_of(launch.kernel)];
    time.nanoseconds += std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
    ++time.launches;
  }

private:
  std::string name_ = cpu_kernels_name;
  std::array<std::unique_ptr<CpuKernel>, kernel_count> kernels_ = {
#include "shared/kernels.def"
  };
  bool profiling_ = false;
  std::vector<Time> times_ = std::vector<Time>(kernel_count);
};

} // namespace

std::unique_ptr<Backend> make_cpu_kernels() { return std::make_unique<CpuKernels>(); }

} // namespace tandem
