/* dispatcher.cpp - splits the range of a kernel over threads and lanes; see dispatcher.h. */
#include "minicl/dispatcher.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <memory>
#include <new>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "host/runtime/interface/built_features.h"
#include "host/runtime/interface/debug.h"
#include "host/runtime/interface/faults.h"
#include <tandem/error.h>
#include "host/runtime/interface/floating_point.h"
#include "minicl/kernel_table.h"
#include "minicl/launch_chains.h"
#include "minicl/parallel_region.h"
#include "minicl/reference_storage.h"
#include "minicl/thread_sanitizer.h"
#include "minicl/worker_threads.h"
#include "shared/parallel/length.h"
#include "shared/platform.h"

namespace tandem::minicl {

uint32_t widest_lanes()
{
#if defined(__x86_64__) && !defined(TANDEM_PORTABLE_KERNELS_ONLY)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bw"))
    return 16;
  if (__builtin_cpu_supports("avx2")) return 8;
#endif
  return 4;
}

const KernelTable *lanes_table(uint32_t lanes)
{
  if (lanes > widest_lanes()) return nullptr;
  switch (lanes) {
  case 4: return &lanes4_kernels;
#if !defined(TANDEM_PORTABLE_KERNELS_ONLY)
  case 8: return &lanes8_kernels;
  case 16: return &lanes16_kernels;
#endif
  default: return nullptr;
  }
}

namespace {

/* The approximate number of items in a task; small kernels stay on one thread. Threads that wait for the next launch
 * of a series cost less than tasks. */
constexpr uint32_t items_per_task = 128, items_per_part = 32;
/* A series whose largest launch has fewer is done sooner by one thread than others come: 100 boxes in 0.26 ms, and in
 * 0.45 by twelve. */
constexpr uint32_t items_worth_a_region = 1024;
/* A tree, or a contact or a joint of one, takes as long as many items of other kernels; so many share instructions. */
constexpr uint32_t trees_per_task = 8, items_like_a_tree = 32;
constexpr size_t launches_at_once = 512; /* a whole step of most scenes */
constexpr size_t arguments_of_usual_kernels = 16;

/* The table for one item at a time. Width 1 uses the plain one, with which parity tests compare the others. */
Width scalar_width([[maybe_unused]] const Options &options)
{
#if !defined(TANDEM_PORTABLE_KERNELS_ONLY)
  if (options.reference) return Width::reference;
  if (options.order != Backend::Order::forward) return Width::backward;
  if (options.lanes >= 8 && widest_lanes() >= 8) return Width::scalar_avx2;
#endif
  return Width::scalar;
}

Width lanes_width(uint32_t lanes) { return lanes == 4 ? Width::lanes4 : lanes == 8 ? Width::lanes8 : Width::lanes16; }

const KernelTable &pipeline_table(Width width)
{
  switch (width) {
#if !defined(TANDEM_PORTABLE_KERNELS_ONLY)
  case Width::scalar_avx2: return scalar_avx2_kernels;
  case Width::backward: return backward_kernels;
  case Width::reference: return reference_kernels;
  case Width::lanes8: return lanes8_kernels;
  case Width::lanes16: return lanes16_kernels;
#endif
  case Width::lanes4: return lanes4_kernels;
  default: return scalar_kernels;
  }
}

/* The functions of all modules, by the kernel's number; null where this width does not have one. */
std::vector<RunRange> compiled_ranges(Width width)
{
  const KernelTable &pipeline = pipeline_table(width);
  std::vector<RunRange> ranges(kernel_count);
  if (pipeline.run) std::copy_n(pipeline.run, kernel_count, ranges.begin());
  for (size_t i = 0; i < module_count(); ++i)
    for (size_t row = 0; row < module_at(i).kernels(); ++row) ranges.push_back(module_at(i).run(width, row));
  return ranges;
}

/* Items have no phases to be run in reverse, so the backward width takes those kernels as they are. */
std::vector<RunRange> ranges_of(Width width)
{
  std::vector<RunRange> ranges = compiled_ranges(width);
  if (width != Width::backward) return ranges;
  const std::vector<RunRange> scalar = compiled_ranges(Width::scalar);
  for (size_t i = 0; i < ranges.size(); ++i)
    if (!ranges[i]) ranges[i] = scalar[i];
  return ranges;
}

Storage &storage_for([[maybe_unused]] const Options &options)
{
#if !defined(TANDEM_PORTABLE_KERNELS_ONLY)
  if (options.reference) return reference_storage();
#endif
  return host_storage();
}

class MiniclBackend : public Backend {
public:
  MiniclBackend(const std::string &name, const Options &options)
      : name_(name), order_(options.order), threads_(options.threads), scalar_(ranges_of(scalar_width(options))),
        storage_(storage_for(options))
  {
    if (!options.reference && lanes_table(options.lanes))
      for (uint32_t lanes = options.lanes; lanes >= 4; lanes /= 2)
        lanes_.push_back({lanes, ranges_of(lanes_width(lanes))});
    want_threads(options.threads);
    if (threads_ == 1 && lanes_.empty()) return;
    chains_.reserve(launches_at_once);
    arguments_.reserve(launches_at_once * arguments_of_usual_kernels);
    first_argument_.reserve(launches_at_once);
  }

