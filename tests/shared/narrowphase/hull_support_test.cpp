/* Support maps of hulls: the exact ones find the same vertex, also in ties; the error of the cube map is bounded by the
 * width of its cells. */
#include "tests/catch.h"
#include "tests/shared/narrowphase/convex_shapes.h"

using namespace tandem;
using namespace tandem::convex_tests;

namespace {

uint32_t by_loop(const Hull &hull, vec3 d)
{
  uint32_t best = 0;
  for (uint32_t k = 1; k < hull.rows.size(); ++k)
    if (dot3(make_vec3(hull.rows[k].x, hull.rows[k].y, hull.rows[k].z), d) >
        dot3(make_vec3(hull.rows[best].x, hull.rows[best].y, hull.rows[best].z), d))
      best = k;
  return best;
}

uint32_t by(uint_lanes support, const Hull &hull, vec3 d, const Vector &size)
{
  hull_tables tables = hull.tables();
  tables.support = support;
  const hull_ranges ranges = ranges_of_hull(&tables, 0);
  return hull_support(&tables, &ranges, d, make_vec3(real(size.x()), real(size.y()), real(size.z())));
}

vec3 rounded(const Vector &v) { return make_vec3(real(v.x()), real(v.y()), real(v.z())); }

/* At random, and where ties are: square to faces and edges, and along the axes. */
std::vector<vec3> directions_for(Random &random, const Hull &hull)
{
  std::vector<vec3> list;
  for (int k = 0; k < 2000; ++k) list.push_back(rounded(random.direction()));
  for (int axis = 0; axis < 3; ++axis)
    for (double sign : {1.0, -1.0}) list.push_back(rounded(sign * Vector::Unit(axis)));
  for (const Hull::Face &face : hull.faces) {
    list.push_back(rounded(face.normal));
    list.push_back(rounded((face.normal + 3e-7 * random.direction()).normalized()));
  }
  for (const auto &edge : hull.edges) {
    list.push_back(rounded((hull.faces[edge[2]].normal + hull.faces[edge[3]].normal).normalized()));
    list.push_back(rounded(hull.vertices[edge[0]].normalized()));
  }
  return list;
}

} // namespace

TEST_CASE("convex supports: chunks and climbing name the vertex of a plain loop")
{
  Random random(21);
  size_t wrong = 0, tried = 0;
  for (uint32_t hull = 0; hull < 40; ++hull) {
    const Vector size(1, random.logarithmic(0.01, 1), random.logarithmic(0.1, 3));
    const auto shape = hull == 0 ? box_hull(size) : random_hull(random, 4 + hull % 30, size);
    for (const vec3 d : directions_for(random, *shape)) {
      const uint32_t expected = by_loop(*shape, d);
      wrong += by(SUPPORT_BRUTE_FORCE, *shape, d, size) != expected;
      wrong += by(SUPPORT_HILL_CLIMBING, *shape, d, size) != expected;
      ++tried;
    }
  }
  CHECK(tried > 80000);
  CHECK(wrong == 0);
}

TEST_CASE("convex supports: a cube map errs by no more than its cells allow")
{
  Random random(22);
  const auto hull = random_hull(random, 30, {1, 0.8, 0.6});
  double largest = 0;
  size_t other = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vector direction = random.direction();
    const vec3 d = rounded(direction);
    const uint32_t best = by_loop(*hull, d), near = by(SUPPORT_CUBE_MAP, *hull, d, {1, 0.8, 0.6});
    largest = std::max(largest, (hull->vertices[best] - hull->vertices[near]).dot(direction));
    other += near != best;
  }
  /* |best - near| <= 2, times what the direction can differ from its cell's middle: half the diagonal of a cell of 2
   * / 8. */
  CHECK(largest < 2 * std::sqrt(2.0) / 8);
  CHECK(other > 0);
  CHECK(other < 20000 / 4);
}
