/* Every broadphase finds the pairs of an oracle on the host, in its order: random boxes of one size and of sizes over
 * six decades, coincident, in a row, in a plane, far away, without thickness, and dense clusters that exceed the pair
 * capacity. */
#include <cmath>

#include "host/runtime/make_backend.h"
#include "host/runtime/opencl/device_backend.h"
#include "tests/host/runtime/opencl/opencl_device.h"
#include "tests/parity/parity.h"
#include "tests/shared/broadphase/random_boxes.h"

using namespace tandem;

namespace {

using MakeBoxes = RandomBoxes (*)(uint32_t n, Random &random);

Vec3 uniform3(Random &random, double low, double high)
{
  return {float(random.uniform(low, high)), float(random.uniform(low, high)), float(random.uniform(low, high))};
}

void add_around(RandomBoxes &boxes, const Vec3 &center, const Vec3 &half, Random &random)
{
  const uint32_t motion = random.below(8) == 0 ? BODY_TYPE_FIXED : BODY_TYPE_DYNAMIC,
                 mask = random.below(8) == 0 ? 2u : 0xffffffffu;
  boxes.add({center[0] - half[0], center[1] - half[1], center[2] - half[2]},
            {center[0] + half[0], center[1] + half[1], center[2] + half[2]}, motion, 1u << random.below(3), mask);
}

/* About four neighbours each. */
RandomBoxes of_one_size(uint32_t n, Random &random)
{
  RandomBoxes boxes;
  const double side = std::cbrt(2.0 * n);
  boxes.add_half_space();
  for (uint32_t i = 0; i < n; ++i) add_around(boxes, uniform3(random, 0, side), uniform3(random, 0.3, 0.5), random);
  return boxes;
}

/* Halves from a millimetre to a kilometre: one in twenty above a metre, one in a thousand above thirty. */
double any_size(Random &random)
{
  const double kind = random.uniform(), within = random.uniform();
  if (kind < 0.95) return 1e-3 * std::pow(1e3, within);
  return kind < 0.999 ? std::pow(30, within) : 30 * std::pow(1000.0 / 30, within);
}

/* The largest quarter comes first, some of them as `large`; the others are in any order. */
RandomBoxes of_all_sizes(uint32_t n, Random &random)
{
  RandomBoxes boxes;
  std::vector<double> sizes;
  for (uint32_t i = 0; i < n; ++i) sizes.push_back(any_size(random));
  std::sort(sizes.begin(), sizes.begin() + n / 4, std::greater<>());
  const double side = 4 * std::cbrt(double(n));
  for (const double size : sizes)
    add_around(boxes, uniform3(random, -side, side), uniform3(random, 0.3 * size, size), random);
  boxes.large = std::min(n, 20u);
  boxes.hybrid_cell = 0.05f;
  return boxes;
}

RandomBoxes in_one_place(uint32_t n, Random &random)
{
  RandomBoxes boxes;
  for (uint32_t i = 0; i < std::min(n, 600u); ++i) add_around(boxes, {3, -7, 11}, {0.5f, 0.5f, 0.5f}, random);
  return boxes;
}

/* Neighbours touch exactly. */
RandomBoxes in_a_row(uint32_t n, Random &random)
{
  RandomBoxes boxes;
  for (uint32_t i = 0; i < n; ++i) add_around(boxes, {float(i), 0, 0}, {0.5f, 0.5f, 0.5f}, random);
  return boxes;
}

/* Flat boxes, edges and points, many of them on one another's sides. */
RandomBoxes without_thickness(uint32_t n, Random &random)
{
  RandomBoxes boxes;
  const double side = std::sqrt(double(n));
  for (uint32_t i = 0; i < n; ++i) {
    Vec3 center{float(random.below(uint32_t(side) + 1)), 0, float(random.below(uint32_t(side) + 1))};
    Vec3 half{0.5f, 0, 0.5f};
    if (i % 3 == 1) half[0] = 0;
    if (i % 3 == 2) half = {0, 0, 0};
    add_around(boxes, center, half, random);
  }
  return boxes;
}

/* Boxes a thousand kilometres away, and a few near the origin, along a diagonal, so that no axis separates them as well
 * as the diagonal does. */
RandomBoxes far_away(uint32_t n, Random &random)
{
  RandomBoxes boxes;
  for (uint32_t i = 0; i < n; ++i) {
    const float along = float(1e6 - random.uniform(0, double(n)));
    add_around(boxes, i % 50 == 0 ? uniform3(random, -1, 1) : Vec3{along, -along, along}, uniform3(random, 0, 3),
               random);
  }
  return boxes;
}

/* Bounds that fast bodies sweep: long and thin, each along one axis. */
RandomBoxes of_fast_bodies(uint32_t n, Random &random)
{
  RandomBoxes boxes;
  const double side = 3 * std::cbrt(double(n));
  for (uint32_t i = 0; i < n; ++i) {
    Vec3 half = uniform3(random, 0.1, 0.3);
    half[random.below(3)] = float(random.uniform(0, side / 3));
    add_around(boxes, uniform3(random, 0, side), half, random);
  }
  return boxes;
}

struct Kind {
  const char *name;
  MakeBoxes make;
  bool suits_all; /* false: some large or far body makes the grid's cells or the sweep's intervals hold most of the
                     others */
};
constexpr Kind kinds[] = {{"one size", of_one_size, true},   {"all sizes", of_all_sizes, false},
                          {"one place", in_one_place, true}, {"a row", in_a_row, true},
                          {"flat", without_thickness, true}, {"far away", far_away, false},
                          {"fast", of_fast_bodies, false}};

/* brute-force looks at every two: so many that more of them would prove nothing more. */
constexpr uint32_t most_by_brute_force = 10000;

/* Those that take n log n whatever the boxes. */
bool is_never_dense(const BroadphaseRow &broadphase)
{
  return broadphase.launch == find_pairs_in_hybrid || broadphase.launch == find_pairs_by_skipping ||
         broadphase.launch == find_pairs_in_trees;
}

void check_all(BroadphaseRunner &runner, const RandomBoxes &boxes, const BodyPairs &expected, bool suits_all = true)
{
  runner.take(boxes);
  for (const BroadphaseRow &broadphase : broadphases()) {
    if (boxes.size() > most_by_brute_force &&
        (broadphase.launch == find_pairs_by_brute_force || !(suits_all || is_never_dense(broadphase))))
      continue;
    CAPTURE(broadphase.name, runner.name());
    const BodyPairs found = runner.find(broadphase);
    CHECK(found.size() == expected.size());
    CHECK(found == expected);
  }
}

} // namespace

