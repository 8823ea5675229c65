/* primitives.h - runs the parallel primitives of shared/parallel for tests: buffers, a backend, and random data. */
#pragma once

#include <cstdint>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "host/pipeline/primitives.h"
#include "host/runtime/launcher.h"
#include "host/runtime/make_backend.h"
#include "host/runtime/opencl/device_backend.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/opencl_device.h"

namespace tandem {

/* One backend with the buffers of the free-standing primitives. */
class Primitives {
public:
  explicit Primitives(std::unique_ptr<Backend> backend) : backend_(std::move(backend)), launcher(memory, *backend_)
  {
    std::vector<Kernel> kernels;
    for (size_t k = 0; k < kernel_count; ++k)
      if (row_of(kernel_at(k)).stage == Stage::parallel) kernels.push_back(kernel_at(k));
    backend_->prepare(0, kernels);
  }

  /* Sets the length that the device reads. */
  void set_length(uint32_t n)
  {
    std::vector<uint32_t> counts(COUNT_TOTAL, 0);
    counts[COUNT_ONE] = 1;
    counts[COUNT_LENGTH] = n;
    set(Buffer::counts, counts);
  }

  template <class T> void set(Buffer buffer, const std::vector<T> &values)
  {
    reserve(buffer, std::max<size_t>(values.size(), 1) * sizeof(T));
    memory.upload(buffer, values.data(), values.size() * sizeof(T));
  }

  /* Memory is new each time, so that sanitizers see its true end. */
  void reserve(Buffer buffer, size_t bytes)
  {
    memory.resize(buffer, 0);
    memory.resize(buffer, bytes);
  }

  template <class T> std::vector<T> get(Buffer buffer, size_t n) { return memory.read<T>(buffer, n); }
  const std::string &name() const { return backend_->name(); }

private:
  std::unique_ptr<Backend> backend_;

public:
  Memory memory; /* is destroyed before the backend whose storage it uses */
  DirectLauncher launcher;
};

/* Every order of items, several thread counts, and the OpenCL device of tests; without a device the test is not
 * complete. */
inline std::vector<std::unique_ptr<Primitives>> all_primitives()
{
  std::vector<std::unique_ptr<Primitives>> made;
  for (const char *name :
       {"serial", "serial:order=backward", "serial:order=shuffled", "tbb:threads=1", "tbb:threads=2", "tbb:threads=7"})
    made.push_back(std::make_unique<Primitives>(make_backend(name)));
  const opencl::Candidate *const device = find_test_device();
  if (!device) tests::leave_out_device("no OpenCL device");
  else made.push_back(std::make_unique<Primitives>(opencl::make_device_backend("cl", *device)));
  return made;
}

enum class Distribution { equal, sorted, reversed, few, random };
constexpr Distribution distributions[] = {Distribution::equal, Distribution::sorted, Distribution::reversed,
                                          Distribution::few, Distribution::random};

/* Keys that use every bit of T, except where the distribution says otherwise. */
template <class T> std::vector<T> keys_of(Distribution distribution, size_t n, uint32_t seed = 1)
{
  std::mt19937_64 engine(seed + n);
  std::vector<T> keys(n);
  const T step = n > 1 ? static_cast<T>(~T{0} / (n - 1)) : T{1};
  for (size_t i = 0; i < n; ++i) {
    switch (distribution) {
    case Distribution::equal: keys[i] = static_cast<T>(0x8badf00ddeadbeefull); break;
    case Distribution::sorted: keys[i] = static_cast<T>(i) * step; break;
    case Distribution::reversed: keys[i] = static_cast<T>(n - 1 - i) * step; break;
    case Distribution::few: keys[i] = static_cast<T>((engine() % 5) * 0x3333333333333333ull); break;
    case Distribution::random: keys[i] = static_cast<T>(engine()); break;
    }
  }
  return keys;
}

/* Lengths around the sizes at which the primitives change their algorithm. */
inline std::vector<uint32_t> lengths()
{
  std::vector<uint32_t> all = {0, 1, 2, 3, 31, 33, 100'003};
  for (uint32_t power : {256u, 1024u, 2048u, 4096u, 8192u, 65536u})
    for (uint32_t n : {power - 1, power, power + 1}) all.push_back(n);
  return all;
}

} // namespace tandem
