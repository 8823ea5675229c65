/* The axis of least overlap of hulls with many faces, found by tests of few of them: against all faces and all pairs of
 * edges. */
#include "tests/catch.h"
#include "tests/shared/narrowphase/convex_shapes.h"

using namespace tandem;
using namespace tandem::convex_tests;

namespace {

/* How much deeper than the exhaustive axis, in parts of the size, and how often two edges have it. */
struct Comparison {
  double largest = 0;
  size_t overlapping = 0, of_edges = 0;
};

void compare(Comparison &result, const Shape &a, const Shape &b)
{
  const Axis exact = exhaustive_axis(a, b);
  if (exact.gap > 0) return;
  const convex record_a = a.record(), record_b = b.record();
  const convex_pair pair = pair_of(&record_a, &record_b);
  const hull_axis axis = separating_hull_axis(&pair.a, &pair.b, R(0.0), R(1e30));
  const vec3 world = rotate(pair.axes, axis.contact.normal);
  const Vector normal = (pair.swapped ? -1 : 1) * to_vector(world).normalized();
  result.largest = std::max(result.largest, (exact.gap - gap_between(a, b, normal)) / (a.radius() + b.radius()));
  ++result.overlapping;
  result.of_edges += axis.kind == AXIS_OF_EDGES;
}

} // namespace

TEST_CASE("convex axes: hulls of 20 vertices, resting and deep in each other, against all their axes")
{
  Random random(11);
  Comparison shallow, deep;
  for (int pair = 0; pair < 160; ++pair) {
    const Shape a = random_hull_shape(random, 20, {1, 0.8, 0.6});
    Shape b = random_hull_shape(random, 20, {0.7, 0.5, 0.9});
    ShapeMaker::place(a, b, random.direction(), 0);
    for (int k = 0; k < 6; ++k)
      ShapeMaker::place(a, b, find(a, b, CONVEX_EXPANSION).normal.normalized(), -random.logarithmic(1e-4, 1e-2));
    compare(shallow, a, b);
    b.center *= float(random.uniform(0, 0.8)); /* down to one within the other: more edges matter than a list holds */
    compare(deep, a, b);
  }
  INFO("resting: too deep by " << shallow.largest << ", " << shallow.of_edges << " of edges; deep: " << deep.largest
                               << ", " << deep.of_edges);
  CHECK(shallow.overlapping > 100);
  CHECK(deep.overlapping > 130);
  CHECK(shallow.of_edges > 30);
  CHECK(shallow.of_edges < shallow.overlapping);
  CHECK(shallow.largest < 1e-6);
  CHECK(deep.largest < 1e-6);
}

TEST_CASE("convex axes: boxes in boxes and needles across each other")
{
  ShapeMaker maker(12);
  Comparison result;
  for (int pair = 0; pair < 4000; ++pair) {
    Shape a = maker.make(SHAPE_BOX, 0.02, 2), b = maker.make(SHAPE_BOX, 0.02, 2);
    if (pair % 4 == 0) b.orientation = a.orientation;
    ShapeMaker::place(a, b, maker.random.direction(), 0);
    b.center *= float(maker.random.uniform(0, 0.9));
    compare(result, a, b);
  }
  CHECK(result.overlapping > 1500);
  CHECK(result.largest < 2e-6);
}
