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

constexpr size_t least_gain = 4;              /* fewer launches are not worth joining */
constexpr size_t missed_until_look = 512;     /* some steps */
constexpr size_t missed_until_build = 50000;  /* some hundred steps; a shorter run would end by waiting for it */
constexpr size_t missed_until_rebuild = 5000; /* of a world that has run for long, and has new kinds of phases */

} // namespace

PhaseMode phase_mode_of_tests()
{
  const char *text = std::getenv("TANDEM_PHASES");
  if (!text || !*text) return PhaseMode::automatic;
  const std::string_view word = text;
  if (word != "separate" && word != "together")
    throw InputError(fmt::format("TANDEM_PHASES '{}' is neither 'separate' nor 'together'", word));
  return word == "separate" ? PhaseMode::separate : PhaseMode::together;
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
  while (count < std::min<size_t>(series.size(), MOST_PHASES) && program_->has(series[count].launch)) ++count;
  return count < (mode_ == PhaseMode::together ? 1 : least_gain) ? 0 : count;
}

/* A kind that a program was built for before is not missing: it has it, unless the device must go without. A series
 * counts whole, because a kind that is missing in its middle cuts it. */
void Phases::note(std::span<const BoundLaunch> series)
{
  if (series.size() < least_gain && mode_ != PhaseMode::together) return;
  bool misses = false;
  for (const BoundLaunch &bound : series) {
    if (program_ && program_->has(bound.launch)) continue;
    const PhaseKind kind = kind_of(bound.launch);
    if (tried_.contains(kind)) continue;
    known_.insert(kind);
    misses = true;
  }
  if (misses) missed_ += series.size();
}

void Phases::build_if_worthwhile()
{
  if (ahead_.valid() || missed_ == 0) return;
  if (mode_ == PhaseMode::together) return build();
  const bool is_long = missed_ >= (program_ ? missed_until_rebuild : missed_until_build);
  if (!is_long && (looked_ || missed_ < missed_until_look)) return;
  looked_ = true;
  building_ = known_;
  ahead_ = std::async(std::launch::async, [this, kinds = building_, is_long] { return built(kinds, !is_long); });
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

std::unique_ptr<PhaseProgram> Phases::built(const std::set<PhaseKind> &kinds, bool only_from_cache) const
{
  const minicl::ExactFloatingPoint environment; /* inherited by threads that the driver may start */
  try {
    const PhaseText text(context_, features_, kinds);
    if (only_from_cache && !is_cached(context_, text.program(), text.options)) return nullptr;
    return std::make_unique<PhaseProgram>(context_, text, group_size_);
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
