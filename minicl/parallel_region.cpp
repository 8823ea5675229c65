/* parallel_region.cpp - see parallel_region.h. */
#include "minicl/parallel_region.h"

#include <algorithm>
#include <thread>

#include "minicl/pause.h"

namespace tandem::minicl {
namespace {

constexpr uint32_t looks_until_help = 256, looks_until_yield = 2048;
constexpr uint32_t parts_of_thread = 8; /* where items differ, so that threads end together */
constexpr uint32_t widest_lanes_of_all = 16;

uint32_t items_of_unit(const LaunchesOfRegion::Range &range) { return range.stays_on_thread ? widest_lanes_of_all : 1; }

} // namespace

ParallelRegion::ParallelRegion(uint32_t most_threads, size_t usual_launches) : shares_(most_threads)
{
  make_room(usual_launches);
}

void ParallelRegion::make_room(size_t launches)
{
  if (launches <= room_) return;
  phase_ = std::make_unique<Phase[]>(launches);
  room_ = launches;
}

void ParallelRegion::begin(LaunchesOfRegion &launches, uint32_t threads)
{
  threads_ = std::clamp<uint32_t>(threads, 1, static_cast<uint32_t>(shares_.size()));
  launches_ = &launches;
  phases_ = launches.count();
  make_room(phases_);
  for (size_t launch = 0; launch < phases_; ++launch) phase_[launch].next.store(0, std::memory_order_relaxed);
  present_.store(0, std::memory_order_relaxed);
  for (Count &parts : parts_ended_) parts.ended.store(0, std::memory_order_relaxed);
  clusters_ended_.ended.store(0, std::memory_order_relaxed);
  parts_expected_ = {};
  clusters_expected_ = 0;
  for (Share &share : shares_) share.taken.store(0, std::memory_order_relaxed);
  open_after(SIZE_MAX);
}

/* It is called by the one thread that ended the launch before. */
void ParallelRegion::open_after(size_t launch)
{
  for (++launch; launch < phases_; ++launch) {
    Phase &phase = phase_[launch];
    phase.range = launches_->range_of(launch);
    phase.parts = parts_of(phase.range);
    if (phase.parts > 1) {
      expect_parts_of(phase);
      break;
    }
    if (phase.parts == 1) launches_->run(launch, phase.range.first, phase.range.last);
  }
  open_.store(launch, std::memory_order_release);
}

uint32_t ParallelRegion::parts_of(const LaunchesOfRegion::Range &range) const
{
  const uint64_t items = range.last > range.first ? range.last - range.first : 0;
  const uint32_t most = range.stays_on_thread || threads_ == 1 ? threads_ : threads_ * parts_of_thread;
  return static_cast<uint32_t>(std::min<uint64_t>((items + range.items_of_part - 1) / range.items_of_part, most));
}

void ParallelRegion::run_units(size_t launch, uint64_t first, uint64_t last)
{
  const LaunchesOfRegion::Range &range = phase_[launch].range;
  const uint64_t items = range.last - range.first, unit = items_of_unit(range);
  const auto item_at = [&](uint64_t units) {
    return range.first + static_cast<uint32_t>(std::min(units * unit, items));
  };
  if (first < last) launches_->run(launch, item_at(first), item_at(last));
}

/* Units are whole lanes, where the items have any. Shares are equal or differ by one unit. That of a thread with a
 * share of its own is a piece from the front and one from the back: joints are sorted by type, and contacts of bodies
 * further up come later, so items take longer towards an end. */
void ParallelRegion::run_part(size_t launch, uint32_t part)
{
  const Phase &phase = phase_[launch];
  const uint64_t unit = items_of_unit(phase.range), items = phase.range.last - phase.range.first,
                 units = (items + unit - 1) / unit, least = units / phase.parts, larger = units % phase.parts;
  const auto of_parts = [&](uint64_t parts, uint64_t of_larger, uint64_t of_least) {
    return std::min(parts, larger) * of_larger + (parts - std::min(parts, larger)) * of_least;
  };
  const uint64_t after = uint64_t{part} + 1;
  if (!phase.range.stays_on_thread) {
    run_units(launch, of_parts(part, least + 1, least), of_parts(after, least + 1, least));
  } else {
    const uint64_t larger_front = (least + 2) / 2, least_front = (least + 1) / 2;
    const auto back = [&](uint64_t parts) {
      return units - of_parts(parts, least + 1 - larger_front, least - least_front);
    };
    run_units(launch, of_parts(part, larger_front, least_front), of_parts(after, larger_front, least_front));
    run_units(launch, back(after), back(part));
  }
  if (ends_phase(phase, part)) open_after(launch);
}

void ParallelRegion::expect_parts_of(Phase &phase)
{
  for (uint32_t cluster = 0; cluster < clusters; ++cluster)
    phase.last_part[cluster] = parts_expected_[cluster] += (phase.parts + clusters - 1 - cluster) / clusters;
  phase.last_cluster = clusters_expected_ += std::min(clusters, phase.parts);
}

/* Whether this part was the last of its launch to end. */
bool ParallelRegion::ends_phase(const Phase &phase, uint32_t part)
{
  const uint32_t cluster = part % clusters;
  if (parts_ended_[cluster].ended.fetch_add(1, std::memory_order_acq_rel) + 1 != phase.last_part[cluster]) return false;
  return clusters_ended_.ended.fetch_add(1, std::memory_order_acq_rel) + 1 == phase.last_cluster;
}

void ParallelRegion::run_any_parts(size_t launch)
{
  Phase &phase = phase_[launch];
  for (uint32_t part = phase.next.fetch_add(1, std::memory_order_relaxed); part < phase.parts;
       part = phase.next.fetch_add(1, std::memory_order_relaxed))
    run_part(launch, part);
}

void ParallelRegion::run_share(size_t launch, uint32_t thread)
{
  std::atomic<size_t> &taken = shares_[thread].taken;
  size_t until = taken.load(std::memory_order_relaxed);
  if (until > launch || !taken.compare_exchange_strong(until, launch + 1, std::memory_order_acq_rel)) return;
  run_part(launch, thread);
}

/* A thread that has not come, or that the system does not run, is helped. */
void ParallelRegion::run_shares_left(size_t launch)
{
  for (uint32_t thread = 0; thread < phase_[launch].parts; ++thread) run_share(launch, thread);
}

void ParallelRegion::wait_for_end_of(size_t launch)
{
  const bool has_shares = phase_[launch].range.stays_on_thread;
  if (has_shares && present_.load(std::memory_order_relaxed) < threads_) run_shares_left(launch);
  for (uint32_t looks = 1; open_.load(std::memory_order_acquire) == launch; ++looks)
    if (looks % looks_until_help == 0 && has_shares) run_shares_left(launch);
    else if (looks < looks_until_yield) pause_briefly();
    else std::this_thread::yield();
}

void ParallelRegion::take_part(uint32_t thread)
{
  present_.fetch_add(1, std::memory_order_relaxed);
  for (size_t launch = open_.load(std::memory_order_acquire); launch < phases_;
       launch = open_.load(std::memory_order_acquire)) {
    const Phase &phase = phase_[launch];
    if (!phase.range.stays_on_thread) run_any_parts(launch);
    else if (thread < phase.parts) run_share(launch, thread);
    wait_for_end_of(launch);
  }
}

} // namespace tandem::minicl
