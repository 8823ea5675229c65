/* device_backend.cpp - builds the programs and kernels of a scene's features and launches them into one in-order queue
 * and its branches.
 *
 * A step makes some two hundred launches of a few microseconds each, so run() allocates nothing and sets only the
 * arguments that changed since the kernel's last launch.
 */
#include "host/runtime/opencl/device_backend.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/runtime/interface/floating_point.h"
#include "host/runtime/opencl/background_build.h"
#include "host/runtime/opencl/empty_launch.h"
#include "host/runtime/opencl/phases.h"
#include "host/runtime/opencl/program.h"
#include "host/runtime/opencl/storage.h"
#include "shared/platform.h"

namespace tandem::opencl {
namespace {

constexpr size_t items_per_group = 64;  /* ITEM and LANES kernels */
constexpr size_t items_per_tile = 256;  /* GROUP kernels */
constexpr size_t items_at_most = 256;   /* of an enlarged group */
constexpr size_t most_items = 1u << 22; /* a launch of more items strides over them */
constexpr uint32_t launches_per_flush = 32;
constexpr size_t most_events = 4096;

struct BuiltKernel {
  cl::Kernel kernel;
  size_t group_size = 0, widest_group = 0; /* a launch of many items may take larger groups */
  std::vector<uint64_t> arguments;         /* set last: a buffer's serial, or value_tag | value */
};

constexpr uint64_t value_tag = uint64_t{1} << 63;
constexpr uint64_t never_set = ~uint64_t{0};

/* The kernels of one set of features. */
struct Build {
  Build(const DeviceContext &context, Features features, PhaseMode mode, size_t group_size)
      : phases(context, features, mode, group_size)
  {}
  std::vector<BuiltKernel> kernels = std::vector<BuiltKernel>(all_kernels());
  Phases phases;
};

/* Results do not depend on the size of groups, which tests show by setting it. 0 means that it is not set. */
size_t group_size_of_tests()
{
  const char *text = std::getenv("TANDEM_LOCAL_SIZE");
  if (!text || !*text) return 0;
  char *end = nullptr;
  const unsigned long size = std::strtoul(text, &end, 10);
  if (*end || size < 1 || size > 1024)
    throw InputError(fmt::format("TANDEM_LOCAL_SIZE '{}' is not a whole number from 1 to 1024", text));
  return size;
}

/* Whether devices other than GPUs have branches, too, which tests ask for. */
bool branches_of_tests()
{
  const char *text = std::getenv("TANDEM_BRANCHES");
  if (!text || !*text) return false;
  if (std::string_view(text) != "always") throw InputError(fmt::format("TANDEM_BRANCHES '{}' is not 'always'", text));
  return true;
}

class OpenclBackend : public Backend {
public:
  OpenclBackend(const std::string &name, const Candidate &candidate)
      : name_(name), context_(candidate), storage_(context_), group_size_(group_size_of_tests()),
        phase_mode_(phase_mode_of_tests()), has_branches_(branches_of_tests() || context_.info.type == "GPU")
  {
    pending_.reserve(most_events);
  }
  ~OpenclBackend() override
  {
    try {
      finish();
    } catch (const std::exception &) { /* a lost device has nothing left to wait for */
    }
    for (const auto &[kernel, event] : pending_) clReleaseEvent(event);
  }

  const std::string &name() const override { return name_; }
  Storage &storage() override { return storage_; }
  /* A queue with nothing in it is not waited for: NVIDIA's driver would wait for a compiler that runs beside it. */
  void finish() override
  {
    if (launches == finished_launches_ && !storage_.is_busy()) return;
    storage_.wait();
    finished_launches_ = launches;
  }

  void prepare(Features features, const std::vector<Kernel> &kernels) override
  {
    const minicl::ExactFloatingPoint environment; /* inherited by threads that the driver may start */
    wait_for_what_is_built_ahead(features, kernels);
    const auto start = std::chrono::steady_clock::now();
    current_ = &builds_.try_emplace(features, context_, features, phase_mode_, group_size_).first->second;
    for (const auto &[key, missing] : programs_missing(features, kernels)) build(key, missing, programs_[key]);
    for (const Kernel kernel : kernels)
      if (!current_->kernels[index_of(kernel)].kernel())
        create_kernel(kernel, programs_[key_of(row_of(kernel).stage, features)].at(kernel));
    add_build_time(start);
  }

  std::vector<Compiled> compiled() const override
  {
    std::vector<Compiled> list;
    for (const auto &[key, programs] : programs_) {
      std::set<cl_program> seen;
      for (const auto &[kernel, program] : programs)
        if (seen.insert(program()).second) list.push_back(described(key.first, program));
    }
    return list;
  }

