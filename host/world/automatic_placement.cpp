/* automatic_placement.cpp - see automatic_placement.h. */
#include "host/world/automatic_placement.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "host/runtime/memory.h"
#include "host/world/step_parts.h"

namespace tandem {
namespace {

constexpr const char *cpu = "tbb";

bool names_device(const Placement &asked) { return asked.on.starts_with("cl"); }

std::string on_cpu(const Placement &asked) { return names_device(asked) ? cpu : asked.on; }

} // namespace

Placement AutomaticPlacement::first_of(const Placement &asked)
{
  Placement placement = asked;
  if (asked.automatic) placement.on = on_cpu(asked);
  placement.automatic = false;
  return placement;
}

AutomaticPlacement::AutomaticPlacement(const Placement &asked) : asked_(asked)
{
  stages_[0].resize(all_stages());
  stages_[1].resize(all_stages());
  if (names_device(asked)) return;
  no_device_ = "no OpenCL device is named to choose from (--on cl)";
  choice_.stay_on_cpu();
}

/* Exceptions of the user come last, so that they hold in every candidate. */
Placement AutomaticPlacement::placement_of(Candidate candidate) const
{
  if (candidate == Candidate::cpu) return first_of(asked_);
  Placement placement = asked_;
  placement.automatic = false;
  if (candidate == Candidate::device) return placement;
  std::vector<std::pair<std::string, std::string>> exceptions;
  for (size_t s = 0; s < cut_.on_device.size(); ++s)
    if (!cut_.on_device[s]) exceptions.emplace_back(name_of(static_cast<Stage>(s)), cpu);
  placement.exceptions.insert(placement.exceptions.begin(), exceptions.begin(), exceptions.end());
  return placement;
}

void AutomaticPlacement::look_for_device(PlacedBackends &backends, const std::vector<Kernel> &kernels)
{
  if (choice_.is_building() && backends.is_built(placement_of(Candidate::device), kernels)) choice_.device_is_built();
}

bool AutomaticPlacement::has_looked_for_device(PlacedBackends &backends, const std::vector<Kernel> &kernels)
{
  look_for_device(backends, kernels);
  return !choice_.is_building();
}

std::optional<Placement> AutomaticPlacement::wanted() const
{
  return choice_.next() == placed_ ? std::nullopt : std::optional(placement_of(choice_.next()));
}

void AutomaticPlacement::device_fails(const std::string &why)
{
  no_device_ = why;
  choice_.stay_on_cpu();
}

double AutomaticPlacement::now() const
{
  if (asked_.clock) return asked_.clock();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/* Only steps that measure something wait for the devices. */
void AutomaticPlacement::begin_step(PlacedBackends &backends, bool observed)
{
  began_.reset();
  if (observed || backends.is_waiting() || backends.is_profiling() || placed_ != choice_.next()) return;
  if (!choice_.is_settled()) backends.finish_launches();
  profiles_ = choice_.profiles_next();
  if (profiles_) backends.set_profiling(true);
  began_ = now();
}

/* Kernels for a broadphase that the step has chosen may be waited for since it began. */
void AutomaticPlacement::end_step(PlacedBackends &backends, const Scene &scene)
{
  if (!began_) return;
  if (!choice_.is_settled()) backends.finish_launches();
  const double milliseconds = now() - *began_;
  if (profiles_) take_stage_times(backends, choice_.next());
  if (!backends.is_waiting())
    choice_.note_step(milliseconds, uint64_t{scene.bodies_awake} + scene.plan.known[COUNT_PAIRS]);
  if (choice_.awaits_cut()) look_for_cut(scene);
}

void AutomaticPlacement::abandon_step(PlacedBackends &backends)
{
  if (profiles_) backends.set_profiling(false);
  profiles_ = false;
  began_.reset();
}

void AutomaticPlacement::take_stage_times(PlacedBackends &backends, Candidate candidate)
{
  std::vector<double> &stages = stages_[static_cast<size_t>(candidate)];
  std::fill(stages.begin(), stages.end(), 0.0);
  for (const KernelTime &time : backends.take_kernel_times())
    stages[static_cast<size_t>(row_of(time.kernel).stage)] += time.milliseconds;
  backends.set_profiling(false);
  profiles_ = false;
}

/* What a whole step takes beside its kernels, launches above all, counts for its stages in proportion. */
std::vector<double> AutomaticPlacement::scaled_stages(Candidate candidate) const
{
  std::vector<double> stages = stages_[static_cast<size_t>(candidate)];
  const double sum = std::accumulate(stages.begin(), stages.end(), 0.0);
  for (double &stage : stages) stage *= sum > 0 ? choice_.milliseconds_of(candidate).value_or(sum) / sum : 1;
  return stages;
}

/* A crossing takes what bytes or what buffers have taken so far, whichever is more. */
void AutomaticPlacement::look_for_cut(const Scene &scene)
{
  LaunchRecord record;
  launch_step(record, scene.plan, scene.settings);
  const Moves &moves = scene.memory.moves();
  const auto bytes_of = [&](Buffer buffer) -> uint64_t {
    const UsedPart part = part_in_use(buffer, scene.memory.bytes(buffer),
                                      {scene.bodies, scene.plan.known[COUNT_PAIRS], scene.plan.features});
    return part.planes * part.bytes;
  };
  const auto crossing_milliseconds = [&](const std::vector<bool> &on_device) {
    const Crossings crossings = crossings_of(record, on_device, bytes_of);
    if (moves.bytes == 0) return 0.0;
    return moves.milliseconds * std::max(static_cast<double>(crossings.bytes) / static_cast<double>(moves.bytes),
                                         static_cast<double>(crossings.buffers) / static_cast<double>(moves.buffers));
  };
  const std::optional<StageCut> cut =
      find_cut(scaled_stages(Candidate::cpu), scaled_stages(Candidate::device), crossing_milliseconds);
  if (cut) cut_ = *cut;
  choice_.offer_cut(cut ? std::optional(cut->milliseconds) : std::nullopt);
}

std::string AutomaticPlacement::text_of(Candidate candidate) const
{
  if (candidate == Candidate::cpu) return on_cpu(asked_);
  if (candidate == Candidate::device) return asked_.on;
  std::string stages;
  for (size_t s = 0; s < cut_.on_device.size(); ++s)
    if (!cut_.on_device[s] && stages_[0][s] > 0)
      stages += fmt::format("{}{}", stages.empty() ? "" : ", ", name_of(static_cast<Stage>(s)));
  return fmt::format("{} with {} on {}", asked_.on, stages, cpu);
}

std::string AutomaticPlacement::why() const
{
  if (!no_device_.empty()) return no_device_;
  if (choice_.is_building()) return fmt::format("until the kernels of {} are built", asked_.on);
  if (!choice_.is_settled()) return "while all are being measured";
  return fmt::format("the fastest of those measured with {} bodies and pairs", choice_.size_when_chosen());
}

PlacementReport AutomaticPlacement::report() const
{
  PlacementReport report{text_of(choice_.next()), why(), choice_.is_settled(), {}, {}, {}};
  for (const Candidate candidate : {Candidate::cpu, Candidate::device, Candidate::cut})
    if (const std::optional<double> time = choice_.milliseconds_of(candidate))
      report.times.push_back({text_of(candidate), *time});
  for (size_t s = 0; s < stage_count; ++s)
    if (stages_[0][s] > 0 || stages_[1][s] > 0)
      report.stages.push_back({name_of(static_cast<Stage>(s)), stages_[0][s], stages_[1][s]});
  return report;
}

} // namespace tandem
