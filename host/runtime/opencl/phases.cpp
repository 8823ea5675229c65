/* phases.cpp - see phases.h. */
#include "host/runtime/opencl/phases.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/runtime/interface/floating_point.h"
#include "host/runtime/opencl/program.h"
#include "shared/parallel/phase_limits.h"

namespace tandem::opencl {
namespace {

constexpr size_t least_gain = 4; /* fewer launches are not worth joining */
/* One work-group takes less time than a launch for so many items: a step of 1,000 boxes takes an H200 0.95 ms with 256,
 * 0.85 with 512, and 0.84 with 1,024 and with 2,048 (docs/results/2026-11-26-h200-phases). */
constexpr uint32_t items_of_phase = 1024;
/* Resident groups take less time for so many, about an item for each of theirs; where colours have more, launches are
 * as fast (docs/results/2026-11-26-h200-resident-groups). */
constexpr uint32_t items_of_resident_phase = 32768;
/* More items are faster in all groups: a step of 1,000 boxes takes 0.68 ms with 128 or 256, 0.87 with 512. Tests let
 * nearly all phases take them. */
constexpr uint32_t items_of_first_group = 256, items_of_first_group_in_tests = 8;

/* Where fewer launches have many items, a program for one group is faster: a step of 100 boxes takes it 0.37 ms, and
 * one with resident groups 0.45. */
constexpr double least_share_of_many_items = 1.0 / 16, series_remembered = 32;

constexpr size_t missed_until_look = 512;     /* some steps */
constexpr size_t missed_until_build = 50000;  /* some hundred steps; a shorter run would end by waiting for it */
constexpr size_t missed_until_rebuild = 5000; /* of a world that has run for long, and has new kinds of phases */

} // namespace

PhaseMode phase_mode_of_tests()
{
  const char *text = std::getenv("TANDEM_PHASES");
  if (!text || !*text) return PhaseMode::automatic;
  const std::string_view word = text;
  if (word == "separate") return PhaseMode::separate;
  if (word == "together") return PhaseMode::together;
  if (word == "resident") return PhaseMode::resident;
  throw InputError(fmt::format("TANDEM_PHASES '{}' is neither 'separate', 'together' nor 'resident'", word));
}

Phases::Phases(const DeviceContext &context, Features features, PhaseMode mode, size_t group_size)
    : context_(context), features_(features), mode_(mode), group_size_(group_size)
{}

void Phases::run(std::span<const BoundLaunch> series, void *counts, const RunAlone &run_alone, uint64_t &launches)
{
  take_built();
  note(series);
  build_if_worthwhile();
  while (!series.empty()) {
    const size_t count = joinable(series);
    if (count == 0) {
      run_alone(series.front());
    } else {
      program_->run(series.first(count), counts);
      ++launches;
    }
    series = series.subspan(std::max<size_t>(count, 1));
  }
}

/* The number of launches that the series begins with and that one launch can do. */
size_t Phases::joinable(std::span<const BoundLaunch> series) const
{
  if (!program_) return 0;
  size_t count = 0;
  while (count < std::min<size_t>(series.size(), MOST_PHASES) && joins(series[count])) ++count;
  return count < (joins_all() ? 1 : least_gain) ? 0 : count;
}

bool Phases::joins(const BoundLaunch &bound) const
{
  const uint32_t most = joins_all()                       ? UINT32_MAX
                        : program_->has_resident_groups() ? items_of_resident_phase
                                                          : items_of_phase;
  return bound.items <= most && program_->has(bound.launch);
}

/* A kind that a program was built for before is not missing: it has it, unless the device must go without. A series
 * counts whole, because a kind that is missing in its middle cuts it. */
void Phases::note(std::span<const BoundLaunch> series)
{
  if (series.size() < least_gain && !joins_all()) return;
  note_sizes(series);
  bool misses = known_.many_items && !tried_.many_items;
  for (const BoundLaunch &bound : series) {
    if (!lacks(bound)) continue;
    known_.kinds.insert(kind_of(bound.launch));
    misses = true;
  }
  if (misses) missed_ += series.size();
}

/* A single step says little: before the first one, counts are only what there is room for. */
void Phases::note_sizes(std::span<const BoundLaunch> series)
{
  if (mode_ != PhaseMode::automatic || !may_have_resident_groups()) return;
  const auto has_many = [](const BoundLaunch &bound) { return bound.items > items_of_phase; };
  const double share =
      static_cast<double>(std::count_if(series.begin(), series.end(), has_many)) / static_cast<double>(series.size());
  share_of_many_items_ += (share - share_of_many_items_) / series_remembered;
  known_.many_items = tried_.many_items || share_of_many_items_ > least_share_of_many_items;
}

bool Phases::lacks(const BoundLaunch &bound) const
{
  return !(program_ && program_->has(bound.launch)) && !tried_.kinds.contains(kind_of(bound.launch));
}

void Phases::build_if_worthwhile()
{
  if (ahead_.valid() || missed_ == 0) return;
  if (joins_all()) return build();
  const bool is_long = missed_ >= (program_ ? missed_until_rebuild : missed_until_build);
  if (!is_long && (looked_ || missed_ < missed_until_look)) return;
  looked_ = true;
  building_ = known_;
  ahead_ = std::async(std::launch::async, [this, wanted = building_, is_long] { return built(wanted, !is_long); });
}

void Phases::build()
{
  if (ahead_.valid()) ahead_.wait();
  take_built();
  if (known_ == tried_ && !failed_) return;
  program_ = built(known_, false);
  building_ = known_;
  failed_ = false;
  begin_to_count();
}

uint32_t Phases::most_items() const
{
  switch (mode_) {
  case PhaseMode::separate: return 0;
  case PhaseMode::together:
  case PhaseMode::resident: return UINT32_MAX;
  case PhaseMode::automatic: break;
  }
  if (context_.info.type != "GPU") return 0;
  return may_have_resident_groups() ? items_of_resident_phase : items_of_phase;
}

void Phases::do_without_resident_groups()
{
  if (ahead_.valid()) ahead_.wait();
  take_built();
  deadlocked_ = true;
  program_ = nullptr;
  known_ = tried_ = {};
}

bool Phases::may_have_resident_groups() const
{
  if (deadlocked_ || is_pocl(context_)) return false; /* PoCL's threads take one group after the other */
  return mode_ == PhaseMode::resident || (mode_ == PhaseMode::automatic && has_fence_between_groups(context_));
}

/* What a compiler says against the newer language is no reason to do without phases. */
std::unique_ptr<PhaseProgram> Phases::built(const Wanted &wanted, bool only_from_cache) const
{
  const bool resident = may_have_resident_groups() && (wanted.many_items || mode_ == PhaseMode::resident);
  try {
    return built(PhaseText(context_, features_, wanted.kinds, resident), only_from_cache);
  } catch (const BuildError &) {
    if (!resident || mode_ == PhaseMode::resident) throw;
    return built(PhaseText(context_, features_, wanted.kinds, false), only_from_cache);
  }
}

std::unique_ptr<PhaseProgram> Phases::built(const PhaseText &text, bool only_from_cache) const
{
  const minicl::ExactFloatingPoint environment; /* inherited by threads that the driver may start */
  try {
    if (only_from_cache && !is_cached(context_, text.program(), text.options)) return nullptr;
    const uint32_t first = mode_ == PhaseMode::resident ? items_of_first_group_in_tests : items_of_first_group;
    return std::make_unique<PhaseProgram>(context_, text, group_size_, first);
  } catch (const cl::Error &error) {
    throw DeviceError(fmt::format("OpenCL device {} ({}): creation of kernel run_phases failed: {} {}",
                                  context_.info.device_name, context_.info.platform_name, error.what(),
                                  error_name(error.err())));
  }
}

/* Launches do without a program that cannot be built in the background. */
void Phases::take_built()
{
  if (!ahead_.valid() || ahead_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  try {
    std::unique_ptr<PhaseProgram> program = ahead_.get();
    if (!program) return; /* it was not in the cache */
    program_ = std::move(program);
  } catch (const std::exception &) {
    failed_ = true;
  }
  begin_to_count();
}

/* What the program lacks is counted from its build on. */
void Phases::begin_to_count()
{
  tried_ = std::exchange(building_, {});
  missed_ = 0;
  looked_ = false;
}

} // namespace tandem::opencl
