/* The headers with `real` = double, as the reference build compiles them: the errors that remain are those of the
 * methods. */
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <stdint.h>

#include "host/scene/hull_chunks.h"
#include "tests/catch.h"

/* Types of memory are wider too, so all of it lives in a namespace of its own, as in minicl/reference.cpp. */
#define TANDEM_REFERENCE
namespace tandem::reference_shapes {
#include "tests/shared/narrowphase/convex_shapes.h"
} // namespace tandem::reference_shapes

using namespace tandem::reference_shapes::tandem::convex_tests;
using namespace tandem::reference_shapes;

TEST_CASE("convex shapes in double precision: distances and depths to its rounding")
{
  static_assert(sizeof(real) == 8);
  ShapeMaker maker(1);
  Errors gap, distance, depth, axes;
  for (size_t pair = 0; pair < 20000; ++pair) {
    const uint_lanes kinds[] = {SHAPE_SPHERE, SHAPE_BOX, SHAPE_HULL};
    const Shape a = maker.make(kinds[maker.random.below(3)], 0.1, 2);
    Shape b = maker.make(kinds[maker.random.below(3)], 0.1, 2);
    const double least = std::min(a.least(), b.least()), size = a.radius() + b.radius();
    ShapeMaker::place(a, b, maker.random.direction(), maker.random.uniform(-1, 0.5) * least);
    const Found found = find(a, b, CONVEX_EXPANSION);
    const double exact = gap_between(a, b, found.normal.normalized());
    gap.add(std::abs(found.gap - exact) / size, pair);
    if (!found.overlapping) distance.add(std::abs(found.distance - exact) / size, pair);
    if (!found.overlapping || a.kind == SHAPE_SPHERE || b.kind == SHAPE_SPHERE ||
        (a.kind == b.kind && a.kind == SHAPE_HULL && pair % 20))
      continue;
    const Axis best = exhaustive_axis(a, b);
    depth.add((best.gap - exact) / size, pair);
    axes.add((best.gap - find(a, b, CONVEX_AXES).gap) / size, pair);
  }
  INFO("gap " << gap.largest << ", distance " << distance.largest << ", depth " << depth.largest << " (pair "
              << depth.worst << "), axes " << axes.largest << " (pair " << axes.worst << ")");
  CHECK(gap.largest < 1e-14);
  CHECK(distance.largest < 1e-13);
  CHECK(depth.largest < 1e-13);
  CHECK(axes.largest < 1e-13);
  CHECK(depth.values.size() > 500);
}