  const std::string &name() const override { return name_; }
  Storage &storage() override { return storage_; }
  /* A world has been refused before; tools launch kernels without one. */
  void prepare(Features features, const std::vector<Kernel> &kernels) override
  {
    if ((features & FEATURE_ARTICULATIONS) != 0) has_trees_ = true;
    for (const Kernel kernel : kernels)
      if (index_of(kernel) < kernel_count && (row_of(kernel).feature & ~built_features()) != 0)
        throw InputError(fmt::format("{}: this library is built without the kernel {} (-DTANDEM_FEATURES=\"{}\")",
                                     name_, row_of(kernel).name, built_option()));
  }
  void finish() override {}
  void set_profiling(bool on) override { profiling_ = on; }
  std::vector<Time> take_kernel_times() override { return std::exchange(times_, std::vector<Time>(times_.size())); }
  uint32_t threads_used() const
  {
    return static_cast<uint32_t>(std::popcount(threads_seen_.load(std::memory_order_relaxed)));
  }

  void run(const Launch &launch, const std::vector<BoundArgument> &bound, void *counts) override
  {
    if (faults::strikes(faults::Site::launch)) throw std::bad_alloc(); /* as if there were no memory for a task */
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = profiling_ ? Clock::now() : Clock::time_point(); /* launches may take less */
    arguments_.clear();
    append_arguments(launch, bound, arguments_);
    ++launches;
    const auto [first, last] = range_of(launch, static_cast<const uint32_t *>(counts));
    if (is_group(launch.kernel)) run_groups(launch.kernel, arguments_.data(), last);
    else if (last > first) run_items(launch.kernel, arguments_.data(), first, last);
    if (faults::strikes(faults::Site::launch)) throw std::bad_alloc(); /* and as if there were none for the last task */
    if (!profiling_) return;
    Time &time = times_[index_of(launch.kernel)];
    time.nanoseconds += std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    ++time.launches;
  }

  /* One thread takes series for their chains alone. */
  uint32_t most_items_of_series() const override
  {
    const bool takes_series = threads_ > 1 || (has_trees_ && !lanes_.empty());
    return takes_series && order_ == Order::forward && !profiling_ ? UINT32_MAX : 0;
  }
  size_t most_launches_of_series() const override { return launches_at_once; }

  /* The arena is opened by the first launch that is split. */
  void run_series(std::span<const BoundLaunch> series, void *counts) override
  {
    if ((threads_ > 1 && !arena_) || profiling_) return Backend::run_series(series, counts);
    size_t whole = 0;
    while (whole < series.size() && !faults::strikes(faults::Site::launch)) ++whole;
    run_whole(series.first(whole), static_cast<const uint32_t *>(counts));
    if (whole < series.size() || faults::strikes(faults::Site::launch)) throw std::bad_alloc();
  }

private:
  static bool is_group(Kernel kernel) { return row_of(kernel).execution == Execution::group; }
  static bool is_of_trees(Kernel kernel)
  {
    const KernelRow &row = row_of(kernel);
    return row.stage == Stage::articulations && (row.items == COUNT_ARTICULATIONS || row.items == items_given);
  }
  static uint32_t items_of_part(Kernel kernel)
  {
    if (is_group(kernel)) return 1;
    return is_of_trees(kernel) ? trees_per_task : items_per_part;
  }