  bool is_built_ahead(Features features, const std::vector<Kernel> &kernels) override
  {
    if (!ahead_.is_running()) take_what_was_built_ahead();
    MissingPrograms missing = programs_missing(features, kernels);
    if (missing.empty()) return true;
    if (ahead_.is_running()) return false;
    if (ahead_.has_failed()) return true;
    ahead_.begin(std::move(missing), [this](const ProgramKey &key, const auto &unbuilt, KernelPrograms &programs) {
      build(key, unbuilt, programs);
      for (const auto &[kernel, program] : programs) make_ready_to_launch(kernel, program);
    });
    return false;
  }

  Progress progress() const override { return ahead_.progress(); }

  void run(const Launch &launch, const std::vector<BoundArgument> &bound, void *counts) override
  {
    if (!current_ || !current_->kernels[index_of(launch.kernel)].kernel())
      throw std::logic_error(
          fmt::format("kernel {} was launched on {} before prepare", row_of(launch.kernel).name, name_));
    BuiltKernel &built = current_->kernels[index_of(launch.kernel)];
    set_arguments(built, row_of(launch.kernel), launch, bound, counts);
    const size_t group_size = group_size_for(row_of(launch.kernel), built, launch.expected);
    const size_t global_size = group_count(row_of(launch.kernel).execution, launch.expected, group_size) * group_size;
    cl_event event = nullptr;
    const cl_command_queue queue = queue_of(launch);
    const cl_int code = code_of(faults::Site::launch, [&] {
      return clEnqueueNDRangeKernel(queue, built.kernel(), 1, nullptr, &global_size, &group_size, 0, nullptr,
                                    profiling_ ? &event : nullptr);
    });
    if (code != CL_SUCCESS) fail(row_of(launch.kernel), "launch", code);
    if (event) keep(launch.kernel, event);
    if (++launches % launches_per_flush == 0) clFlush(queue);
  }

  uint32_t most_items_of_series() const override { return current_ ? current_->phases.most_items() : 0; }

  uint32_t resident_groups() const override { return current_ ? current_->phases.resident_groups() : 1; }

  void do_without_resident_groups() override
  {
    for (auto &[features, build] : builds_) build.phases.do_without_resident_groups();
  }

  /* A profile is of kernels, so each has a launch of its own then. */
  void run_series(std::span<const BoundLaunch> series, void *counts) override
  {
    if (profiling_ || !current_) return Backend::run_series(series, counts);
    const auto run_alone = [&](const BoundLaunch &bound) { run(bound.launch, bound.arguments, counts); };
    current_->phases.run(series, counts, run_alone, launches);
  }

  void build_series() override
  {
    const auto start = std::chrono::steady_clock::now();
    if (current_ && most_items_of_series() > 0) current_->phases.build();
    add_build_time(start);
  }

  void set_profiling(bool on) override
  {
    if (on == profiling_) return;
    finish();
    collect_events();
    context_.open_queue(on ? CL_QUEUE_PROFILING_ENABLE : 0u);
    profiling_ = on;
  }

  std::vector<Time> take_kernel_times() override
  {
    collect_events();
    return std::exchange(times_, std::vector<Time>(times_.size()));
  }

private:
  void add_build_time(std::chrono::steady_clock::time_point start)
  {
    build_milliseconds += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }

  [[noreturn]] void fail(const KernelRow &row, const char *what, cl_int code) const
  {
    throw DeviceError(fmt::format("OpenCL device {} ({}): {} of kernel {} failed: {}", context_.info.device_name,
                                  context_.info.platform_name, what, row.name, error_name(code)));
  }

  ProgramKey key_of(Stage stage, Features features)
  {
    if (!readable_.contains(stage)) /* searches the whole text */
      readable_[stage] = features_read(embedded_program(name_of(stage)));
    return {stage, features & readable_[stage]};
  }

  void take_what_was_built_ahead()
  {
    const double before = ahead_.milliseconds();
    for (auto &[key, built] : ahead_.take()) programs_[key].merge(built);
    build_milliseconds += ahead_.milliseconds() - before;
  }

  /* Drivers compile one program at a time, so that to build the same here would only take longer. */
  void wait_for_what_is_built_ahead(Features features, const std::vector<Kernel> &kernels)
  {
    if (programs_missing(features, kernels).empty()) return;
    take_what_was_built_ahead();
    if (!programs_missing(features, kernels).empty()) ahead_.tell_failure();
  }

  /* Only the requested kernels of a stage's program are compiled (but see part_to_build). */
  MissingPrograms programs_missing(Features features, const std::vector<Kernel> &kernels)
  {
    MissingPrograms missing;
    for (const Kernel kernel : kernels) {
      const ProgramKey key = key_of(row_of(kernel).stage, features);
      if (!programs_[key].contains(kernel)) missing[key].push_back(kernel);
    }
    return missing;
  }

