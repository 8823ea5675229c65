/* Surfaces as points and as height fields over cubes: the errors of the heights, and the contacts that follow. */
#include "tests/catch.h"
#include "tests/shared/narrowphase/convex_shapes.h"

using namespace tandem;
using namespace tandem::convex_tests;

namespace {

constexpr float contact_slop = 0.005f;

Shape box(const Vector &extent, const Vector &middle)
{
  Shape shape;
  shape.size = extent.cast<float>();
  shape.center = middle.cast<float>();
  return shape;
}

struct Manifold {
  Vector normal;
  std::vector<Vector> points;
  double deepest = 1e300;
};

Manifold manifold_of(const Shape &a, const Shape &b, double reach, uint_lanes method)
{
  const convex record_a = a.record(), record_b = b.record();
  const manifold m = convex_contact(&record_a, &record_b, real(reach), contact_slop, method);
  Manifold result{to_vector(m.normal), {}, 1e300};
  for (int slot = 0; slot < 4; ++slot) {
    if (!m.kept[slot]) continue;
    result.points.push_back({m.point[slot].x, m.point[slot].y, m.point[slot].z});
    result.deepest = std::min(result.deepest, double(m.point[slot].w));
  }
  return result;
}

} // namespace

TEST_CASE("cube field: heights are never too large, and nearly right where the surface is near")
{
  Random random(21);
  for (uint32_t vertices : {8u, 32u}) {
    Errors errors;
    for (int hull = 0; hull < 40; ++hull) {
      const Shape shape = random_hull_shape(random, vertices, {1, 0.8, 0.6});
      const convex record = shape.record();
      for (size_t k = 0; k < 200; ++k) {
        const Hull::Face &face = shape.hull->faces[random.below(uint32_t(shape.hull->faces.size()))];
        Vector p = Vector::Zero();
        double sum = 0;
        for (uint32_t corner : face.corners) {
          const double weight = random.uniform(0, 1);
          p += weight * shape.hull->vertices[corner];
          sum += weight;
        }
        p = p / sum + face.normal * random.uniform(-0.02, 0.02);
        double exact = -1e300;
        for (const Hull::Face &other : shape.hull->faces) exact = std::max(exact, other.normal.dot(p) - other.distance);
        const field_height found = height_above_field(&record, make_vec3(real(p.x()), real(p.y()), real(p.z())));
        REQUIRE(double(found.height) < exact + 1e-6);
        errors.add(exact - double(found.height), k);
      }
    }
    INFO(vertices << " vertices, 8 cells a side: too low by " << errors.largest << " at most, 99th percentile "
                  << errors.quantile(0.99));
    CHECK(errors.largest < 0.1);
    CHECK(errors.quantile(0.9) < 1e-3);
  }
}

TEST_CASE("cube field: a box on a larger one, and on one that it overhangs")
{
  const Shape floor = box({2, 0.5, 2}, {0, 0, 0}), smaller = box({0.5, 0.5, 0.5}, {0.7, 0.999, -0.4}),
              aside = box({2, 0.5, 2}, {1, 0.999, 0.5});
  const Manifold on = manifold_of(floor, smaller, 0.02, CONVEX_FIELDS),
                 exact = manifold_of(floor, smaller, 0.02, CONVEX_AXES);
  REQUIRE(on.points.size() == 4);
  CHECK((on.normal - Vector(0, 1, 0)).norm() < 1e-6);
  for (const Vector &p : on.points) {
    double nearest = 1e300;
    for (const Vector &q : exact.points) nearest = std::min(nearest, (p - q).norm());
    CHECK(nearest < 1e-6);
  }
  CHECK(std::abs(on.deepest + 0.001) < 1e-6);

  const Manifold over = manifold_of(floor, aside, 0.02, CONVEX_FIELDS);
  REQUIRE(over.points.size() == 4);
  CHECK(std::abs(over.deepest + 0.001) < 1e-6);
  Vector low = over.points[0], high = low;
  for (const Vector &p : over.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  CHECK((low - Vector(-1, 0.4995, -1.5)).cwiseAbs().maxCoeff() < 1.01); /* an edge is sampled at quarters: 1 m */
  CHECK((high - Vector(2, 0.4995, 2)).cwiseAbs().maxCoeff() < 1.01);
  CHECK(high.y() - low.y() < 1e-6);
  CHECK(std::min(high.x() - low.x(), high.z() - low.z()) > 1.9);
}

TEST_CASE("cube field: long edges that cross far from any corner still touch")
{
  Shape a = box({5, 0.1, 0.1}, {0.4, 0, 0.3}), b = box({0.1, 0.1, 5}, {0, 0.27, 0});
  a.orientation = Eigen::AngleAxisf(0.7853982f, Eigen::Vector3f::UnitX());
  b.orientation = Eigen::AngleAxisf(0.7853982f, Eigen::Vector3f::UnitZ());
  const Manifold found = manifold_of(a, b, 0.02, CONVEX_FIELDS);
  REQUIRE(found.points.size() == 1);
  CHECK(found.normal.y() > 0.999);
  CHECK(std::abs(found.deepest - (0.27 - 0.2 * std::sqrt(2))) < 1e-5);
}

TEST_CASE("cube field: hulls that rest on each other, against all their axes")
{
  Random random(22);
  Errors depth;
  size_t pairs = 0, right_normal = 0;
  for (int k = 0; k < 300; ++k) {
    const Shape a = random_hull_shape(random, 20, {1, 0.8, 0.6});
    Shape b = random_hull_shape(random, 20, {0.7, 0.5, 0.9});
    ShapeMaker::place(a, b, random.direction(), 0);
    for (int round = 0; round < 6; ++round)
      ShapeMaker::place(a, b, find(a, b, CONVEX_EXPANSION).normal.normalized(), -random.logarithmic(1e-4, 1e-2));
    const Axis exact = exhaustive_axis(a, b);
    if (exact.gap > 0) continue;
    const Manifold found = manifold_of(a, b, 0.02, CONVEX_FIELDS);
    REQUIRE(!found.points.empty()); /* what overlaps has a contact */
    ++pairs;
    right_normal += found.normal.dot(exact.normal) > 0.99;
    depth.add(std::abs(found.deepest - exact.gap), size_t(k));
  }
  INFO(pairs << " pairs, normal right of " << right_normal << "; depth wrong by " << depth.largest
             << " at most, median " << depth.quantile(0.5));
  CHECK(pairs > 200);
  CHECK(right_normal > pairs / 2);
  CHECK(depth.quantile(0.5) < 1e-3);
}
