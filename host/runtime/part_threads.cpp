/* part_threads.cpp - see part_threads.h. */
#include "host/runtime/part_threads.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "host/runtime/first_failure.h"
#include "host/runtime/interface/debug.h"
#include "host/runtime/interface/floating_point.h"
#include "minicl/pause.h"
#include "minicl/thread_sanitizer.h"
#include "minicl/worker_threads.h"

namespace tandem {
namespace {

constexpr uint32_t looks_until_yield = 4096;

class OnePhase : public PhasesOfParts {
public:
  OnePhase(size_t parts, PartFunction function) : parts_(parts), function_(function) {}
  size_t phases() const override { return 1; }
  size_t parts_of(size_t) override { return parts_; }
  void run(size_t, size_t part) override { function_(part); }

private:
  size_t parts_;
  PartFunction function_;
};

void run_on_this_thread(PhasesOfParts &phases)
{
  const minicl::ExactFloatingPoint environment;
  for (size_t phase = 0; phase < phases.phases(); ++phase) {
    FirstFailure failure;
    const size_t parts = phases.parts_of(phase);
    for (size_t part = 0; part < parts; ++part) failure.run(part, [&] { phases.run(phase, part); });
    failure.rethrow();
  }
}

} // namespace

class PartThreads::Team {
public:
  explicit Team(uint32_t threads) : threads_(threads), arena_(static_cast<int>(threads)) {}

  void run(PhasesOfParts &phases)
  {
    phases_ = &phases;
    failure_ = std::make_unique<FirstFailure>();
    blocks_ = std::vector<Block>(phases.phases() * threads_);
    ended_ = std::vector<std::atomic<size_t>>(phases.phases());
    parts_.assign(phases.phases(), 0);
    open_.store(0, std::memory_order_relaxed);
    over_.store(false, std::memory_order_relaxed);
    open_from(0);
    if (!over_.load(std::memory_order_relaxed)) send_threads();
    failure_->rethrow();
  }

private:
  static constexpr size_t cache_line = 64;
  struct alignas(cache_line) Block {
    std::atomic<size_t> next = 0;
    size_t end = 0;
  };

  void send_threads()
  {
    minicl::LaunchOrder order;
    order.launch_begins();
    arena_.execute([&, step = uint64_t{step_of_launch}] {
      tbb::task_group_context own_group(tbb::task_group_context::isolated);
      tbb::parallel_for(
          uint32_t{0}, threads_,
          [&](uint32_t) TANDEM_UNWATCHED {
            order.items_begin();
            step_of_launch = step;
            const minicl::ExactFloatingPoint environment;
            take_part(static_cast<uint32_t>(tbb::this_task_arena::current_thread_index()) % threads_);
            order.items_end();
          },
          tbb::simple_partitioner{}, own_group);
    });
    order.launch_ends();
  }

  /* Opens the next phase that has parts. It is called by the one thread that ended the phase before. */
  void open_from(size_t phase)
  {
    for (; phase < parts_.size() && !failure_->has_happened(); ++phase) {
      failure_->run(0, [&] { parts_[phase] = phases_->parts_of(phase); });
      if (parts_[phase] == 0) continue;
      for (size_t k = 0; k < threads_; ++k) {
        Block &block = blocks_[phase * threads_ + k];
        block.next.store(parts_[phase] * k / threads_, std::memory_order_relaxed);
        block.end = parts_[phase] * (k + 1) / threads_;
      }
      return open_.store(phase + 1, std::memory_order_release);
    }
    over_.store(true, std::memory_order_release);
  }

  void take_part(uint32_t thread)
  {
    for (size_t seen = 0;;) {
      const size_t open = open_.load(std::memory_order_acquire);
      if (open > seen) {
        seen = open;
        for (uint32_t k = 0; k < threads_; ++k) run_block(open - 1, (thread + k) % threads_);
      }
      if (!wait_for_next(seen)) return;
    }
  }

  void run_block(size_t phase, uint32_t number)
  {
    Block &block = blocks_[phase * threads_ + number];
    for (size_t part = block.next.fetch_add(1, std::memory_order_relaxed); part < block.end;
         part = block.next.fetch_add(1, std::memory_order_relaxed)) {
      failure_->run(part, [&] { phases_->run(phase, part); });
      if (ended_[phase].fetch_add(1, std::memory_order_acq_rel) + 1 == parts_[phase]) open_from(phase + 1);
    }
  }

  /* Whether there is one. */
  bool wait_for_next(size_t seen) const
  {
    for (uint32_t looks = 0; open_.load(std::memory_order_acquire) == seen; ++looks) {
      if (over_.load(std::memory_order_acquire)) return open_.load(std::memory_order_acquire) != seen;
      if (looks < looks_until_yield) minicl::pause_briefly();
      else std::this_thread::yield();
    }
    return true;
  }

  uint32_t threads_;
  tbb::task_arena arena_;
  PhasesOfParts *phases_ = nullptr;
  std::unique_ptr<FirstFailure> failure_;
  std::vector<Block> blocks_;                        /* [phase, thread] */
  std::vector<std::atomic<size_t>> ended_;           /* parts of each phase */
  std::vector<size_t> parts_;                        /* of each phase that has been opened */
  alignas(cache_line) std::atomic<size_t> open_ = 0; /* the phase that runs, and one more */
  std::atomic<bool> over_ = false;
};

PartThreads::PartThreads(uint32_t threads) : threads_(threads) { minicl::want_threads(threads); }
PartThreads::PartThreads(PartThreads &&) noexcept = default;
PartThreads &PartThreads::operator=(PartThreads &&) noexcept = default;
PartThreads::~PartThreads() = default;

/* TBB warns of an arena that is larger than the number of threads that it may start. */
void PartThreads::run(PhasesOfParts &phases)
{
  if (threads_ == 1) return run_on_this_thread(phases);
  const size_t granted = minicl::settle_threads();
  if (!team_) team_ = std::make_unique<Team>(static_cast<uint32_t>(std::min<size_t>(threads_, granted)));
  team_->run(phases);
}

void PartThreads::run(size_t parts, PartFunction function)
{
  OnePhase phase(parts, function);
  if (parts <= 1) return run_on_this_thread(phase);
  run(phase);
}

} // namespace tandem
