/* measure.cpp - times and profiles the steps of a run; see measure.h. */
#include "tools/command/measure.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>

#include <fmt/format.h>

#include "host/runtime/interface/kernel_list.h"

namespace tandem {
namespace {

constexpr uint64_t profile_every = 8;

/* If the last half is shorter than 8 steps, its last step is profiled; a single step is both timed and profiled. */
bool is_profiled(uint64_t step, uint64_t steps)
{
  const uint64_t half = steps - steps / 2;
  return step >= steps / 2 && (step - steps / 2) % profile_every == std::min(profile_every, half) - 1;
}

class StageTimes {
public:
  void add(const std::vector<KernelTime> &times)
  {
    for (const KernelTime &time : times) {
      if (time.launches == 0) continue;
      const Stage stage = row_of(time.kernel).stage;
      auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry &entry) {
        return entry.stage == stage && entry.time.backend == time.backend;
      });
      if (found == entries_.end()) found = entries_.insert(found, {stage, {name_of(stage), time.backend, 0}});
      found->time.milliseconds += time.milliseconds;
    }
  }
  std::vector<StageTime> per_step(uint64_t steps)
  {
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry &a, const Entry &b) { return a.stage < b.stage; });
    std::vector<StageTime> times;
    for (const Entry &entry : entries_) {
      times.push_back(entry.time);
      times.back().milliseconds /= static_cast<double>(std::max<uint64_t>(steps, 1));
    }
    return times;
  }

private:
  struct Entry {
    Stage stage;
    StageTime time;
  };
  std::vector<Entry> entries_;
};

} // namespace

template <class Steps> void prepare_for_timing(Steps &world)
{
  try {
    world.prepare_kernels();
  } catch (const std::runtime_error &error) {
    fmt::print(stderr, "tandem: launches are not joined: {}\n", error.what());
  }
}

template <class Steps> double timed_step(Steps &world)
{
  using Clock = std::chrono::steady_clock;
  world.finish();
  const Clock::time_point start = Clock::now();
  world.step();
  world.finish();
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

namespace {

template <class Steps> double profiled_step(Steps &world, StageTimes &stages)
{
  world.set_profiling(true);
  world.take_kernel_times();
  const double milliseconds = timed_step(world);
  stages.add(world.take_kernel_times());
  world.set_profiling(false);
  return milliseconds;
}

} // namespace

Spread spread_of(std::vector<double> values)
{
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  const double median = values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  return {median, values.front(), values.back()};
}

Json spread_json(const Spread &spread)
{
  return {{"median", spread.median}, {"min", spread.minimum}, {"max", spread.maximum}};
}

template <class Steps>
Measurement measure(Steps &world, uint64_t steps, const std::function<void(uint64_t done)> &after_step)
{
  std::vector<double> timed;
  StageTimes stages;
  Measurement result;
  for (uint64_t k = 0; k < steps; ++k) {
    if (k == steps / 2) prepare_for_timing(world);
    const uint64_t launches = world.launches(), moved = world.bytes_moved(), reads = world.device_reads();
    const bool profiled = is_profiled(k, steps);
    const double milliseconds = profiled ? profiled_step(world, stages) : timed_step(world);
    result.profiled_steps += profiled;
    if (k >= steps / 2 && (!profiled || steps - steps / 2 == 1)) {
      timed.push_back(milliseconds);
      result.launches += static_cast<double>(world.launches() - launches);
      result.bytes_moved += static_cast<double>(world.bytes_moved() - moved);
      result.device_reads += static_cast<double>(world.device_reads() - reads);
    }
    if (after_step) after_step(k + 1);
  }
  result.timed_steps = timed.size();
  const auto timed_steps = static_cast<double>(std::max<size_t>(timed.size(), 1));
  result.launches /= timed_steps;
  result.bytes_moved /= timed_steps;
  result.device_reads /= timed_steps;
  result.step_milliseconds = spread_of(timed);
  result.stages = stages.per_step(result.profiled_steps);
  return result;
}

#define INSTANTIATE(Steps)                                \
  template void prepare_for_timing<Steps>(Steps & world); \
  template double timed_step<Steps>(Steps & world);       \
  template Measurement measure<Steps>(Steps & world, uint64_t steps, const std::function<void(uint64_t)> &after_step);
INSTANTIATE(World)
INSTANTIATE(Worlds)
#undef INSTANTIATE

} // namespace tandem
