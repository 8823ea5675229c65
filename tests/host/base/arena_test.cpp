/* Pieces of an arena are apart, aligned, and never more than was reserved. */
#include <cstdint>

#include "host/base/arena.h"
#include "tests/catch.h"

using namespace tandem;

TEST_CASE("arena: pieces are aligned and keep what is written to them")
{
  Arena arena;
  arena.reserve(Arena::bytes_of<bool>(3) + Arena::bytes_of<double>(5) + Arena::bytes_of<uint32_t>(1));
  bool *const flags = arena.take<bool>(3);
  double *const numbers = arena.take<double>(5);
  uint32_t *const index = arena.take<uint32_t>(1);
  CHECK(reinterpret_cast<uintptr_t>(numbers) % alignof(double) == 0);
  for (int k = 0; k < 3; ++k) flags[k] = k == 1;
  for (int k = 0; k < 5; ++k) numbers[k] = 0.5 - k;
  *index = 0xffffffff;
  for (int k = 0; k < 3; ++k) CHECK(flags[k] == (k == 1));
  for (int k = 0; k < 5; ++k) CHECK(numbers[k] == 0.5 - k);
  CHECK(*index == 0xffffffff);
}

TEST_CASE("arena: no more is taken than was reserved, and all of it again once it is cleared")
{
  Arena arena;
  CHECK_THROWS_AS(arena.take<double>(1), std::logic_error);
  arena.reserve(Arena::bytes_of<double>(4));
  double *const first = arena.take<double>(2);
  CHECK_THROWS_AS(arena.take<double>(3), std::logic_error);
  arena.take<double>(2);
  CHECK_THROWS_AS(arena.take<bool>(1), std::logic_error);
  arena.clear();
  CHECK(arena.take<double>(4) == first);
}

TEST_CASE("arena: a smaller reservation keeps the memory of a larger one")
{
  Arena arena;
  arena.reserve(Arena::bytes_of<double>(100));
  double *const first = arena.take<double>(100);
  arena.reserve(Arena::bytes_of<double>(10));
  CHECK(arena.take<double>(100) == first);
}
