/* The dispatcher hands each item of a range to exactly one thread and width, and a launch sees what the one before it wrote. */
#include "tests/catch.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "host/backend.h"

using namespace tandem;

namespace {

/* Fills [first, last) of the values through the backend. */
void fill(Backend &backend, std::vector<uint32_t> &values, uint32_t first, uint32_t last, uint32_t value)
{
  std::array<uint32_t, COUNT_TOTAL> counts{};
  counts[COUNT_GRID_X] = first;
  counts[COUNT_LENGTH] = last;
  Launch launch;
  launch.kernel = Kernel::fill;
  launch.first = COUNT_GRID_X;
  launch.last = COUNT_LENGTH;
  backend.run(launch, {{values.data(), 0}, {nullptr, value}}, counts.data());
  backend.finish();
}

bool all_equal(const std::vector<uint32_t> &values, uint32_t first, uint32_t last, uint32_t value)
{
  return std::all_of(values.begin() + first, values.begin() + last, [&](uint32_t v) { return v == value; });
}

} // namespace

TEST_CASE("every item of a range is written and none outside it", "[sanitizer]")
{
  for (const std::string name : {"serial", "serial:order=backward", "serial:order=shuffled", "tbb:threads=4,lanes=1",
                                 "tbb:threads=4,lanes=4", "tbb:threads=7"}) {
    const std::unique_ptr<Backend> backend = make_backend(name);
    for (uint32_t length : {0u, 1u, 255u, 256u, 257u, 5000u}) {
      const uint32_t first = 3, last = first + length;
      std::vector<uint32_t> values(last + 5, 1u);
      CAPTURE(name, length);
      fill(*backend, values, first, last, 2u);
      CHECK(all_equal(values, 0, first, 1u));
      CHECK(all_equal(values, first, last, 2u));
      CHECK(all_equal(values, last, last + 5, 1u));
    }
  }
}

TEST_CASE("a launch overwrites what other threads wrote in the one before", "[sanitizer]")
{
  const std::unique_ptr<Backend> backend = make_backend("tbb:threads=4");
  std::vector<uint32_t> values(20000, 0u);
  for (uint32_t round = 1; round <= 50; ++round) {
    fill(*backend, values, round, 20000u - 7u * round, round);
    CHECK(all_equal(values, round, 20000u - 7u * round, round));
  }
}
