/* Distances of convex shapes. The gap along the normal found can only be too small, and the distance of the closest
 * points only too large. Both must agree in double precision, which needs no other solver. Closed forms follow. */
#include "tests/catch.h"
#include "tests/shared/narrowphase/convex_shapes.h"

using namespace tandem;
using namespace tandem::convex_tests;

namespace {

void check_random_distances(size_t pairs, uint64_t seed)
{
  ShapeMaker maker(seed);
  Errors gap, distance, outside;
  size_t apart = 0, wrong = 0;
  for (size_t pair = 0; pair < pairs; ++pair) {
    const Shape a = maker.any(0.1, 2);
    Shape b = maker.any(0.1, 2);
    const double least = std::min(a.least(), b.least()), scale = std::pow(10.0, -double(maker.random.below(5)));
    ShapeMaker::place(a, b, maker.random.direction(), maker.random.uniform(0, 1) * scale * std::max(least, 0.1));
    const Found found = find(a, b, CONVEX_EXPANSION);
    const double size = a.radius() + b.radius(), exact = gap_between(a, b, found.normal.normalized());
    wrong += !(std::abs(found.normal.norm() - 1) < 2e-6);
    gap.add(std::abs(found.gap - exact) / size, pair);
    if (found.overlapping) continue; /* their cores: within a rounding of each other, or inside the radii */
    ++apart;
    distance.add(std::abs(found.distance - exact) / size, pair);
  }
  INFO("gap: largest error " << gap.largest << " of the size, 99.9% " << gap.quantile(0.999) << ", worst pair "
                             << gap.worst);
  INFO("distance - gap: largest " << distance.largest << ", 99.9% " << distance.quantile(0.999) << ", worst pair "
                                  << distance.worst);
  CAPTURE(apart);
  CHECK(wrong == 0);
  CHECK(gap.largest < 2e-6); /* a quaternion normalised in float makes axes that are a rotation to a few roundings */
  CHECK(distance.largest < 5e-5); /* round against nearly flat: the last of the way goes unseen by rounding */
  CHECK(distance.quantile(0.999) < 5e-6);
  CHECK(apart > pairs / 2);
}

/* Closest points of two segments by trying the ends and the crossing: double precision, no cases left out. */
double segment_distance(const Vector &p, const Vector &q, const Vector &r, const Vector &s)
{
  const auto to_segment = [](const Vector &x, const Vector &from, const Vector &to) {
    const Vector e = to - from;
    const double t = std::clamp(e.dot(x - from) / e.squaredNorm(), 0.0, 1.0);
    return (x - from - t * e).norm();
  };
  double best = std::min({to_segment(p, r, s), to_segment(q, r, s), to_segment(r, p, q), to_segment(s, p, q)});
  const Vector d = q - p, e = s - r, n = d.cross(e);
  if (n.squaredNorm() < 1e-20) return best;
  const double t = (r - p).cross(e).dot(n) / n.squaredNorm(), u = (r - p).cross(d).dot(n) / n.squaredNorm();
  if (t > 0 && t < 1 && u > 0 && u < 1) best = std::min(best, (p + t * d - r - u * e).norm());
  return best;
}

} // namespace

TEST_CASE("convex distance: the gap along the normal and the distance of the closest points agree")
{
  check_random_distances(100000, 1);
}
TEST_CASE("convex distance: a million pairs", "[.long]") { check_random_distances(1000000, 2); }

/* Points of a rim make slivers of simplices, and a sliver may seem to hold an origin that lies far outside of it. */
TEST_CASE("convex distance: no pair overlaps while a direction shows a gap")
{
  ShapeMaker maker(8);
  size_t apart = 0, wrong = 0;
  for (size_t pair = 0; pair < 200000; ++pair) {
    const Shape a = maker.make(SHAPE_CYLINDER, 0.1, 1);
    Shape b = maker.any(0.1, 1);
    ShapeMaker::place(a, b, maker.random.direction(), maker.random.uniform(0, 0.1));
    const convex record_a = a.record(), record_b = b.record();
    const convex_pair both = pair_of(&record_a, &record_b);
    const gjk_result found = closest_points(&both.a, &both.b, R(1e30));
    if (found.contact.gap < 1e-5 * (a.radius() + b.radius())) continue;
    ++apart;
    wrong += found.overlapping || std::abs(length_of(subtract(found.on_a, found.on_b)) - found.contact.gap) >
                                      1e-4 * (a.radius() + b.radius());
  }
  CHECK(wrong == 0);
  CHECK(apart > 190000);
}

