/* Depths of overlapping shapes: polytopes against all faces and all pairs of edges in double precision, round shapes
 * against a search over directions. Any direction gives an upper bound of the depth, so an answer can only be too
 * deep. */
#include "tests/catch.h"
#include "tests/shared/narrowphase/convex_shapes.h"
#include "tools/command/parallel.h"

using namespace tandem;
using namespace tandem::convex_tests;

namespace {

/* The excess of the depth along the normal found over the least depth, as a share of the size. */
struct Excess {
  Errors excess, rounding;
  size_t bad = 0;
  void add(const Shape &a, const Shape &b, const Found &found, double least_depth, size_t pair)
  {
    const double size = a.radius() + b.radius(), gap = gap_between(a, b, found.normal.normalized());
    excess.add((-least_depth - gap) / size, pair);
    rounding.add(std::abs(gap - found.gap) / size, pair);
    bad += -least_depth - gap > 1e-3 * size;
  }
  void add(const Excess &other)
  {
    excess.add(other.excess);
    rounding.add(other.rounding);
    bad += other.bad;
  }
};

void place_overlapping(ShapeMaker &maker, const Shape &a, Shape &b)
{
  const double least = std::min(a.least(), b.least());
  switch (maker.random.below(5)) {
  case 0: ShapeMaker::place(a, b, maker.random.direction(), 0); break;
  case 1: ShapeMaker::place(a, b, maker.random.direction(), -1e-5 * least); break;
  case 2: b.center = (maker.random.in_cube(0.1) * least).cast<float>(); break;
  default: ShapeMaker::place(a, b, maker.random.direction(), -maker.random.uniform(0, 1.5) * least);
  }
  if (maker.random.below(5) == 0) b.orientation = a.orientation;
}

struct Depths {
  Excess expansion, sampled, axes;
};

/* 100,000 pairs that overlap; one in `hull_share` has a hull. Pair n of seed s is called s * 10^7 + n. */
void measure_depths(Depths &depths, size_t hull_share, uint64_t seed)
{
  ShapeMaker maker(seed);
  for (size_t pair = 0; depths.axes.excess.values.size() < 100000; ++pair) {
    const uint_lanes kind = pair % hull_share == 0 ? SHAPE_HULL : SHAPE_BOX;
    const Shape a = maker.make(kind, 0.1, 2);
    Shape b = maker.make(maker.random.below(2) ? kind : uint_lanes(SHAPE_BOX), 0.1, 2);
    place_overlapping(maker, a, b);
    const Axis exact = exhaustive_axis(a, b);
    if (exact.gap > 0) continue;
    const size_t name = seed * 10000000 + pair;
    depths.expansion.add(a, b, find(a, b, CONVEX_EXPANSION), -exact.gap, name);
    depths.axes.add(a, b, find(a, b, CONVEX_AXES), -exact.gap, name);
    depths.sampled.add(a, b, find(a, b, CONVEX_SAMPLED), -exact.gap, name);
  }
}

/* Blocks of 100,000 pairs, each of a seed of its own, on all threads. */
void check_polytopes(size_t blocks, size_t hull_share, uint64_t first_seed)
{
  std::vector<Depths> found(blocks);
  in_parallel(blocks, processor_count(), [&](size_t k) { measure_depths(found[k], hull_share, first_seed + k); });
  auto &[expansion, sampled, axes] = found[0];
  for (size_t k = 1; k < blocks; ++k) {
    expansion.add(found[k].expansion);
    sampled.add(found[k].sampled);
    axes.add(found[k].axes);
  }
  const auto report = [](const char *name, Excess &e) {
    std::ostringstream text;
    text << name << ": " << e.excess.values.size() << " pairs, too deep by at most " << e.excess.largest
         << " of the size (pair " << e.excess.worst << "), 99.9% " << e.excess.quantile(0.999) << ", 99% "
         << e.excess.quantile(0.99) << ", rounding of the gap " << e.rounding.largest << ", more than 1e-3: " << e.bad
         << "; ";
    return text.str();
  };
  INFO(report("expansion", expansion) << report("axes", axes) << report("sampled", sampled));
  CHECK(expansion.excess.largest < 2e-6);
  CHECK(expansion.excess.quantile(0.999) < 5e-7);
  CHECK(axes.excess.largest < 2e-6);
  CHECK(sampled.excess.quantile(0.9) < 1e-5); /* the cheap one: near the least depth, mostly */
  CHECK(sampled.excess.quantile(0.99) < 0.05);
  CHECK(sampled.excess.largest < 0.2);
  CHECK(std::max({expansion.rounding.largest, axes.rounding.largest, sampled.rounding.largest}) < 2e-6);
}

} // namespace

