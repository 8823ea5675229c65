/* Capsules against capsules, spheres and half-spaces: the distance of segments in double precision, by their ends and
 * their common perpendicular. */
#include "tests/shared/narrowphase/capsules.h"

using namespace tandem;
using namespace tandem::narrowphase_tests;

namespace {

/* Two segments are nearest at an end of one of them, or where a line perpendicular to both meets both. */
double distance_between(const Segment &a, const Segment &b)
{
  double least = std::min({b.distance_to(a.low), b.distance_to(a.high), a.distance_to(b.low), a.distance_to(b.high)});
  Eigen::Matrix3d system;
  const Vector normal = a.half().cross(b.half());
  if (normal.norm() < 1e-9 * a.half().norm() * b.half().norm() || normal.norm() == 0) return least;
  system << a.half(), -b.half(), normal;
  const Vector places = system.partialPivLu().solve(b.middle() - a.middle());
  if (std::abs(places[0]) <= 1 && std::abs(places[1]) <= 1)
    least = std::min(least, std::abs(places[2]) * normal.norm());
  return least;
}

double separation_of(const TestBody &a, const TestBody &b)
{
  if (a.shape == half_space) return separation_of(b, a);
  if (b.shape != half_space) return distance_between(segment_of(a), segment_of(b)) - radius_of(a) - radius_of(b);
  const Vector up = b.axes().col(1);
  return std::min(up.dot(segment_of(a).low - b.center()), up.dot(segment_of(a).high - b.center())) - radius_of(a);
}

/* Moves b so that its segment is at a gap from that of a along a direction. */
void place_beside(const TestBody &a, TestBody &b, const Vector &on_a, const Vector &on_b, const Vector &direction,
                  double gap)
{
  const Segment of_b = segment_of(b);
  const Vector place = of_b.middle() + on_b.x() * of_b.half();
  const Segment of_a = segment_of(a);
  const Vector wanted = of_a.middle() + on_a.x() * of_a.half() + direction * (radius_of(a) + radius_of(b) + gap);
  b.position += (wanted - place).cast<float>();
}

/* Pairs in any position: ends beside ends or sides, crossing, parallel, and within each other. */
PairScene random_pairs(Random &random, size_t count, Shape first)
{
  PairScene scene;
  while (scene.size() < count) {
    const bool extreme = random.below(4) == 0;
    TestBody a = random_round(random, first, extreme ? 1e-3 : 0.1, extreme ? 1e2 : 1),
             b = random_round(random, capsule, extreme ? 1e-3 : 0.1, extreme ? 1e2 : 1);
    a.position = random.in_cube(1).cast<float>();
    if (random.below(3) == 0) { /* nearly parallel, as what lies side by side is */
      const double angle = random.below(3) ? random.logarithmic(1e-5, 3e-2) : 0;
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, random.direction()));
      b.orientation = (turn * a.orientation.cast<double>()).cast<float>();
      b.shape_orientation = a.shape_orientation;
    }
    const double size = std::min(radius_of(a), radius_of(b));
    const double gap = random.below(2) ? random.uniform(-1, 1) * 1e-2 * size : random.uniform(-1.5, 1) * size;
    const Vector places = random.in_cube(1.2);
    place_beside(a, b, Vector(places.x(), 0, 0), Vector(places.y(), 0, 0), random.direction(), gap);
    if (random.below(2)) scene.add(a, b);
    else scene.add(b, a);
  }
  return scene;
}

/* The contact of bodies at rest. pa and pb: where the point touches the axes, seen along the normal. */
bool is_contact_of(const TestBody &a, const TestBody &b, const Contact &contact, double separation, double tolerance)
{
  const Segment of_a = segment_of(a), of_b = segment_of(b);
  if (std::abs(contact.normal.norm() - 1) > 1e-6) return false;
  /* No normal shows a larger gap than the separation, and only that of the closest points as large a one. */
  const double gap = contact.normal.dot(of_b.middle() - of_a.middle()) - std::abs(contact.normal.dot(of_a.half())) -
                     std::abs(contact.normal.dot(of_b.half())) - radius_of(a) - radius_of(b);
  /* Segments that turn by less than SEGMENTS_CROSS count as parallel. */
  const double parallel = 4e-5 * (of_a.half().norm() + of_b.half().norm());
  if (std::abs(gap - separation) > tolerance + parallel) return false;
  double least = 1e30;
  for (const Point &point : contact.points) {
    const double middle = point.separation / 2;
    const Vector at = a.center() + point.offset, pa = at - contact.normal * (radius_of(a) + middle),
                 pb = at + contact.normal * (radius_of(b) + middle);
    const double across = contact.points.size() > 1 ? 0.03 * 2 * (of_a.half().norm() + of_b.half().norm()) : 0;
    if (of_a.distance_to(pa) > tolerance || of_b.distance_to(pb) > tolerance + across) return false;
    least = std::min(least, point.separation);
  }
  /* The closest points may lie just beyond the part that nearly parallel ones share. */
  const double lead = contact.points.size() > 1 ? 1e-4 * (size_of(a) + size_of(b)) : 0;
  return least > separation - tolerance && least < separation + tolerance + lead;
}