TEST_CASE("convex distance: capsule against capsule is the distance of segments less the radii")
{
  ShapeMaker maker(3);
  Errors errors;
  for (size_t pair = 0; pair < 20000; ++pair) {
    Shape a = maker.make(SHAPE_CAPSULE, 0.1, 2), b = maker.make(SHAPE_CAPSULE, 0.1, 2);
    a.size.z() = a.size.x();
    b.size.z() = b.size.x();
    const double lean = maker.random.logarithmic(1e-6, 0.1); /* from parallel */
    if (maker.random.below(2) == 0) b.orientation = a.orientation;
    if (maker.random.below(2) == 0)
      b.orientation =
          (Eigen::Quaterniond(Eigen::AngleAxisd(lean, maker.random.direction())) * b.orientation.cast<double>())
              .cast<float>();
    ShapeMaker::place(a, b, maker.random.direction(), maker.random.uniform(-0.9, 0.5) * std::min(a.least(), b.least()));
    const Vector half_a = a.axes().col(1) * double(a.size.y()), half_b = b.axes().col(1) * double(b.size.y());
    const double segments = segment_distance(-half_a, half_a, b.middle() - half_b, b.middle() + half_b);
    const double exact = segments - a.size.x() - b.size.x(), size = a.radius() + b.radius();
    if (segments > 1e-5 * size) errors.add(std::abs(find(a, b, CONVEX_EXPANSION).gap - exact) / size, pair);
  }
  INFO("largest error " << errors.largest << " of the size, 99.9% " << errors.quantile(0.999) << ", worst pair "
                        << errors.worst);
  CHECK(errors.largest < 1e-6);
  CHECK(errors.values.size() > 15000);
}

TEST_CASE("convex distance: a sphere or a capsule's end against every shape is the distance of a point")
{
  ShapeMaker maker(4);
  Errors errors;
  for (size_t pair = 0; pair < 20000; ++pair) {
    const Shape ball = maker.make(SHAPE_SPHERE, 0.05, 1);
    Shape other = maker.any(0.1, 2);
    if (other.kind == SHAPE_HULL) continue;
    ShapeMaker::place(ball, other, maker.random.direction(), maker.random.uniform(-0.9, 1) * ball.least());
    const double away = outside_by(other, Vector::Zero()), size = ball.radius() + other.radius();
    if (away < 1e-4 * size) continue;
    const double exact = away - ball.size.x();
    errors.add(std::abs(find(ball, other, CONVEX_EXPANSION).gap - exact) / size, pair);
  }
  INFO("largest error " << errors.largest << " of the size, worst pair " << errors.worst);
  CHECK(errors.largest < 5e-6);
  CHECK(errors.values.size() > 5000);
}

TEST_CASE("convex distance: shapes a hundred kilometres apart")
{
  ShapeMaker maker(5);
  Errors errors;
  for (size_t pair = 0; pair < 5000; ++pair) {
    const Shape a = maker.any(1e-2, 10);
    Shape b = maker.any(1e-2, 10);
    ShapeMaker::place(a, b, maker.random.direction(), 1e5);
    const Found found = find(a, b, CONVEX_EXPANSION);
    errors.add(std::abs(found.gap - gap_between(a, b, found.normal.normalized())) / 1e5, pair);
    errors.add(std::abs(found.gap - found.distance) / 1e5, pair);
  }
  INFO("largest error " << errors.largest << " of the distance, worst pair " << errors.worst);
  CHECK(errors.largest < 1e-6);
}
