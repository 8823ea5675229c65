/* Launches and transfers on an OpenCL device: fill, at every awkward length and offset of the buffer. */
#include <numeric>

#include <tandem/scene.h>

#include "host/runtime/make_backend.h"
#include "host/runtime/memory.h"
#include "host/runtime/opencl/device_backend.h"
#include "tests/host/runtime/opencl/opencl_device.h"

using namespace tandem;

namespace {

/* fill over [first, last) of primitive_a, on any backend. */
void run_fill(Backend &backend, Memory &memory, uint32_t first, uint32_t last, uint32_t value, uint32_t expected)
{
  std::vector<uint32_t> counts(COUNT_TOTAL);
  counts[COUNT_LENGTH] = last;
  counts[COUNT_SMALL] = first;
  if (memory.bytes(Buffer::counts) == 0) memory.resize(Buffer::counts, counts.size() * 4);
  memory.upload(Buffer::counts, counts.data(), counts.size() * 4);
  const Launch launch{Kernel::fill, {Buffer::primitive_a}, {value}, COUNT_SMALL, COUNT_LENGTH, expected};
  void *values = memory.acquire(Buffer::primitive_a, backend.storage(), Access::out);
  void *on_device = memory.acquire(Buffer::counts, backend.storage(), Access::in);
  backend.run(launch, {{values, 0}, {nullptr, value}}, on_device);
}

std::unique_ptr<Backend> prepared(const opencl::Candidate &device)
{
  auto backend = opencl::make_device_backend("cl", device);
  backend->prepare(0, {Kernel::fill});
  return backend;
}

} // namespace

TEST_CASE("fill on OpenCL writes its range and nothing else")
{
  const opencl::Candidate &device = test_device();
  const auto backend = prepared(device);
  for (const uint32_t length : {1u, 63u, 64u, 65u, 1000u, 5000u})
    for (const uint32_t expected : {0u, 1u, length, 10 * length}) {
      Memory memory;
      memory.resize(Buffer::primitive_a, (length + 2) * 4);
      run_fill(*backend, memory, 1, length + 1, 7, expected);
      std::vector<uint32_t> right(length + 2, 7);
      right.front() = right.back() = 0;
      REQUIRE(memory.read<uint32_t>(Buffer::primitive_a, length + 2) == right);
    }
}

TEST_CASE("any group size gives the same values on OpenCL")
{
  const opencl::Candidate &device = test_device();
  for (const char *size : {"1", "7", "32", "256"}) {
    const Environment environment("TANDEM_LOCAL_SIZE", size);
    const auto backend = prepared(device);
    Memory memory;
    memory.resize(Buffer::primitive_a, 4000);
    run_fill(*backend, memory, 0, 999, 3, 500);
    const auto values = memory.read<uint32_t>(Buffer::primitive_a, 1000);
    REQUIRE(std::accumulate(values.begin(), values.end(), 0u) == 3 * 999);
    REQUIRE(values.back() == 0);
  }
  const Environment environment("TANDEM_LOCAL_SIZE", "many");
  REQUIRE_THROWS_AS(opencl::make_device_backend("cl", device), InputError);
}

TEST_CASE("the last writer is read, whichever of host, MiniCL and OpenCL it was")
{
  const opencl::Candidate &device = test_device();
  const auto first = prepared(device), second = prepared(device);
  const auto serial = make_backend("serial");
  Memory memory;
  const uint32_t length = 20000;
  memory.resize(Buffer::primitive_a, length * 4);
  std::vector<uint32_t> right(length);
  uint32_t random = 1;
  for (uint32_t round = 0; round < 200; ++round) {
    random = random * 1664525u + 1013904223u;
    Backend &backend = *std::array<Backend *, 3>{first.get(), second.get(), serial.get()}[(random >> 20) % 3];
    const uint32_t begin = (random >> 8) % length, end = begin + (length - begin) / 2;
    run_fill(backend, memory, begin, end, round, length);
    std::fill(right.begin() + begin, right.begin() + end, round);
    if (round % 3 == 0) {
      memory.upload(Buffer::primitive_a, &random, 4, 4 * (round * 7));
      right[round * 7] = random;
    }
    if (round % 5 == 0) REQUIRE((memory.read<uint32_t>(Buffer::primitive_a, length) == right));
    if (round % 7 == 0) REQUIRE(memory.read<uint32_t>(Buffer::primitive_a, 1, begin).front() == right[begin]);
  }
  REQUIRE((memory.read<uint32_t>(Buffer::primitive_a, length) == right));
}

/* Rounds of four stretches, each of which a branch fills twice, after launches over all that take longer and before one
 * at the end. */
