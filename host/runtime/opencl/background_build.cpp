/* background_build.cpp - see background_build.h. */
#include "host/runtime/opencl/background_build.h"

#include <chrono>

#include "host/runtime/interface/floating_point.h"

namespace tandem::opencl {

BackgroundBuild::~BackgroundBuild() { stops_ = true; }

void BackgroundBuild::begin(MissingPrograms missing, BuildOne build_one)
{
  failure_ = nullptr;
  built_kernels_ = kernels_ = 0;
  for (const auto &[key, kernels] : missing) kernels_ += kernels.size();
  thread_ = std::async(std::launch::async, [this, missing = std::move(missing), build_one = std::move(build_one)] {
    build(missing, build_one);
  });
}

void BackgroundBuild::build(const MissingPrograms &missing, const BuildOne &build_one)
{
  const minicl::ExactFloatingPoint environment; /* inherited by threads that the driver may start */
  for (const auto &[key, kernels] : missing) {
    if (stops_) return;
    const auto start = std::chrono::steady_clock::now();
    build_one(key, kernels, built_[key]);
    spent_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    built_kernels_ += kernels.size();
  }
}

bool BackgroundBuild::is_running() const
{
  return thread_.valid() && thread_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

Programs BackgroundBuild::take()
{
  if (!thread_.valid()) return {};
  try {
    thread_.get();
  } catch (...) {
    failure_ = std::current_exception();
  }
  milliseconds_ += std::exchange(spent_, 0);
  return std::exchange(built_, {});
}

void BackgroundBuild::tell_failure()
{
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

} // namespace tandem::opencl