  /* Of items, or of groups. */
  static std::pair<uint32_t, uint32_t> range_of(const Launch &launch, const uint32_t *counts)
  {
    const uint32_t first = counts[launch.first], last = counts[launch.last];
    if (!is_group(launch.kernel)) return {first, last};
    return {0, units_of(last - first, TILE)};
  }

  static void append_arguments(const Launch &launch, const std::vector<BoundArgument> &bound,
                               std::vector<void *> &arguments)
  {
    const KernelRow &row = row_of(launch.kernel);
    for (size_t i = 0; i < bound.size(); ++i)
      arguments.push_back(row.arguments[i].kind == Argument::Kind::value ? const_cast<uint32_t *>(&bound[i].value)
                                                                         : bound[i].handle);
  }

  void run_whole(std::span<const BoundLaunch> series, const uint32_t *counts)
  {
    launches += series.size();
    SeriesOfLaunches rows(*this, series, counts);
    const ExactFloatingPoint environment;
    if (threads_ == 1) return rows.run_alone();
    region_->begin(rows, threads_for(series));
    if (!region_->has_ended()) run_region();
    if (!region_->has_ended()) throw std::runtime_error("TBB left a series of launches before its end");
  }

  class SeriesOfLaunches : public LaunchesOfRegion {
  public:
    SeriesOfLaunches(MiniclBackend &backend, std::span<const BoundLaunch> series, const uint32_t *counts)
        : backend_(backend), series_(series), counts_(counts)
    {
      backend_.arguments_.clear();
      backend_.first_argument_.clear();
      for (const BoundLaunch &bound : series) {
        backend_.first_argument_.push_back(backend_.arguments_.size());
        append_arguments(bound.launch, bound.arguments, backend_.arguments_);
      }
      backend_.chains_.find(series);
    }
    size_t count() const override { return backend_.chains_.count(); }
    Range range_of(size_t chain) const override
    {
      const Launch &launch = series_[backend_.chains_.at(chain).first].launch;
      const auto [first, last] = MiniclBackend::range_of(launch, counts_);
      return {first, last, items_of_part(launch.kernel), !is_group(launch.kernel) && backend_.has_lanes(launch.kernel)};
    }
    void run(size_t number, uint32_t first, uint32_t last) override
    {
      const LaunchChains::Chain chain = backend_.chains_.at(number);
      if (chain.launches() == 1) return run_launch(chain.first, first, last);
      for_each_block_of_trees(first, last, [&](uint32_t begin, uint32_t end) {
        for (size_t launch = chain.first; launch < chain.last; ++launch) run_launch(launch, begin, end);
      });
    }
    void run_alone()
    {
      for (size_t chain = 0; chain < count(); ++chain) {
        const Range range = range_of(chain);
        if (range.last > range.first) run(chain, range.first, range.last);
      }
    }

  private:
    void run_launch(size_t launch, uint32_t first, uint32_t last) const
    {
      const Kernel kernel = series_[launch].launch.kernel;
      void *const *const arguments = backend_.arguments_.data() + backend_.first_argument_[launch];
      if (is_group(kernel)) backend_.groups_in_lanes(kernel)(arguments, first, last);
      else backend_.run_in_lanes(kernel, arguments, first, last);
    }

    MiniclBackend &backend_;
    std::span<const BoundLaunch> series_;
    const uint32_t *counts_;
  };

  /* More threads than the largest launch has parts would come for nothing. */
  static uint32_t threads_for(std::span<const BoundLaunch> series)
  {
    uint64_t items = 0;
    uint32_t parts = 1;
    for (const BoundLaunch &bound : series) {
      const Kernel kernel = bound.launch.kernel;
      items = std::max(items, uint64_t{bound.items} * (is_of_trees(kernel) ? items_like_a_tree : 1));
      parts = std::max(parts, bound.items / (is_group(kernel) ? TILE : items_of_part(kernel)) + 1);
    }
    return items < items_worth_a_region ? 1 : parts;
  }

