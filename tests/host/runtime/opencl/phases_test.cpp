/* Programs of phases: the text of the kernel, and series that one launch runs as single launches would. */
#include "host/pipeline/primitives.h"
#include "host/runtime/launcher.h"
#include "host/runtime/make_backend.h"
#include "host/runtime/opencl/device_backend.h"
#include "host/runtime/opencl/phases.h"
#include "tests/host/runtime/opencl/opencl_device.h"

using namespace tandem;

namespace {

constexpr uint32_t numbers = 3000;

/* Chains of launches, each of which reads what the one before wrote, over ranges of 0, 1 and many items. */
std::vector<uint32_t> numbers_of(Backend &backend)
{
  Memory memory;
  std::vector<uint32_t> counts(COUNT_TOTAL);
  counts[COUNT_LENGTH] = numbers;
  counts[COUNT_ONE] = 1;
  memory.resize(Buffer::counts, 4 * counts.size());
  memory.upload(Buffer::counts, counts.data(), 4 * counts.size());
  for (const Buffer buffer : {Buffer::primitive_a, Buffer::primitive_b, Buffer::primitive_c})
    memory.resize(buffer, 4 * (numbers + 1));
  DirectLauncher launcher(memory, backend);
  const auto launch = [&](Kernel kernel, const Slots &slots, const Values &values, uint32_t last) {
    launcher.launch({kernel, slots, values, COUNT_ZERO, last, numbers});
  };
  launcher.launch_in_series(counts, [&] {
    launch(Kernel::sequence, {Buffer::primitive_a}, {}, COUNT_LENGTH);
    for (uint32_t round = 1; round < 200; ++round) {
      launch(Kernel::difference, {Buffer::primitive_a, Buffer::primitive_b}, {}, COUNT_LENGTH);
      launch(Kernel::add_offset, {Buffer::primitive_b}, {7 * round}, COUNT_LENGTH);
      launch(Kernel::fill, {Buffer::primitive_b}, {~round}, COUNT_ZERO);
      launch(Kernel::fill, {Buffer::primitive_b}, {round}, COUNT_ONE);
      launch(Kernel::gather, {Buffer::primitive_a, Buffer::primitive_b, Buffer::primitive_c}, {}, COUNT_ONE);
      launch(Kernel::copy, {Buffer::primitive_b, Buffer::primitive_a}, {}, COUNT_LENGTH);
    }
  });
  backend.finish();
  std::vector<uint32_t> result = memory.read<uint32_t>(Buffer::primitive_a, numbers);
  result.push_back(memory.read<uint32_t>(Buffer::primitive_c, 1).front());
  return result;
}

std::unique_ptr<Backend> prepared_backend(const char *mode)
{
  const Environment environment("TANDEM_PHASES", mode);
  auto backend = opencl::make_device_backend("cl", test_device());
  backend->prepare(
      0, {Kernel::sequence, Kernel::difference, Kernel::add_offset, Kernel::fill, Kernel::gather, Kernel::copy});
  return backend;
}

} // namespace

TEST_CASE("a program of phases has a case for each kind, with the buffers of its slots and the words of its values")
{
  const std::string text =
      opencl::phases_source({{Kernel::fill, {Buffer::primitive_a}},
                             {Kernel::copy, {Buffer::primitive_a, Buffer::primitive_b}},
                             {Kernel::copy, {Buffer::primitive_b, Buffer::primitive_a}},
                             {Kernel::scan_in_order, {Buffer::primitive_b, Buffer::primitive_a, Buffer::scan_sums}}},
                            {Buffer::counts, Buffer::primitive_a, Buffer::primitive_b, Buffer::scan_sums}, false);
  const auto has = [&](const std::string &part) {
    INFO(text);
    REQUIRE(text.find(part) != text.npos);
  };
  has("case 0: phase_fill(buffer_primitive_a, row[5], FIRST_OF_PHASE, last, STRIDE_OF_PHASE); break;");
  has("case 1: phase_copy(buffer_primitive_a, buffer_primitive_b, FIRST_OF_PHASE, last, STRIDE_OF_PHASE); break;");
  has("case 2: phase_copy(buffer_primitive_b, buffer_primitive_a, FIRST_OF_PHASE, last, STRIDE_OF_PHASE); break;");
  const size_t copy = text.find("void phase_copy(");
  REQUIRE(copy != text.npos);
  REQUIRE(text.find("void phase_copy(", copy + 1) == text.npos); /* one function for both cases */
  has("case 3: FOR_EACH_GROUP(group) scan_in_order_group((__global const uint *)buffer_counts, (__global const uint "
      "*)buffer_primitive_b, (__global uint *)buffer_primitive_a, (__global uint *)buffer_scan_sums, row[5], row[6], "
      "row[7], row[8], local_memory, group);");
  has("__local uint local_memory[LARGER(SCAN_LOCAL_WORDS, 1)]");
}

TEST_CASE("a series in one launch gives what its launches give one by one, and makes far fewer")
{
  const auto joined = prepared_backend("together"), separate = prepared_backend("separate"),
             serial = make_backend("serial");
  const std::vector<uint32_t> right = numbers_of(*serial);
  REQUIRE(numbers_of(*separate) == right);
  REQUIRE(separate->launches == 1 + 199 * 6);
  for (int again = 0; again < 3; ++again) { /* with scripts and arguments of the time before */
    const uint64_t before = joined->launches;
    REQUIRE(numbers_of(*joined) == right);
    REQUIRE(joined->launches - before <= (1 + 199 * 6) / 60);
  }
}

TEST_CASE("the size of the only work-group changes nothing")
{
  const auto serial = make_backend("serial");
  const std::vector<uint32_t> right = numbers_of(*serial);
  for (const char *size : {"1", "7", "256"}) {
    const Environment environment("TANDEM_LOCAL_SIZE", size);
    const auto joined = prepared_backend("together");
    REQUIRE(numbers_of(*joined) == right);
    REQUIRE(joined->launches <= (1 + 199 * 6) / 60);
  }
}

TEST_CASE("a series in all groups of a launch, which wait for each other, gives what launches give one by one")
{
  const auto serial = make_backend("serial");
  const std::vector<uint32_t> right = numbers_of(*serial);
  for (const char *size : {"7", "64", "256"}) {
    const Environment environment("TANDEM_LOCAL_SIZE", size);
    const auto resident = prepared_backend("resident");
    for (int again = 0; again < 3; ++again) REQUIRE(numbers_of(*resident) == right);
    INFO("PoCL is not asked; parity.oclgrind.resident_groups has several groups without a GPU");
    REQUIRE((resident->resident_groups() > 1) == (test_device().info.type == "GPU"));
  }
}

TEST_CASE("a profile is of single kernels, whose launches are not joined then")
{
  const auto backend = prepared_backend("together");
  backend->set_profiling(true);
  numbers_of(*backend);
  const auto times = backend->take_kernel_times();
  REQUIRE(times[index_of(Kernel::difference)].launches == 199);
}

TEST_CASE("TANDEM_PHASES takes three words")
{
  const Environment environment("TANDEM_PHASES", "joined");
  REQUIRE_THROWS_AS(opencl::make_device_backend("cl", test_device()), InputError);
}
