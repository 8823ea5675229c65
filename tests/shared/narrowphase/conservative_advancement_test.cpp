/* The time of impact against closed forms, and its definition for pairs of every shape: apart before it, touching at
 * it. */
#include "shared/narrowphase/conservative_advancement.h"
#include "tests/catch.h"
#include "tests/shared/narrowphase/convex_shapes.h"

using namespace tandem;
using namespace tandem::convex_tests;

namespace {

vec3 vec(const Vector &v) { return make_vec3(real(v.x()), real(v.y()), real(v.z())); }
const vec3 none = make_vec3(0, 0, 0);

/* The input of a step of 1 s. */
toi_input one_second(const moving_convex &a, const moving_convex &b)
{
  const real fastest = length_of(subtract(a.linear, b.linear)) + fastest_swing(&a) + fastest_swing(&b);
  return toi_input_of(fastest, 1, minimum(least_size(&a.shape), least_size(&b.shape)),
                      bounding_radius_of(&a.shape) + bounding_radius_of(&b.shape));
}

Shape ball(float radius)
{
  Shape shape;
  shape.kind = SHAPE_SPHERE;
  shape.size = {radius, radius, radius};
  return shape;
}

/* A shape after turning evenly about its own middle for a time. */
Shape later(Shape shape, const Vector &linear, const Vector &angular, double time)
{
  const Eigen::AngleAxisd turn(angular.norm() * time,
                               angular.norm() > 0 ? Vector(angular.normalized()) : Vector(Vector::UnitX()));
  shape.orientation = (Eigen::Quaterniond(turn) * shape.orientation.cast<double>().normalized()).cast<float>();
  shape.center = (shape.center.cast<double>() + linear * time).cast<float>();
  return shape;
}

} // namespace

TEST_CASE("time of impact: two spheres meet when their centres are two radii apart")
{
  Random random(1);
  size_t hits = 0, misses = 0;
  double largest = 0;
  for (int k = 0; k < 5000; ++k) {
    Shape a = ball(float(random.logarithmic(0.01, 1))), b = ball(float(random.logarithmic(0.01, 1)));
    const double radii = a.extent().x() + b.extent().x();
    b.center = (random.direction() * random.uniform(1.05, 20) * radii).cast<float>();
    const Vector p = b.middle(), v = (-p.normalized() + random.uniform(0, 1.2 * radii / p.norm()) * random.direction())
                                         .cast<float>()
                                         .cast<double>() *
                                     p.norm();
    const convex shape_a = a.record(), shape_b = b.record();
    const moving_convex moving_a = moving_convex_of(&shape_a, none, none, none, 0),
                        moving_b = moving_convex_of(&shape_b, shape_b.center, vec(v), none, 0);
    const toi_input input = one_second(moving_a, moving_b);
    const impact met = first_impact(&moving_a, &moving_b, input);
    /* |p + v t| = radii */
    const double along = p.dot(v), square = along * along - v.squaredNorm() * (p.squaredNorm() - radii * radii);
    if (square < 0) {
      const double nearest = (p - v * along / v.squaredNorm()).norm() - radii;
      if (nearest > 2.0 * double{input.touching}) {
        CHECK(!met.at.hits);
        ++misses;
      }
      continue;
    }
    const double exact = (-along - std::sqrt(square)) / v.squaredNorm(), closing = std::sqrt(square) / radii;
    if (exact > 0.99 || closing < 0.05 * v.norm()) continue; /* a graze has no one time */
    ++hits;
    REQUIRE(met.at.hits);
    const double early = (exact - double{met.at.time}) * closing; /* m */
    largest = std::max(largest, std::abs(early - 0.5 * double{input.touching}) / double{input.touching});
  }
  CAPTURE(hits, misses, largest);
  CHECK(largest < 0.75); /* between the surface and the touching distance before it, and a rounding */
  CHECK(hits > 1500);
  CHECK(misses > 300);
}

TEST_CASE("time of impact: a sphere falls on a plane at (height - radius) / speed")
{
  Random random(2);
  for (int k = 0; k < 2000; ++k) {
    const double radius = random.logarithmic(0.01, 1), height = radius * random.uniform(1.1, 50),
                 speed = (height - radius) * random.uniform(1.1, 100);
    const convex shape = ball(float(radius)).record();
    const vec3 aside = vec(random.in_cube(speed));
    const moving_convex moving = moving_convex_of(&shape, none, make_vec3(aside.x, real(-speed), aside.z), none, 0);
    const toi_input input = toi_input_of(length_of(moving.linear), 1, real(radius), real(radius));
    const impact met = first_impact_on_plane(&moving, make_vec3(0, 1, 0), real(-height), none, input);
    REQUIRE(met.at.hits);
    const double early = (height - radius) - speed * double{met.at.time};
    CAPTURE(radius, height, speed, early, input.touching);
    CHECK(early > -0.1 * double{input.touching});
    CHECK(early < 1.01 * double{input.touching});
  }
}

/* A rod of half length L and radius r turns in its plane at w, from level, its middle h above the plane: its lower end
 * touches when sin w t = (h - r) / L. */