  void run_region()
  {
    LaunchOrder order;
    order.launch_begins();
    arena_->execute([&, step = uint64_t{step_of_launch}] {
      tbb::parallel_for(
          tbb::blocked_range<uint32_t>(0, region_->threads(), 1),
          [&](const tbb::blocked_range<uint32_t> &thread) TANDEM_UNWATCHED {
            order.items_begin();
            step_of_launch = step;
            note_thread();
            const ExactFloatingPoint environment;
            region_->take_part(thread.begin());
            order.items_end();
          },
          tbb::simple_partitioner{});
    });
    order.launch_ends();
  }

  bool has_lanes(Kernel kernel) const
  {
    return std::any_of(lanes_.begin(), lanes_.end(),
                       [&](const Lanes &lanes) { return lanes.run.at(index_of(kernel)) != nullptr; });
  }

  /* What a group works on need not be a multiple of the width, so no narrower one takes the rest. */
  RunRange groups_in_lanes(Kernel kernel) const
  {
    const RunRange widest = lanes_.empty() ? nullptr : lanes_.front().run.at(index_of(kernel));
    return widest ? widest : scalar_.at(index_of(kernel));
  }

  void run_groups(Kernel kernel, void *const *arguments, uint32_t groups)
  {
    if (order_ != Order::forward) return run_permuted(scalar_.at(index_of(kernel)), arguments, 0, groups);
    const RunRange run = groups_in_lanes(kernel);
    parallel(0, groups, 1, tbb::auto_partitioner{},
             [&](uint32_t first, uint32_t last) { run(arguments, first, last); });
  }

  void run_items(Kernel kernel, void *const *arguments, uint32_t first, uint32_t last)
  {
    if (order_ != Order::forward) return run_permuted(scalar_.at(index_of(kernel)), arguments, first, last);
    const auto range = [&](uint32_t begin, uint32_t end) { run_in_lanes(kernel, arguments, begin, end); };
    const uint32_t grain = is_of_trees(kernel) ? trees_per_task : items_per_task;
    if (has_lanes(kernel)) parallel(first, last, grain, tbb::static_partitioner{}, range);
    else parallel(first, last, grain, tbb::auto_partitioner{}, range);
  }

  /* What is left by one width goes to the next: of 15 pairs 8 and 4 share instructions, and 3 have their own. */
  void run_in_lanes(Kernel kernel, void *const *arguments, uint32_t first, uint32_t last) const
  {
    if (row_of(kernel).execution == Execution::lanes_padded) return run_padded(kernel, arguments, first, last);
    for (const Lanes &lanes : lanes_) {
      const RunRange run = lanes.run.at(index_of(kernel));
      const uint32_t whole = run ? (last - first) / lanes.width * lanes.width : 0;
      if (whole) run(arguments, first, first + whole);
      first += whole;
    }
    if (first < last) scalar_.at(index_of(kernel))(arguments, first, last);
  }

  /* What is left by the widest is one more of its instructions. Narrower widths would take less time if their code were
   * in the caches; three contacts one after another take as long as 32 together. */
  void run_padded(Kernel kernel, void *const *arguments, uint32_t first, uint32_t last) const
  {
    const auto widest =
        std::find_if(lanes_.begin(), lanes_.end(), [&](const Lanes &lanes) { return lanes.run.at(index_of(kernel)); });
    (widest != lanes_.end() ? widest->run : scalar_).at(index_of(kernel))(arguments, first, last);
  }

