/* The overlap of convex shapes against libccd (D. Fiser), if it is installed, as an independent oracle. */
#include "tests/catch.h"

#ifdef TANDEM_LIBCCD
#include <ccd/ccd.h>

#include "tests/shared/narrowphase/convex_shapes.h"

using namespace tandem;
using namespace tandem::convex_tests;

namespace {

void support_for_libccd(const void *shape, const ccd_vec3_t *direction, ccd_vec3_t *point)
{
  const Vector at = static_cast<const Shape *>(shape)->support({direction->v[0], direction->v[1], direction->v[2]});
  ccdVec3Set(point, at.x(), at.y(), at.z());
}

ccd_t settings_of_libccd()
{
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = support_for_libccd;
  ccd.max_iterations = 500;
  ccd.epa_tolerance = 1e-8;
  return ccd;
}

} // namespace

TEST_CASE("convex depth: overlaps and depths as libccd finds them")
{
  const uint_lanes kinds[] = {SHAPE_SPHERE, SHAPE_BOX, SHAPE_CAPSULE, SHAPE_CYLINDER, SHAPE_HULL};
  const ccd_t ccd = settings_of_libccd();
  ShapeMaker maker(21);
  size_t verdicts = 0, depths = 0, unsolved = 0, agreed = 0;
  Errors deeper;
  for (size_t pair = 0; pair < 20000; ++pair) {
    const Shape a = maker.make(kinds[maker.random.below(5)], 0.2, 2);
    Shape b = maker.make(kinds[maker.random.below(5)], 0.2, 2);
    ShapeMaker::place(a, b, maker.random.direction(), maker.random.uniform(-0.8, 0.4) * std::min(a.least(), b.least()));
    const Found found = find(a, b, CONVEX_EXPANSION);
    const double size = a.radius() + b.radius();
    if (std::abs(found.gap) < 1e-4 * size) continue; /* touching: both may say either */
    ++verdicts;
    CAPTURE(pair, a.kind, b.kind, found.gap);
    REQUIRE((ccdGJKIntersect(&a, &b, &ccd) == 1) == (found.gap < 0));
    if (found.gap > 0) continue;
    ccd_real_t depth;
    ccd_vec3_t direction, position;
    if (ccdGJKPenetration(&a, &b, &ccd, &depth, &direction, &position) != 0 || !(depth > 0)) {
      ++unsolved;
      continue;
    }
    ++depths;
    agreed += std::abs(-found.gap - depth) < 1e-4 * size;
    /* The overlap that libccd reports may be less than that along its direction, which is an upper bound that the
     * shapes themselves give. */
    const Vector displacement = Vector(direction.v[0], direction.v[1], direction.v[2]).normalized();
    deeper.add((-found.gap + std::max(gap_between(a, b, displacement), gap_between(a, b, -displacement))) / size, pair);
  }
  CAPTURE(verdicts, depths, unsolved, agreed, deeper.largest, deeper.worst);
  CHECK(verdicts > 15000);
  CHECK(depths > 5000);
  CHECK(unsolved < depths / 100);
  CHECK(agreed > depths * 9 / 10);
  CHECK(deeper.largest < 1e-5); /* no way out that libccd finds is shorter than ours */
}
#else
TEST_CASE("convex depth: overlaps and depths as libccd finds them") { tests::skip("libccd is not installed"); }
#endif