  /* It may run on another thread, so it changes nothing but `programs`. */
  void build(const ProgramKey &key, const std::vector<Kernel> &kernels, KernelPrograms &programs) const
  {
    const auto &[stage, features] = key;
    try {
      const EmbeddedProgram part = part_to_build(embedded_program(name_of(stage)), kernels);
      const cl::Program program =
          build_program(context_, part, fmt::format("-D FEATURES={:#x}ul", features) + registers_for(stage, features));
      for (const Kernel kernel : kernels) programs[kernel] = program;
    } catch (const cl::Error &error) {
      fail(row_of(kernels.front()), "creation", error.err());
    }
  }

  /* The driver separates the names by semicolons. */
  Compiled described(Stage stage, const cl::Program &program) const
  {
    Compiled compiled{stage, program.getBuildInfo<CL_PROGRAM_BUILD_OPTIONS>(context_.device), {}};
    std::istringstream names(program.getInfo<CL_PROGRAM_KERNEL_NAMES>());
    for (std::string name; std::getline(names, name, ';');) compiled.kernels.push_back(name);
    return compiled;
  }

  /* PoCL compiles a kernel when it is launched, so building the whole program costs little. PoCL 3.1 also crashes in
   * LLVM's inliner if a function with two callers has lost one of them (sort_scatter_pairs without sort_scatter). */
  EmbeddedProgram part_to_build(const EmbeddedProgram &embedded, const std::vector<Kernel> &kernels) const
  {
    return is_pocl(context_) ? embedded : with_entries_of(embedded, kernels);
  }

  void create_kernel(Kernel kernel, const cl::Program &program)
  {
    const KernelRow &row = row_of(kernel);
    BuiltKernel &built = current_->kernels[index_of(kernel)];
    try {
      fail_where_a_test_wants(faults::Site::build, "clCreateKernel");
      cl::Kernel created(program, row.name);
      const size_t most = most_items_of_group(created);
      built.group_size = usual_group_size(row, most);
      built.widest_group = !group_size_ && takes_large_groups(row) ? std::min(items_at_most, most) : built.group_size;
      built.arguments.assign(row.arguments.size() + 3, never_set);
      built.kernel = std::move(created);
    } catch (const cl::Error &error) {
      fail(row, "creation", error.err());
    }
  }

  size_t most_items_of_group(const cl::Kernel &kernel) const
  {
    return kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(context_.device);
  }

  size_t usual_group_size(const KernelRow &row, size_t most) const
  {
    const size_t usual = row.execution == Execution::group ? items_per_tile : items_per_group;
    return std::min(group_size_ ? group_size_ : usual, most);
  }

  /* It runs on another thread. Nobody knows what kernels of modules do where their range is empty. */
  void make_ready_to_launch(Kernel kernel, const cl::Program &program) const
  {
    const KernelRow &row = row_of(kernel);
    if (index_of(kernel) >= kernel_count) return;
    try {
      cl::Kernel created(program, row.name);
      launch_over_nothing(context_, created, row, usual_group_size(row, most_items_of_group(created)));
    } catch (const cl::Error &error) {
      fail(row, "first launch", error.err());
    }
  }

  /* NVIDIA's compiler uses more registers than is useful in kernels that mostly wait for memory. On an H200 with a
   * limit of 128, the narrowphase of a million boxes takes 10 % less time, setup 4 % and integrate 13 %; the solver and
   * hulls take more time with any limit (docs/results/2026-11-23-h200-registers). */
  std::string registers_for(Stage stage, Features features) const
  {
    constexpr Features general_pairs = FEATURE_CONVEX_CONVEX | FEATURE_CONVEX_HALF_SPACE; /* among those read */
    const bool waits = stage == Stage::setup || stage == Stage::integrate ||
                       (stage == Stage::narrowphase && !(features & general_pairs));
    return waits && context_.info.platform_name.starts_with("NVIDIA") ? " -cl-nv-maxrregcount=128" : "";
  }

  /* Some stages are faster in large groups. An H200 computes 34 M manifolds of hulls of 32 vertices a second in groups
   * of 64, 40 M in groups of 128 and 52 M in groups of 256; the warps of a group start together and so probably fetch
   * the same code (docs/results/2026-11-22-h200). Items of batching are so short that starting their groups takes most
   * of the time: a million boxes take 0.45, 0.29 and 0.20 ms in groups of 64, 128 and 256
   * (docs/results/2026-11-23-h200-groups). */
  bool takes_large_groups(const KernelRow &row) const
  {
    const bool gains = row.stage == Stage::narrowphase || row.stage == Stage::batching || row.stage == Stage::parallel;
    return context_.info.type == "GPU" && row.execution == Execution::item && gains;
  }