void compare_at_rest(PairScene scene, Kernel kernel)
{
  const Outputs outputs = scene.run({kernel});
  size_t touching = 0, apart = 0, two = 0, wrong = 0;
  for (size_t pair = 0; pair < scene.size(); ++pair) {
    const TestBody &a = scene.a(pair), &b = scene.b(pair);
    const double separation = separation_of(a, b), limit = scene.parameters.speculative_distance,
                 tolerance = 4e-6 * ((b.center() - a.center()).norm() + size_of(a) + size_of(b));
    const Contact contact = scene.contact(outputs, pair);
    if (std::abs(separation - limit) < tolerance) continue;
    const bool near = separation < limit;
    (near ? touching : apart) += 1;
    two += contact.points.size() == 2;
    /* Where the axes all but meet, rounding decides the normal: the case below is about it. */
    if (separation + radius_of(a) + radius_of(b) < 64 * tolerance) continue;
    const bool good =
        near ? !contact.points.empty() && is_contact_of(a, b, contact, separation, tolerance) : contact.points.empty();
    if (!good && wrong++ < 3) {
      CAPTURE(pair, separation, contact.points.size(), contact.normal, tolerance);
      CHECK(good);
    }
  }
  CAPTURE(touching, apart, two);
  CHECK(wrong == 0);
  CHECK(touching > scene.size() / 3);
  CHECK(apart > scene.size() / 50);
  CHECK((kernel == Kernel::collide_sphere_capsule) == (two == 0));
}

std::vector<double> sorted_x(const Contact &contact, const Vector &origin)
{
  std::vector<double> x;
  for (const Point &point : contact.points) x.push_back((origin + point.offset).x());
  std::sort(x.begin(), x.end());
  return x;
}

PairScene moving_pairs(Random &random, Shape first)
{
  PairScene scene;
  while (scene.size() < 4000) {
    TestBody a = random_round(random, first, 0.05, 0.5), b = random_round(random, capsule, 0.05, 0.5);
    const Vector direction = random.direction();
    b.position = (direction * (size_of(a) + size_of(b)) * random.uniform(1, 3)).cast<float>();
    if (first == half_space) {
      a = TestBody();
      a.shape = half_space;
      a.orientation = Eigen::Quaterniond::FromTwoVectors(Vector::UnitY(), direction).cast<float>();
    } else {
      set_in_motion(random, a, direction);
    }
    set_in_motion(random, b, -direction);
    if (separation_of(a, b) <= 0) continue;
    if (random.below(2)) scene.add(a, b);
    else scene.add(b, a);
  }
  return scene;
}

} // namespace

TEST_CASE("capsules: at rest, the contacts of the closest points of two segments")
{
  Random random(21);
  compare_at_rest(random_pairs(random, 20000, capsule), Kernel::collide_capsule_capsule);
  compare_at_rest(random_pairs(random, 20000, sphere), Kernel::collide_sphere_capsule);
}

TEST_CASE("capsules: side by side they touch at both ends of the part that they share, crossed at one point")
{
  const double a_half = 0.8, b_half = 0.5;
  for (const double shift : {-1.2, -0.4, 0.0, 0.2, 0.9, 1.25}) {
    for (const double angle : {0.0, 0.01, 0.2, 1.5}) {
      if (angle > 0.1 && std::abs(shift) > 0.5) continue; /* the end of one would be beside the other */
      PairScene scene;
      scene.add(lying_capsule(0.2, a_half, {0, 0, 0}, {1, 0, 0}),
                lying_capsule(0.1, b_half, {shift, 0.3, 0}, {std::cos(angle), 0, std::sin(angle)}));
      const Outputs outputs = scene.run({Kernel::collide_capsule_capsule});
      const Contact contact = scene.contact(outputs, 0);
      CAPTURE(shift, angle);
      REQUIRE(contact.points.size() == (angle < 0.03 ? 2 : 1));
      CHECK(contact.normal.y() == Approx(1).margin(1e-2));
      if (angle > 0) continue;
      const std::vector<double> x = sorted_x(contact, {0, 0, 0});
      CHECK(x[0] == Approx(std::max(-a_half, shift - b_half)).margin(1e-6));
      CHECK(x[1] == Approx(std::min(a_half, shift + b_half)).margin(1e-6));
      for (const Point &point : contact.points) CHECK(point.separation == Approx(0).margin(1e-6));
      CHECK(contact.points[0].slot != contact.points[1].slot);
    }
  }
  PairScene behind; /* end to end, nothing lies side by side */
  behind.add(lying_capsule(0.2, 0.8, {0, 0, 0}, {1, 0, 0}), lying_capsule(0.2, 0.8, {1.99, 0, 0}, {1, 0, 0}));
  CHECK(behind.contact(behind.run({Kernel::collide_capsule_capsule}), 0).points.size() == 1);
}