TEST_CASE("time of impact: a turning rod touches a plane with its end")
{
  Random random(3);
  for (int k = 0; k < 1000; ++k) {
    Shape rod;
    rod.kind = SHAPE_CAPSULE;
    const double L = random.uniform(0.5, 2), r = 0.05 * L, h = r + L * random.uniform(0.05, 0.95),
                 w = random.uniform(2, 50), sink = random.uniform(0, 0.2) * L;
    rod.size = Eigen::Vector3f(float(r), float(L), float(r));
    rod.orientation = Eigen::Quaternionf(Eigen::AngleAxisf(float(M_PI / 2), Eigen::Vector3f::UnitZ()));
    const convex shape = rod.record();
    const moving_convex moving =
        moving_convex_of(&shape, none, make_vec3(0, real(-sink), 0), make_vec3(0, 0, real(w)), real(L + r));
    const impact met = first_impact_on_plane(&moving, make_vec3(0, 1, 0), real(-h), none,
                                             toi_input_of(real(sink + w * (L + r)), 1, real(r), real(L + r)));
    double low = 0, high = std::asin(std::min(1.0, (h - r) / L)) / w; /* sinking only brings it forward */
    for (int i = 0; i < 60; ++i) {
      const double t = 0.5 * (low + high);
      (h - sink * t - r - L * std::sin(w * t) > 0 ? low : high) = t;
    }
    CAPTURE(L, h, w, sink, low, met.at.time);
    REQUIRE(met.at.hits);
    CHECK(double{met.at.time} <= low * (1 + 1e-6));
    /* Never later, and early by no more than the touching distance is worth, or by what the rounds left of a slow
     * approach. */
    CHECK(h - r - sink * double{met.at.time} - L * std::sin(w * double{met.at.time}) < 2e-3 * r + 1e-4 * L);
  }
}

TEST_CASE("time of impact: shapes that move and turn are apart before it, and touch then")
{
  ShapeMaker maker(4);
  size_t hits = 0, misses = 0, overlaps = 0, loose = 0;
  double widest = 0; /* gap of those whose rounds ran out, of the size */
  for (int k = 0; k < 3000; ++k) {
    const Shape a = maker.any(0.1, 1);
    Shape b = maker.any(0.1, 1);
    const Vector away = maker.random.direction();
    ShapeMaker::place(a, b, away, maker.random.uniform(0.02, 3));
    const Vector linear_a = maker.random.in_cube(2),
                 linear_b = linear_a - away * maker.random.uniform(0, 6) + maker.random.in_cube(1);
    const Vector angular_a = maker.random.in_cube(4), angular_b = maker.random.in_cube(4);
    const convex record_a = a.record(), record_b = b.record();
    const moving_convex moving_a = moving_convex_of(&record_a, none, vec(linear_a), vec(angular_a), real(a.radius()));
    const moving_convex moving_b =
        moving_convex_of(&record_b, record_b.center, vec(linear_b), vec(angular_b), real(b.radius()));
    const toi_input input = one_second(moving_a, moving_b);
    const impact met = first_impact(&moving_a, &moving_b, input);
    met.at.hits ? ++hits : ++misses;
    if (met.at.hits && double{met.gap} > 1.01 * double{input.touching}) {
      ++loose;
      widest = std::max(widest, double{met.gap} / (a.radius() + b.radius()));
    }
    const double end = met.at.hits ? double{met.at.time} : 1.0;
    for (int sample = 0; sample <= 12; ++sample) {
      const double t = end * sample / 12;
      const Shape now_a = later(a, Vector::Zero(), angular_a, t), now_b = later(b, linear_b - linear_a, angular_b, t);
      const convex c = now_a.record(), d = now_b.record();
      const convex_pair pair = pair_of(&c, &d);
      const gjk_result near = closest_points(&pair.a, &pair.b, R(1e30));
      Vector normal = to_vector(rotate(pair.axes, near.contact.normal)).normalized();
      if (pair.swapped) normal = -normal;
      const double gap = gap_between(now_a, now_b, normal); /* in double: if above 0, they are apart */
      overlaps += gap < -1e-5 * (a.radius() + b.radius());
    }
  }
  CAPTURE(hits, misses, overlaps, loose, widest);
  CHECK(overlaps == 0);
  CHECK(loose < hits / 15); /* up to three turns of radians while they fly past */
  CHECK(widest < 0.15);
  CHECK(hits > 700);
  CHECK(misses > 700);
}

/* A distance query may end at any gap that is larger than what it was asked for, which must not count as touching. */
TEST_CASE("time of impact: what touches at the end of its motion does, and what is apart then does not")
{
  ShapeMaker maker(5);
  size_t apart = 0, touching = 0;
  for (int k = 0; k < 100000; ++k) {
    const Shape a = maker.any(0.1, 1);
    Shape b = maker.any(0.1, 1);
    ShapeMaker::place(a, b, maker.random.direction(), maker.random.uniform(-0.1, 0.1));
    const convex record_a = a.record(), record_b = b.record();
    const moving_convex moving_a = moving_convex_of(&record_a, none, none, none, 0),
                        moving_b = moving_convex_of(&record_b, record_b.center, none, none, 0);
    toi_input input = toi_input_of(real(1e-6), 1, minimum(least_size(&record_a), least_size(&record_b)),
                                   bounding_radius_of(&record_a) + bounding_radius_of(&record_b));
    input.roughly = ROUGHLY;
    const convex_pair pair = pair_of(&record_a, &record_b);
    const gjk_result near = closest_points(&pair.a, &pair.b, R(1e30));
    const double gap = double{near.overlapping ? 0 : near.contact.gap} - double{core_radius(&record_a)} -
                       double{core_radius(&record_b)};
    const double touches = double{input.touching}, rounding = 1e-5 * (a.radius() + b.radius());
    if (std::abs(gap - touches) < 0.2 * touches + rounding) continue;
    (gap < touches ? touching : apart) += 1;
    const bool found = touches_at_end(&moving_a, &moving_b, input) != 0;
    if (found != (gap < touches)) {
      CAPTURE(k, gap, touches, a.kind, b.kind);
      CHECK(found == (gap < touches));
    }
  }
  CHECK(apart > 20000);
  CHECK(touching > 5000);
}