  /* Items of trees of links are long and wait for memory, so a compute unit needs several groups of them, and warps
   * that are not full gain more than they lose: with 8,192 trees on an H200 solve_articulations takes 0.87 ms in groups
   * of 64 and 0.77 in groups of 16, move_articulations 0.61 and 0.56. */
  size_t size_of_tree_groups(size_t size, uint32_t expected) const
  {
    constexpr size_t groups_of_unit = 4, smallest = 16;
    while (size > smallest && expected < size * groups_of_unit * units_) size /= 2;
    return size;
  }

  /* The largest size that still gives every compute unit of the device a group. */
  size_t group_size_for(const KernelRow &row, const BuiltKernel &built, uint32_t expected) const
  {
    size_t size = built.group_size;
    if (!group_size_ && row.stage == Stage::articulations && context_.info.type == "GPU")
      return size_of_tree_groups(size, expected);
    while (size * 2 <= built.widest_group && expected >= size * 2 * units_) size *= 2;
    return size;
  }

  /* A profile is of kernels that have the device for themselves. */
  cl_command_queue queue_of(const Launch &launch) const
  {
    return launch.branch > 0 && has_branches_ && !profiling_ ? context_.branch(launch.branch) : context_.in_order();
  }

  static size_t group_count(Execution execution, uint32_t expected, size_t group_size)
  {
    const size_t items = std::max<size_t>(expected, 1);
    return execution == Execution::group ? (items + TILE - 1) / TILE
                                         : (std::min(items, most_items) + group_size - 1) / group_size;
  }

  void set_arguments(BuiltKernel &built, const KernelRow &row, const Launch &launch,
                     const std::vector<BoundArgument> &bound, void *counts)
  {
    const cl_uint n = static_cast<cl_uint>(row.arguments.size());
    if (bound.size() != n)
      throw std::logic_error(fmt::format("kernel {} takes {} arguments, not {}", row.name, n, bound.size()));
    for (cl_uint i = 0; i < n; ++i)
      if (row.arguments[i].kind == Argument::Kind::value) set_value(built, row, i, bound[i].value);
      else set_buffer(built, row, i, bound[i].handle);
    set_buffer(built, row, n, counts);
    set_value(built, row, n + 1, launch.first);
    set_value(built, row, n + 2, launch.last);
  }

  void set_buffer(BuiltKernel &built, const KernelRow &row, cl_uint index, void *handle)
  {
    const DeviceBuffer &buffer = *static_cast<const DeviceBuffer *>(handle);
    set_if_changed(built, row, index, buffer.serial, sizeof buffer.memory, &buffer.memory);
  }
  void set_value(BuiltKernel &built, const KernelRow &row, cl_uint index, cl_uint value)
  {
    set_if_changed(built, row, index, value_tag | value, sizeof value, &value);
  }
  void set_if_changed(BuiltKernel &built, const KernelRow &row, cl_uint index, uint64_t identity, size_t bytes,
                      const void *value)
  {
    if (built.arguments[index] == identity) return;
    const cl_int code =
        code_of(faults::Site::launch, [&] { return clSetKernelArg(built.kernel(), index, bytes, value); });
    if (code != CL_SUCCESS) fail(row, fmt::format("argument {}", index).c_str(), code);
    built.arguments[index] = identity;
  }

  void keep(Kernel kernel, cl_event event)
  {
    pending_.emplace_back(kernel, event);
    if (pending_.size() == most_events) collect_events();
  }

  void collect_events()
  {
    if (!pending_.empty()) finish();
    for (const auto &[kernel, event] : pending_) {
      cl_ulong start = 0, end = 0;
      clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start, nullptr);
      clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr);
      times_[index_of(kernel)].nanoseconds += static_cast<double>(end - start);
      ++times_[index_of(kernel)].launches;
      clReleaseEvent(event);
    }
    pending_.clear();
  }

  std::string name_;
  DeviceContext context_;
  DeviceStorage storage_;
  uint64_t finished_launches_ = 0; /* by the last wait for all of them */
  size_t group_size_;              /* of all kernels; 0: each kernel's own */
  PhaseMode phase_mode_;
  bool has_branches_; /* other devices than GPUs have no units left idle */
  size_t units_ = context_.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  std::map<Stage, Features> readable_; /* the features that the program of a stage reads */
  Programs programs_;
  std::map<Features, Build> builds_; /* by features */
  Build *current_ = nullptr;
  bool profiling_ = false;
  std::vector<std::pair<Kernel, cl_event>> pending_;
  std::vector<Time> times_ = std::vector<Time>(all_kernels());
  BackgroundBuild ahead_; /* the last member, because its thread uses the others */
};

} // namespace

std::unique_ptr<Backend> make_device_backend(const std::string &name, const Candidate &candidate)
{
  const minicl::ExactFloatingPoint environment;
  return std::make_unique<OpenclBackend>(name, candidate);
}

} // namespace tandem::opencl
