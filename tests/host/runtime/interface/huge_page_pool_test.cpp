/* Buffers of the pool lie at small pages, apart from each other, and their places are used again. */
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "host/base/random.h"
#include "host/runtime/interface/huge_page_pool.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

struct Lent {
  char *memory;
  size_t bytes;
  char mark;
  bool is_whole() const
  {
    return std::all_of(memory, memory + bytes, [&](char byte) { return byte == mark; });
  }
};

} // namespace

TEST_CASE("huge page pool: buffers that come and go keep what is theirs")
{
  HugePagePool pool;
  Random random(1);
  std::vector<Lent> all;
  for (int k = 0; k < 2000; ++k) {
    if (all.size() > 40 || (!all.empty() && random.below(3) == 0)) {
      const size_t at = random.below(uint32_t(all.size()));
      REQUIRE(all[at].is_whole());
      REQUIRE(pool.release(all[at].memory));
      all.erase(all.begin() + std::ptrdiff_t(at));
      continue;
    }
    const size_t bytes = HugePagePool::least + random.below(uint32_t(HugePagePool::most - HugePagePool::least));
    all.push_back({static_cast<char *>(pool.allocate(bytes)), bytes, char(1 + k % 100)});
    REQUIRE(reinterpret_cast<uintptr_t>(all.back().memory) % 4096 == 0);
    std::memset(all.back().memory, all.back().mark, bytes);
  }
  for (const Lent &one : all) CHECK(one.is_whole());
}

TEST_CASE("huge page pool: what was given back is given again, whatever the order")
{
  HugePagePool pool;
  constexpr size_t quarter = HugePagePool::most; /* of a piece of 16 MiB */
  const auto fill = [&] {
    std::vector<void *> all;
    for (int k = 0; k < 4; ++k) all.push_back(pool.allocate(quarter));
    return all;
  };
  const std::vector<void *> first = fill();
  void *const kept = pool.allocate(HugePagePool::least); /* of another piece, which keeps this one's place its own */
  for (const size_t k : {2u, 0u, 3u}) REQUIRE(pool.release(first[k]));
  CHECK(pool.allocate(quarter) == first[0]);
  CHECK(pool.allocate(2 * quarter) == first[2]); /* two that were beside each other */
  CHECK(pool.release(kept));
}

TEST_CASE("huge page pool: memory of others is not its own")
{
  HugePagePool pool;
  void *const own = pool.allocate(HugePagePool::least);
  std::vector<char> other(64);
  CHECK_FALSE(pool.release(other.data()));
  CHECK_FALSE(pool.release(nullptr));
  CHECK(pool.release(own));
}
