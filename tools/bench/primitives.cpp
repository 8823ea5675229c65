/* primitives.cpp - times sorts and scans and checks their results against the standard library; see primitives.h. */
#include "tools/bench/primitives.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "host/pipeline/primitives.h"
#include "host/runtime/make_backend.h"
#include "host/runtime/recorder.h"

namespace tandem {
namespace {

constexpr int warm_up_calls = 2, timed_calls = 10;

/* Numbers without a pattern, the same in every run. */
std::vector<uint32_t> scrambled(uint32_t count)
{
  std::vector<uint32_t> values(count);
  uint32_t state = 12345;
  for (uint32_t &value : values) value = state = state * 1664525u + 1013904223u;
  for (uint32_t &value : values) value ^= value >> 16;
  return values;
}

/* One primitive on one backend with its own buffers. */
class PrimitiveBench {
public:
  using Call = std::function<void(Launcher &)>;

  PrimitiveBench(const std::string &backend, bool allow_inexact, uint32_t count, Call call)
      : backend_(make_backend(backend, allow_inexact)), launcher_(memory_, *backend_), call_(std::move(call))
  {
    Recorder recorder;
    call_(recorder);
    backend_->prepare(0, recorder.kernels);
    std::vector<uint32_t> counts(COUNT_TOTAL);
    counts[COUNT_ONE] = 1;
    counts[COUNT_LENGTH] = count;
    fill(Buffer::counts, counts);
  }
  ~PrimitiveBench() { backend_->finish(); }

  void fill(Buffer buffer, const std::vector<uint32_t> &values)
  {
    reserve(buffer, values.size());
    memory_.upload(buffer, values.data(), values.size() * sizeof(uint32_t));
  }
  void reserve(Buffer buffer, size_t words) { memory_.resize(buffer, words * sizeof(uint32_t)); }
  std::vector<uint32_t> contents(Buffer buffer, size_t words) { return memory_.read<uint32_t>(buffer, words); }

  /* Times repeated calls, each on fresh inputs that are on the backend before the clock starts. */
  std::vector<double> time(const std::function<void()> &make_inputs, const std::vector<Buffer> &inputs)
  {
    using Clock = std::chrono::steady_clock;
    std::vector<double> times;
    for (int k = 0; k < warm_up_calls + timed_calls; ++k) {
      make_inputs();
      for (const Buffer input : inputs) memory_.acquire(input, backend_->storage(), Access::in);
      backend_->finish();
      const Clock::time_point start = Clock::now();
      call_(launcher_);
      backend_->finish();
      if (k >= warm_up_calls) times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    return times;
  }

private:
  std::unique_ptr<Backend> backend_; /* outlives the memory, which releases its buffers there */
  Memory memory_;
  DirectLauncher launcher_;
  Call call_;
};

} // namespace

std::vector<double> bench_sort(const std::string &backend, uint32_t count, bool allow_inexact)
{
  PrimitiveBench bench(backend, allow_inexact, count, [count](Launcher &launcher) {
    sort_pairs(launcher, Buffer::primitive_a, Buffer::primitive_b, Buffer::primitive_c, Buffer::primitive_d,
               Buffer::sort_histogram, Buffer::scan_sums, COUNT_LENGTH, count, 0, 32);
  });
  const std::vector<uint32_t> keys = scrambled(count);
  std::vector<uint32_t> values(count);
  std::iota(values.begin(), values.end(), 0u);
  bench.reserve(Buffer::primitive_c, count);
  bench.reserve(Buffer::primitive_d, count);
  bench.reserve(Buffer::sort_histogram, histogram_words(count));
  bench.reserve(Buffer::scan_sums, scan_sum_words(histogram_words(count)));
  const auto make_inputs = [&] {
    bench.fill(Buffer::primitive_a, keys);
    bench.fill(Buffer::primitive_b, values);
  };
  const std::vector<double> times = bench.time(make_inputs, {Buffer::primitive_a, Buffer::primitive_b});
  const std::vector<uint32_t> sorted = bench.contents(Buffer::primitive_a, count),
                              order = bench.contents(Buffer::primitive_b, count);
  for (uint32_t i = 0; i < count; ++i)
    if (order[i] >= count || keys[order[i]] != sorted[i] || (i && sorted[i - 1] > sorted[i]))
      throw std::runtime_error("bench sort: the result is wrong on " + backend);
  return times;
}

std::vector<double> bench_scan(const std::string &backend, uint32_t count, bool allow_inexact)
{
  PrimitiveBench bench(backend, allow_inexact, count, [count](Launcher &launcher) {
    exclusive_scan(launcher, Buffer::primitive_a, Buffer::primitive_b, Buffer::scan_sums, COUNT_LENGTH, count);
  });
  std::vector<uint32_t> values = scrambled(count);
  bench.reserve(Buffer::primitive_b, size_t{count} + 1);
  bench.reserve(Buffer::scan_sums, scan_sum_words(count));
  const std::vector<double> times = bench.time([&] { bench.fill(Buffer::primitive_a, values); }, {Buffer::primitive_a});
  values.push_back(0);
  const auto saturated = [](uint32_t a, uint32_t b) {
    return uint32_t(std::min<uint64_t>(uint64_t{a} + b, UINT32_MAX));
  };
  std::exclusive_scan(values.begin(), values.end(), values.begin(), 0u, saturated); /* shared/parallel/scan.h */
  if (bench.contents(Buffer::primitive_b, size_t{count} + 1) != values)
    throw std::runtime_error("bench scan: the result is wrong on " + backend);
  return times;
}

std::vector<double> bench_copy(const std::string &backend, uint32_t count, bool allow_inexact)
{
  PrimitiveBench bench(backend, allow_inexact, count, [count](Launcher &launcher) {
    launcher.launch({Kernel::copy, {Buffer::primitive_a, Buffer::primitive_b}, {}, COUNT_ZERO, COUNT_LENGTH, count});
  });
  const std::vector<uint32_t> values = scrambled(count);
  bench.fill(Buffer::primitive_a, values);
  bench.reserve(Buffer::primitive_b, count);
  const std::vector<double> times = bench.time([] {}, {Buffer::primitive_a});
  if (bench.contents(Buffer::primitive_b, count) != values) throw std::runtime_error("a copy is wrong on " + backend);
  return times;
}

} // namespace tandem
