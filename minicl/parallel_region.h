/* parallel_region.h - runs the launches of a series by threads that come in once and stay until its last.
 *
 *   thread 0   [part 0][part 2] wait [ small launches, alone ][part 0] ..
 *   thread 1   [part 1]         wait . . . . . . . . . . . . .[part 1] ..
 *
 * A parallel_for for each launch wakes threads and lets them sleep again some 170 times a step. Here they wait for the
 * next launch with their eyes open, as the stages of Box3D do. The thread that ends a launch's last part opens the next
 * launch, and runs small ones alone. Whoever is there takes part: if TBB sends fewer threads than there could be, the
 * others take over their parts, so nothing hangs. Who runs what never changes a result.
 */
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace tandem::minicl {

/* What a series consists of, in the words of a region. */
class LaunchesOfRegion {
public:
  struct Range {
    uint32_t first = 0, last = 0;
    uint32_t items_of_part = 1;   /* at least */
    bool stays_on_thread = false; /* a thread gets the same share in every launch, for its cache */
  };
  virtual ~LaunchesOfRegion() = default;
  virtual size_t count() const = 0;
  /* It is asked when all launches before this one have ended. */
  virtual Range range_of(size_t launch) const = 0;
  virtual void run(size_t launch, uint32_t first, uint32_t last) = 0;
};

class ParallelRegion {
public:
  /* Series of at most so many launches allocate nothing. */
  ParallelRegion(uint32_t most_threads, size_t usual_launches);

  /* Runs small launches at once, up to the first that several threads share. `threads` is limited to the most. */
  void begin(LaunchesOfRegion &launches, uint32_t threads);
  uint32_t threads() const { return threads_; }
  bool has_ended() const { return open_.load(std::memory_order_acquire) == phases_; }
  /* Takes part until the last launch has ended. thread: below the number of threads, each at most once. */
  void take_part(uint32_t thread);

private:
  static constexpr size_t cache_line = 64;
  /* Parts that have ended are counted by clusters first, because a count that every thread changes goes from core to
   * core for each. Cluster c has the parts c, c + clusters, ... The counts go on to the end of a series. */
  static constexpr uint32_t clusters = 4;
  struct alignas(cache_line) Count {
    std::atomic<uint32_t> ended = 0;
  };
  struct alignas(cache_line) Phase {
    std::atomic<uint32_t> next = 0; /* part */
    LaunchesOfRegion::Range range;
    uint32_t parts = 0;
    std::array<uint32_t, clusters> last_part; /* of each cluster: the count with which the launch ends for it */
    uint32_t last_cluster = 0;
  };
  /* The launch up to which a thread's own share is taken, by itself or by another. */
  struct alignas(cache_line) Share {
    std::atomic<size_t> taken = 0;
  };

  void make_room(size_t launches);
  void open_after(size_t launch);
  uint32_t parts_of(const LaunchesOfRegion::Range &range) const;
  void run_units(size_t launch, uint64_t first, uint64_t last);
  void run_part(size_t launch, uint32_t part);
  void expect_parts_of(Phase &phase);
  bool ends_phase(const Phase &phase, uint32_t part);
  void run_any_parts(size_t launch);
  void run_share(size_t launch, uint32_t thread);
  void run_shares_left(size_t launch);
  void wait_for_end_of(size_t launch);

  uint32_t threads_ = 1;
  LaunchesOfRegion *launches_ = nullptr;
  size_t phases_ = 0;
  std::unique_ptr<Phase[]> phase_;
  size_t room_ = 0;
  std::atomic<uint32_t> present_ = 0; /* threads that have come */
  std::vector<Share> shares_;
  std::array<Count, clusters> parts_ended_;
  Count clusters_ended_;
  std::array<uint32_t, clusters> parts_expected_{}; /* of all launches up to the open one */
  uint32_t clusters_expected_ = 0;
  alignas(cache_line) std::atomic<size_t> open_ = 0; /* the launch that is being run */
};

} // namespace tandem::minicl
