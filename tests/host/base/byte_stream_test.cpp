/* Lists of more records than a block holds: threads write the bytes that one writes, nested lists too, and a reader
 * refuses blocks that do not hold what they say. */
#include <cstring>
#include <string>
#include <vector>

#include "host/base/byte_stream.h"
#include "host/base/hash.h"
#include "host/runtime/parts.h"
#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

struct Parcel {
  std::string name;
  uint16_t weight = 0;
  std::vector<std::string> stamps;

  bool operator==(const Parcel &) const = default;
};

template <class T, class Visit> auto visit_fields(T &parcel, const Visit &visit)
{
  auto &[name, weight, stamps] = parcel;
  return visit(name, weight, stamps);
}

std::vector<Parcel> parcels(size_t count)
{
  std::vector<Parcel> all(count);
  for (size_t k = 0; k < count; ++k) {
    all[k] = {std::string(k % 7, 'p'), static_cast<uint16_t>(k), {}};
    if (k % 1000 == 0) all[k].stamps.assign(k, "s");
  }
  return all;
}

std::vector<std::byte> written(const std::vector<Parcel> &list, RunParts run)
{
  ByteWriter writer({}, run);
  writer.put(list);
  writer.put(uint32_t{7});
  return writer.take();
}

std::vector<Parcel> read(const std::vector<std::byte> &bytes, RunParts run)
{
  ByteReader reader(bytes, "test", 0, run);
  const auto list = reader.get<std::vector<Parcel>>();
  CHECK(reader.get<uint32_t>() == 7);
  reader.expect_end();
  return list;
}

/* The length that stands before block 1 becomes another, and the blocks do not change. */
void set_second_length(std::vector<std::byte> &bytes, uint64_t change)
{
  uint64_t length = 0;
  std::memcpy(&length, &bytes[16], sizeof length);
  length += change;
  std::memcpy(&bytes[16], &length, sizeof length);
}

} // namespace

TEST_CASE("byte streams: lists of any length are read as they were written, on one thread and on several",
          "[sanitizer]")
{
  for (const size_t count : {size_t{0}, size_t{1}, block_records, block_records + 1, 2 * block_records, 9001ul}) {
    CAPTURE(count);
    const std::vector<Parcel> list = parcels(count);
    const std::vector<std::byte> bytes = written(list, run_parts_in_order);
    CHECK(written(list, run_parts) == bytes);
    CHECK(read(bytes, run_parts_in_order) == list);
    CHECK(read(bytes, run_parts) == list);
  }
}

TEST_CASE("byte streams: a block that is longer or shorter than its records is refused, the first of several",
          "[sanitizer]")
{
  const std::vector<std::byte> bytes = written(parcels(3 * block_records), run_parts);
  for (const RunParts run : {run_parts_in_order, RunParts{run_parts}}) {
    std::vector<std::byte> damaged = bytes;
    set_second_length(damaged, 1);
    CHECK_THROWS_WITH(read(damaged, run), ContainsSubstring("1 bytes follow the end of the contents"));
    damaged = bytes;
    set_second_length(damaged, ~uint64_t{0});
    CHECK_THROWS_WITH(read(damaged, run), ContainsSubstring("bytes are needed, and"));
    damaged = bytes;
    set_second_length(damaged, uint64_t{1} << 60);
    CHECK_THROWS_WITH(read(damaged, run), ContainsSubstring("bytes are needed, and"));
  }
}

TEST_CASE("byte streams: a count that cannot fit is refused before anything is allocated for it")
{
  ByteWriter writer;
  writer.put(uint64_t{1000});
  for (int k = 0; k < 2000; ++k) writer.put(uint64_t{0}); /* 18 bytes a parcel are needed */
  const std::vector<std::byte> bytes = writer.take();
  CHECK_THROWS_WITH(ByteReader(bytes, "test").get<std::vector<Parcel>>(), ContainsSubstring("does not fit into"));
  static_assert(least_bytes<Parcel>() == 18);
}

TEST_CASE("the hash of blocks depends on each byte, on their number, order and the seed, and not on threads",
          "[sanitizer]")
{
  std::vector<std::byte> bytes((size_t{2} << 20) + 5);
  const auto hash = [&](size_t count, uint64_t seed, RunParts run) {
    return hash_blocks(bytes.data(), count, seed, run);
  };
  const uint64_t whole = hash(bytes.size(), 3, run_parts_in_order);
  CHECK(hash(bytes.size(), 3, run_parts) == whole);
  CHECK(hash(bytes.size(), 4, run_parts) != whole);
  for (size_t count = 0; count < 64; ++count) CHECK(hash(bytes.size() - 1 - count, 3, run_parts) != whole);
  CHECK(hash(0, 1, run_parts) != hash(0, 2, run_parts));
  for (const size_t at : {size_t{0}, (size_t{1} << 20) - 1, size_t{1} << 20, bytes.size() - 1}) {
    CAPTURE(at);
    bytes[at] ^= std::byte{1};
    CHECK(hash(bytes.size(), 3, run_parts) != whole);
    bytes[at] ^= std::byte{1};
  }
  constexpr size_t block = size_t{1} << 20;
  bytes[7] = std::byte{1};
  const uint64_t in_the_first = hash(2 * block, 3, run_parts);
  std::swap(bytes[7], bytes[block + 7]);
  CHECK(hash(2 * block, 3, run_parts) != in_the_first);
}

TEST_CASE("parts: each runs once, and the exception of the lowest that fails is thrown", "[sanitizer]")
{
  for (const RunParts run : {run_parts_in_order, RunParts{run_parts}})
    for (const size_t count : {size_t{0}, size_t{1}, size_t{1000}}) {
      std::vector<int> runs(count);
      run(count, PartFunction([&](size_t part) { ++runs[part]; }));
      CHECK(runs == std::vector<int>(count, 1));
      const auto fail = [](size_t part) {
        if (part % 100 == 99) throw std::runtime_error("part " + std::to_string(part));
      };
      if (count == 1000) CHECK_THROWS_WITH(run(count, PartFunction(fail)), "part 99");
    }
}
