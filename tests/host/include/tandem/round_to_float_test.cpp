/* round_to_float_test.cpp - roundings that compilers may leave out, compared with the right bits.
 *
 * The library's own code is tested, compiled as users get it; a test that rounds by itself would test the options of
 * the tests.
 */
#include <bit>
#include <cstdint>
#include <cstring>

#include <tandem/round_to_float.h>

#include "host/catalog/catalog.h"
#include "host/scene/body_buffers.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

/* The float nearest to a double between the normal floats, by whole numbers alone: of two equally near, the even
 * one. */
double nearest_float(double x)
{
  const uint64_t bits = std::bit_cast<uint64_t>(x), dropped = bits & 0x1fffffffu, half = 0x10000000u;
  const uint64_t kept = bits - dropped, step = 0x20000000u;
  const bool up = dropped > half || (dropped == half && (kept & step));
  return std::bit_cast<double>(kept + (up ? step : 0));
}

/* True for zero, too. */
bool holds_a_float(double x) { return (std::bit_cast<uint64_t>(x) & 0x1fffffffu) == 0; }

} // namespace

TEST_CASE("round to float: to the nearest, of two equally near to the even one", "[address]")
{
  uint64_t state = 1;
  for (int i = 0; i < 100000; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    const uint64_t exponent = 1023 - 100 + (state >> 32) % 200;
    const uint64_t tail = i % 4 == 0 ? 0x10000000u : state & 0x1fffffffu; /* a quarter lies half way */
    const double x = std::bit_cast<double>((state & 0x800fffffe0000000u) | exponent << 52 | tail);
    CAPTURE(x);
    REQUIRE(std::bit_cast<uint64_t>(static_cast<double>(round_to_float(x))) ==
            std::bit_cast<uint64_t>(nearest_float(x)));
  }
}

TEST_CASE("round to float: positions of built scenes hold floats, in every kind of scene", "[address]")
{
  for (const char *name :
       {"box-grid:nx=3,ny=2,nz=3", "falling-boxes:n=40", "spheres:n=40", "mixed:n=40", "box-stack:n=30,gap=0.3",
        "pyramid:rows=5,gap=0.07", "pyramid-2d:n=20,half_extent=0.3", "talk-3d:nx=3,ny=3,nz=3", "card-house:storeys=3",
        "tower:levels=4", "dominoes:n=9", "wall:rows=4", "bounce:n=9", "arch:courses=4"}) {
    const Scene scene = load_scene(name);
    CAPTURE(name);
    for (const Body &body : scene.bodies)
      for (const double x : body.position) {
        CAPTURE(x);
        CHECK(holds_a_float(x));
      }
  }
}

TEST_CASE("round to float: coordinates of a box-grid are those computed by whole numbers", "[address]")
{
  const Scene scene = load_scene("box-grid:nx=3,ny=2,nz=3");
  size_t body = 1;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 3; ++k, ++body) {
        const double shift = (j + 1) % 2;
        const volatile double x = shift + (i - 1) * 2.2,
                              z = shift + (k - 1) * 2.2; /* in memory: nothing is folded into what follows */
        CHECK(std::bit_cast<uint64_t>(scene.bodies[body].position[0]) == std::bit_cast<uint64_t>(nearest_float(x)));
        CHECK(std::bit_cast<uint64_t>(scene.bodies[body].position[2]) == std::bit_cast<uint64_t>(nearest_float(z)));
      }
}

TEST_CASE("round to float: a place keeps in its low part what the high part left over", "[address]")
{
  const Point points[] = {{1.1, 2.2, 3.3}, {1e6 + 1.0 / 3, -1e6 - 1.0 / 7, 1e-3 / 3}, {-0.7, 123456.789, 98765.4321}};
  for (const Point &p : points) {
    const std::array<float4, 2> place = double_float3_of(p);
    const float high[] = {place[0].x, place[0].y, place[0].z}, low[] = {place[1].x, place[1].y, place[1].z};
    for (size_t axis = 0; axis < 3; ++axis) {
      CAPTURE(p[axis]);
      const double left_over = p[axis] - nearest_float(p[axis]); /* exact */
      CHECK(double{high[axis]} == nearest_float(p[axis]));
      CHECK(double{low[axis]} == nearest_float(left_over));
      CHECK(low[axis] != 0);
    }
  }
}