TEST_CASE("convex depth: boxes and hulls against all their axes") { check_polytopes(1, 40, 1); }
TEST_CASE("convex depth: a million boxes and hulls", "[.long]") { check_polytopes(10, 10, 2); }

TEST_CASE("convex depth: round shapes against a search over directions")
{
  ShapeMaker maker(3);
  Random search(4);
  Excess expansion, sampled;
  for (size_t pair = 0; pair < 1000; ++pair) {
    const Shape a = maker.make(pair % 2 ? uint_lanes(SHAPE_CYLINDER) : uint_lanes(SHAPE_CAPSULE), 0.2, 2);
    Shape b = maker.any(0.2, 2);
    place_overlapping(maker, a, b);
    const Found found = find(a, b, CONVEX_EXPANSION);
    if (found.gap > 0) continue;
    const Axis exact = searched_axis(a, b, search, found.normal.normalized(), 4);
    expansion.add(a, b, found, -exact.gap, pair);
    sampled.add(a, b, find(a, b, CONVEX_SAMPLED), -exact.gap, pair);
  }
  INFO("expansion: largest " << expansion.excess.largest << " (pair " << expansion.excess.worst << "), 99.9% "
                             << expansion.excess.quantile(0.999));
  INFO("sampled: largest " << sampled.excess.largest << " (pair " << sampled.excess.worst << "), 99% "
                           << sampled.excess.quantile(0.99));
  CHECK(expansion.excess.largest < 1e-3);
  CHECK(expansion.excess.quantile(0.99) < 1e-4);
  CHECK(sampled.excess.quantile(0.9) < 1e-4);
  CHECK(expansion.excess.values.size() > 200);
}

TEST_CASE("convex depth: concentric shapes have a normal of unit length, and one that does not change")
{
  ShapeMaker maker(5);
  size_t wrong = 0;
  for (size_t pair = 0; pair < 2000; ++pair) {
    const Shape a = maker.any(0.1, 2);
    Shape b = pair % 3 ? maker.any(0.1, 2) : a;
    if (pair % 2) b.orientation = a.orientation;
    for (uint_lanes method : {CONVEX_EXPANSION, CONVEX_SAMPLED, CONVEX_AXES}) {
      const Found found = find(a, b, method), again = find(a, b, method);
      wrong += !(std::abs(found.normal.norm() - 1) < 2e-6) || found.normal != again.normal;
    }
  }
  CHECK(wrong == 0);
  const Shape ball = [] {
    Shape s;
    s.kind = SHAPE_SPHERE;
    return s;
  }();
  CHECK((find(ball, ball, CONVEX_EXPANSION).normal - Vector::UnitY()).norm() < 1e-6);
}

TEST_CASE("convex depth: hulls without volume")
{
  ShapeMaker maker(6);
  const auto flat = make_hull({{1, 0, 1}, {-1, 0, 1}, {-1, 0, -1}, {1, 0, -1}});
  const auto sliver = make_hull({{1, 0, 0}, {-1, 0, 0}, {0, 1e-4, 1}, {0, -1e-4, 1}, {0, 0, -1}});
  Errors gap;
  size_t wrong = 0;
  for (size_t pair = 0; pair < 5000; ++pair) {
    Shape a;
    a.kind = SHAPE_HULL;
    a.hull = pair % 2 ? flat : sliver;
    a.orientation = maker.random.orientation().cast<float>();
    Shape b = maker.any(0.1, 1);
    if (pair % 7 == 0) b = a;
    ShapeMaker::place(a, b, maker.random.direction(), maker.random.uniform(-0.1, 0.1));
    for (uint_lanes method : {CONVEX_EXPANSION, CONVEX_SAMPLED, CONVEX_AXES}) {
      const Found found = find(a, b, method);
      wrong += !(std::abs(found.normal.norm() - 1) < 2e-6);
      gap.add(std::abs(found.gap - gap_between(a, b, found.normal.normalized())), pair);
    }
  }
  INFO("largest error of the gap " << gap.largest << ", worst pair " << gap.worst);
  CHECK(wrong == 0);
  CHECK(gap.largest < 5e-6);
}