TEST_CASE("launches of branches wait for what came before, and what follows waits for them")
{
  const opencl::Candidate &device = test_device();
  const Environment always("TANDEM_BRANCHES", "always");
  const auto backend = prepared(device);
  constexpr uint32_t stretches = 4, stretch = 50000, length = stretches * stretch, starts = COLOR_START;
  std::vector<uint32_t> counts(COUNT_TOTAL);
  for (uint32_t k = 0; k <= stretches; ++k) counts[starts + k] = k * stretch;
  Memory memory;
  memory.resize(Buffer::primitive_a, length * 4);
  memory.resize(Buffer::counts, counts.size() * 4);
  memory.upload(Buffer::counts, counts.data(), counts.size() * 4);
  void *values = memory.acquire(Buffer::primitive_a, backend->storage(), Access::inout);
  void *on_device = memory.acquire(Buffer::counts, backend->storage(), Access::in);
  const auto fill = [&](uint32_t first, uint32_t last, uint32_t value, uint32_t branch) {
    const Launch launch{Kernel::fill,  {Buffer::primitive_a}, {value}, starts + first,
                        starts + last, stretch * stretches,   branch};
    backend->run(launch, {{values, 0}, {nullptr, value}}, on_device);
  };
  for (uint32_t round = 1; round <= 20; ++round) {
    for (int repeats = 0; repeats < 30; ++repeats) fill(0, stretches, 10 * round, 0);
    for (uint32_t k = 0; k < stretches; ++k) fill(k, k + 1, 10 * round + 9, k + 1);
    for (uint32_t k = 0; k < stretches; ++k) fill(k, k + 1, 10 * round + k, k + 1);
    if (round % 2 == 0) fill(1, 2, 10 * round + 7, 0);
    std::vector<uint32_t> right(length);
    for (uint32_t i = 0; i < length; ++i)
      right[i] = 10 * round + (round % 2 == 0 && i / stretch == 1 ? 7 : i / stretch);
    REQUIRE((memory.read<uint32_t>(Buffer::primitive_a, length) == right));
    values = memory.acquire(Buffer::primitive_a, backend->storage(), Access::inout);
  }
  const Environment wrong("TANDEM_BRANCHES", "sometimes");
  REQUIRE_THROWS_AS(opencl::make_device_backend("cl", device), InputError);
}

TEST_CASE("a device that shares the host's memory works in the host's bytes")
{
  const opencl::Candidate &device = test_device();
  const auto backend = prepared(device);
  if (!backend->storage().shares_host_memory()) tests::skip("this device does not share the host's memory");
  Memory memory;
  memory.resize(Buffer::primitive_a, 4096);
  const auto *host = static_cast<const uint32_t *>(memory.acquire(Buffer::primitive_a, host_storage(), Access::in));
  run_fill(*backend, memory, 0, 1024, 42, 1024);
  backend->finish();
  REQUIRE(std::count(host, host + 1024, 42u) == 1024);
}

TEST_CASE("a buffer made anew is not taken for the one it replaces")
{
  const opencl::Candidate &device = test_device();
  const auto backend = prepared(device);
  Memory memory;
  for (uint32_t round = 1; round < 50; ++round) {
    memory.resize(Buffer::primitive_a, 4096 + 4 * (round % 3));
    memory.resize(Buffer::counts, COUNT_TOTAL * 4 + 4 * (round % 2));
    run_fill(*backend, memory, 0, 1024, round, 1024);
    REQUIRE(memory.read<uint32_t>(Buffer::primitive_a, 1024) == std::vector<uint32_t>(1024, round));
  }
}

TEST_CASE("profiling times the kernels that ran, and only those")
{
  const opencl::Candidate &device = test_device();
  const auto backend = prepared(device);
  Memory memory;
  memory.resize(Buffer::primitive_a, 400000);
  run_fill(*backend, memory, 0, 100000, 1, 100000);
  const auto time_of_fill = [&] { return backend->take_kernel_times()[index_of(Kernel::fill)]; };
  REQUIRE(time_of_fill().launches == 0);
  backend->set_profiling(true);
  for (int i = 0; i < 5000; ++i) run_fill(*backend, memory, 0, 10, 2, 10);
  const auto times = backend->take_kernel_times();
  for (size_t k = 0; k < kernel_count; ++k) REQUIRE(times[k].launches == (kernel_at(k) == Kernel::fill ? 5000 : 0));
  REQUIRE(times[index_of(Kernel::fill)].nanoseconds > 0);
  REQUIRE(time_of_fill().launches == 0);
  backend->set_profiling(false);
  run_fill(*backend, memory, 0, 10, 2, 10);
  REQUIRE(time_of_fill().nanoseconds == 0);
}

TEST_CASE("an allocation that no device can hold is refused with its size and the device's name")
{
  const opencl::Candidate &device = test_device();
  const auto backend = prepared(device);
  try {
    Memory memory;
    backend->storage().allocate(Element::uint, size_t{1} << 52, nullptr);
    FAIL("4 PiB were allocated");
  } catch (const opencl::DeviceError &error) {
    REQUIRE(std::string(error.what()).find(std::to_string(size_t{1} << 52)) != std::string::npos);
    REQUIRE(std::string(error.what()).find(device.info.device_name) != std::string::npos);
  }
}

TEST_CASE("a kernel that was not prepared is not launched")
{
  const opencl::Candidate &device = test_device();
  const auto backend = opencl::make_device_backend("cl", device);
  REQUIRE_THROWS_AS(backend->run({Kernel::fill, {}, {}}, {}, nullptr), std::logic_error);
}