TEST_CASE("broadphases find the pairs of the oracle in any soup")
{
  std::vector<std::unique_ptr<BroadphaseRunner>> runners;
  for (const char *name : {"serial", "serial:order=backward", "tbb:threads=7"})
    runners.push_back(std::make_unique<BroadphaseRunner>(make_backend(name)));
  Random random(77);
  for (const Kind &kind : kinds)
    for (const uint32_t n : {0u, 1u, 2u, 3u, 127u, 128u, 129u, 1000u, 1024u, 1025u, 4000u}) {
      const RandomBoxes boxes = kind.make(n, random);
      if (boxes.size() == 0) continue; /* no scene has no body */
      const BodyPairs expected = expected_pairs(boxes);
      CAPTURE(kind.name, n, expected.size());
      if (n >= 1000) REQUIRE(!expected.empty());
      for (const auto &runner : runners) check_all(*runner, boxes, expected);
    }
}

TEST_CASE("broadphases find the pairs of twenty thousand boxes")
{
  BroadphaseRunner runner(make_backend("tbb"));
  Random random(78);
  for (const Kind &kind : kinds) {
    const RandomBoxes boxes = kind.make(20000, random);
    const BodyPairs expected = expected_pairs(boxes);
    CAPTURE(kind.name, expected.size());
    check_all(runner, boxes, expected, kind.suits_all);
  }
}

TEST_CASE("broadphases on OpenCL find the pairs of the oracle in any soup")
{
  parity::require_pocl();
  BroadphaseRunner runner(make_backend("cl:pocl"));
  Random random(79);
  for (const Kind &kind : kinds)
    for (const uint32_t n : {1u, 129u, 5000u}) {
      const RandomBoxes boxes = kind.make(n, random);
      const BodyPairs expected = expected_pairs(boxes);
      CAPTURE(kind.name, n, expected.size());
      check_all(runner, boxes, expected);
    }
}

TEST_CASE("a body that is not finite has no pairs, and spoils no others")
{
  Random random(80);
  RandomBoxes boxes = of_one_size(500, random);
  const BodyPairs before = expected_pairs(boxes);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (float4 &bound : std::span(boxes.bounds).subspan(2 * 100, 2)) bound = {nan, nan, nan, 0};
  BodyPairs expected;
  for (const auto &pair : before)
    if (pair.first != 100 && pair.second != 100) expected.push_back(pair);
  BroadphaseRunner runner(make_backend("serial"));
  runner.take(boxes);
  for (const Broadphase choice : {Broadphase::brute_force, Broadphase::sap3, Broadphase::bvh, Broadphase::bvh_stack,
                                  Broadphase::bvh_history, Broadphase::trees}) {
    CAPTURE(choice);
    CHECK(runner.find(row_of(choice)) == expected);
  }
}

TEST_CASE("three million pairs in one place grow the list, and all are there")
{
  const uint32_t most = 2500;
  RandomBoxes boxes;
  Random random(81);
  for (uint32_t i = 0; i < most; ++i) boxes.add({0, 0, 0}, {float(random.uniform(0.5, 1)), 1, 1});
  BroadphaseRunner runner(make_backend("tbb"));
  runner.take(boxes);
  for (const Broadphase choice :
       {Broadphase::grid, Broadphase::sap, Broadphase::sap3, Broadphase::bvh, Broadphase::trees}) {
    CAPTURE(choice);
    const BodyPairs found = runner.find(row_of(choice));
    REQUIRE(found.size() == most * (most - 1) / 2);
    size_t k = 0;
    bool right = true;
    for (uint32_t a = 1; a < most; ++a)
      for (uint32_t b = 0; b < a; ++b, ++k) right = right && found[k] == std::pair(a, b);
    CHECK(right);
  }
}