  /* Items in lanes take about equally long, and the passes of a solver are alike: with equal shares each thread finds
   * its own items in its cache again. Kernels whose items differ are handed out in small pieces. */
  template <class Partitioner, class Body>
  void parallel(uint32_t first, uint32_t last, uint32_t grain, const Partitioner &partitioner, Body body)
  {
    const auto exact = [&](uint32_t begin, uint32_t end) {
      const ExactFloatingPoint environment;
      body(begin, end);
    };
    if (threads_ == 1 || last - first <= grain) return exact(first, last);
    open_arena();
    LaunchOrder order;
    order.launch_begins();
    arena_->execute([&, step = uint64_t{step_of_launch}] {
      tbb::parallel_for(
          tbb::blocked_range<uint32_t>(first, last, grain),
          [&](const tbb::blocked_range<uint32_t> &range) TANDEM_UNWATCHED {
            order.items_begin();
            step_of_launch = step;
            note_thread();
            exact(range.begin(), range.end());
            order.items_end();
          },
          partitioner);
    });
    order.launch_ends();
  }

  /* TBB warns of an arena that is larger than the number of threads that it may start. */
  void open_arena()
  {
    const size_t granted = settle_threads();
    if (arena_) return;
    const auto threads = static_cast<uint32_t>(std::min<size_t>(threads_, granted));
    region_.emplace(threads, launches_at_once); /* first, because the arena says that both are there */
    arena_.emplace(static_cast<int>(threads));
  }

  /* The bit is set without ordering threads, because the thread sanitizer would otherwise not see races. */
  void note_thread()
  {
    const uint32_t bit = uint32_t{1} << (tbb::this_task_arena::current_thread_index() % 32);
    if (!(threads_seen_.load(std::memory_order_relaxed) & bit)) threads_seen_.fetch_or(bit, std::memory_order_relaxed);
  }

  /* Runs every item once, from last to first or in an irregular order; results must not depend on it. */
  void run_permuted(RunRange run, void *const *arguments, uint32_t first, uint32_t last)
  {
    const ExactFloatingPoint environment;
    const uint64_t n = last - first;
    uint64_t stride = 1;
    if (order_ == Order::shuffled) {
      stride = n * 5 / 8 + 1;
      while (std::gcd(stride, n) != 1) ++stride;
    }
    for (uint64_t k = 0, at = n - 1; k < n; ++k, at = order_ == Order::shuffled ? (at + stride) % n : at - 1)
      run(arguments, first + static_cast<uint32_t>(at), first + static_cast<uint32_t>(at) + 1);
  }

  std::string name_;
  Order order_;
  std::optional<tbb::task_arena> arena_; /* opened by the first launch that is split */
  std::optional<ParallelRegion> region_; /* of as many threads as the arena */
  uint32_t threads_;
  struct Lanes {
    uint32_t width;
    std::vector<RunRange> run; /* by the kernel's number */
  };
  std::vector<RunRange> scalar_;       /* by the kernel's number */
  std::vector<Lanes> lanes_;           /* from the widest; none: one item at a time */
  std::vector<void *> arguments_;      /* of the launch or the series, so that it allocates nothing */
  std::vector<size_t> first_argument_; /* of each launch of the series */
  LaunchChains chains_;                /* of the series */
  bool has_trees_ = false;             /* whether a scene has asked for kernels of articulations */
  Storage &storage_;
  std::atomic<uint32_t> threads_seen_ = 0;
  bool profiling_ = false;
  std::vector<Time> times_ = std::vector<Time>(all_kernels());
};

} // namespace

uint32_t threads_of_machine() { return static_cast<uint32_t>(tbb::this_task_arena::max_concurrency()); }

std::unique_ptr<Backend> make_backend(const std::string &name, const Options &options)
{
#if defined(TANDEM_PORTABLE_KERNELS_ONLY)
  if (options.reference || options.order != Backend::Order::forward)
    throw InputError(
        name +
        ": this build has kernels neither in double nor in reverse; one without TANDEM_PORTABLE_KERNELS_ONLY has");
#endif
  Options filled = options;
  if (filled.threads == 0) filled.threads = threads_of_machine();
  if (filled.lanes == 0) filled.lanes = widest_lanes();
  return std::make_unique<MiniclBackend>(name, filled);
}

uint32_t threads_used(const Backend &backend) { return dynamic_cast<const MiniclBackend &>(backend).threads_used(); }

} // namespace tandem::minicl