TEST_CASE("capsules: axes that meet have a normal perpendicular to both")
{
  const Vector axes[] = {{1, 0, 0}, {0, 1, 0}, {0.6, 0, 0.8}, {1, 0, 1e-9}};
  for (const Vector &first : axes)
    for (const Vector &second : axes) {
      PairScene scene;
      scene.add(lying_capsule(0.2, 0.8, {1, 2, 3}, first), lying_capsule(0.1, 0.5, {1, 2, 3}, second));
      const Contact contact = scene.contact(scene.run({Kernel::collide_capsule_capsule}), 0);
      CAPTURE(first, second);
      REQUIRE_FALSE(contact.points.empty());
      CHECK(contact.normal.norm() == Approx(1).margin(1e-6));
      CHECK(std::abs(contact.normal.dot(first)) < 1e-5);
      CHECK(std::abs(contact.normal.dot(second)) < 1e-5);
      for (const Point &point : contact.points) CHECK(point.separation == Approx(-0.3).margin(1e-5));
    }
  PairScene in_axis; /* a ball on the axis of a capsule */
  TestBody ball;
  ball.shape = sphere;
  ball.size = {0.1f, 0.1f, 0.1f};
  in_axis.add(ball, lying_capsule(0.2, 0.8, {0, 0, 0}, {0, 0, 1}));
  const Contact contact = in_axis.contact(in_axis.run({Kernel::collide_sphere_capsule}), 0);
  REQUIRE(contact.points.size() == 1);
  CHECK(contact.normal.norm() == Approx(1).margin(1e-6));
  CHECK(std::abs(contact.normal.z()) < 1e-5);
  CHECK(contact.points[0].separation == Approx(-0.3).margin(1e-6));
}

TEST_CASE("capsule against half-space: below both ends where it lies, below the lower one where it stands")
{
  Random random(22);
  PairScene scene;
  while (scene.size() < 20000) {
    TestBody body = random_round(random, capsule, 1e-2, 1e2), ground;
    ground.shape = half_space;
    ground.orientation = random.orientation().cast<float>();
    ground.position = random.in_cube(1).cast<float>();
    const Vector up = ground.axes().col(1);
    const double gap = random.uniform(-1, 1) * (random.below(2) ? 0.02 : radius_of(body));
    body.position += (up * (gap - separation_of(body, ground))).cast<float>();
    if (random.below(2)) scene.add(body, ground);
    else scene.add(ground, body);
  }
  const Outputs outputs = scene.run({Kernel::collide_capsule_half_space});
  size_t wrong = 0, points = 0;
  for (size_t pair = 0; pair < scene.size(); ++pair) {
    const bool first = scene.a(pair).shape == capsule;
    const TestBody &body = first ? scene.a(pair) : scene.b(pair), &ground = first ? scene.b(pair) : scene.a(pair);
    const Segment segment = segment_of(body);
    const Vector up = ground.axes().col(1), ends[2] = {segment.low, segment.high};
    const double tolerance = 4e-6 * ((body.center() - ground.center()).norm() + size_of(body) + 1);
    const Contact contact = scene.contact(outputs, pair);
    bool good = true;
    for (uint32_t slot = 0; slot < 2; ++slot) {
      const double separation = up.dot(ends[slot] - ground.center()) - radius_of(body);
      if (std::abs(separation - double(scene.parameters.speculative_distance)) < tolerance) continue;
      const auto found = std::find_if(contact.points.begin(), contact.points.end(),
                                      [&](const Point &point) { return point.slot == slot; });
      const double cosine = std::abs(up.dot(segment.half().normalized()));
      if (std::abs(cosine - 0.5) < 1e-5) continue;
      const bool is_lower = up.dot(ends[slot] - ends[1 - slot]) < 0;
      const bool near = separation < double(scene.parameters.speculative_distance) && (cosine < 0.5 || is_lower);
      good = good && near == (found != contact.points.end());
      if (!near || found == contact.points.end()) continue;
      ++points;
      const Vector expected = ends[slot] - up * (radius_of(body) + separation / 2);
      good = good && std::abs(found->separation - separation) < tolerance &&
             (scene.a(pair).center() + found->offset - expected).norm() < tolerance &&
             (contact.normal - (first ? -up : up)).norm() < 1e-5;
    }
    if (!good && wrong++ < 3) {
      CAPTURE(pair, tolerance);
      CHECK(good);
    }
  }
  CHECK(wrong == 0);
  CHECK(points > scene.size() / 2);
}

TEST_CASE("capsules: in motion, contacts of the moment at which they touch, and none where they pass")
{
  Random random(23);
  compare_in_motion(moving_pairs(random, capsule), {Kernel::collide_capsule_capsule, Kernel::follow_capsules},
                    separation_of);
  compare_in_motion(moving_pairs(random, sphere), {Kernel::collide_sphere_capsule, Kernel::follow_sphere_capsules},
                    separation_of);
  compare_in_motion(moving_pairs(random, half_space), {Kernel::collide_capsule_half_space}, separation_of);
}
