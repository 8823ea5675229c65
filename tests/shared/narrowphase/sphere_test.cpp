/* Spheres against spheres, boxes and half-spaces: closed forms in double precision. */
#include "tests/catch.h"
#include "tests/shared/narrowphase/box_reference.h"

using namespace tandem;
using namespace tandem::narrowphase_tests;

namespace {

constexpr size_t pairs = 20000;

TestBody random_body(Random &random, Shape shape, double low, double high)
{
  TestBody body;
  body.shape = shape;
  for (int k = 0; k < 3; ++k) body.size[k] = static_cast<float>(random.logarithmic(low, high));
  body.orientation = random.orientation().cast<float>();
  body.linear = (random.in_cube(3)).cast<float>();
  body.angular = (random.in_cube(3)).cast<float>();
  return body;
}

double scale_of(const TestBody &body) { return body.shape == sphere ? body.size.x() : body.size.norm(); }

/* The properties of a contact, however it was found. */
struct Expected {
  Vector normal; /* from a to b */
  double separation;
  Vector point; /* midway, in the world */
  bool normal_is_unique;
};

/* A sphere that turns reaches no farther. */
double swung_radius(const TestBody &body) { return body.shape == sphere ? 0 : double(body.bounding_radius()); }

/* Speculative distance plus what two bodies can close in a step. */
double reach(const PairScene &scene, size_t pair, const Vector &normal)
{
  const TestBody &a = scene.a(pair), &b = scene.b(pair);
  const double closing = -(b.linear - a.linear).cast<double>().dot(normal) +
                         double(a.angular.norm()) * swung_radius(a) + double(b.angular.norm()) * swung_radius(b);
  return scene.parameters.speculative_distance + scene.parameters.step * std::max(0.0, closing);
}

/* The least separation of many moments before `time`. */
template <class Reference> double least_before(const TestBody &a, const TestBody &b, double time, Reference reference)
{
  double least = 1e30;
  for (int k = 0; k < 48; ++k)
    least = std::min(least, reference(moved(a, time * k / 48), moved(b, time * k / 48)).separation);
  return least;
}

/* A body that turns past another without touching it is guarded by a contact of the end of the step in its own
 * centre. */
bool is_in_a_centre(const TestBody &a, const TestBody &b, const Point &point, double tolerance)
{
  return std::min(point.offset.norm(), (a.center() + point.offset - b.center()).norm()) < tolerance;
}

/* By what the arms of two bodies that can be pushed would move the plane of their contact within a step, for they
 * follow half of what the bodies slide; below 0 away from the other. */
double turned_by_arms(const TestBody &a, const TestBody &b, const Contact &contact, double step)
{
  const Vector slid = step * (b.linear - a.linear).cast<double>();
  return step * slid.cross(contact.normal).dot((a.angular + b.angular).cast<double>() / 2);
}

/* How much nearer the points of a contact come within a step by their own motion. */
double closed_by_motion(const TestBody &a, const TestBody &b, const Contact &contact, double step)
{
  const Vector arm_a = contact.points[0].offset, arm_b = a.center() + arm_a - b.center();
  const Vector approach = a.angular.cast<double>().cross(arm_a) - b.angular.cast<double>().cross(arm_b) -
                          (b.linear - a.linear).cast<double>();
  return std::max(0.0, step * approach.dot(contact.normal));
}

/* Of a pair that misses, what becomes of a contact that its plane would only be turned into: it is put where that does
 * not reach it, or its arms stay (`stays`), where the margin does not suffice. */
struct Turning {
  double motion, either_way, toward; /* m within the step */
  double margin;

  bool is_clear(double separation) const { return separation > motion + either_way; }
  bool is_put_clear(double separation, double tolerance) const
  {
    return either_way <= margin + tolerance && std::abs(separation - 1.01 * (motion + toward)) < tolerance;
  }
  bool must_stay(double separation, double tolerance) const
  {
    return either_way > margin - tolerance && motion + either_way > separation - tolerance;
  }
};

double least_size(const TestBody &body) { return double(body.shape == sphere ? body.size.x() : body.size.minCoeff()); }

Turning turning_of(const TestBody &a, const TestBody &b, const Contact &contact, double time, double step)
{
  const double turned = turned_by_arms(a, b, contact, step);
  Turning t{closed_by_motion(a, b, contact, step), std::abs(turned), std::max(0.0, turned),
            0.05 * std::min(least_size(a), least_size(b))};
  if (time > 0) t.toward = t.either_way *= std::max(1.0, time / step);
  return t;
}

/* The contact at the moment of its impact, which is 0 for those of the start, and seen from the start. guards: it is of
 * the end. */
bool is_as_expected(const TestBody &a, const TestBody &b, const Contact &contact, const Expected &expected, double time,
                    double tolerance, bool guards, bool put_clear)
{
  const Point &point = contact.points[0];
  const Vector arm_b = a.center() + point.offset - b.center(), approach = (a.linear - b.linear).cast<double>() +
                                                                          a.angular.cast<double>().cross(point.offset) -
                                                                          b.angular.cast<double>().cross(arm_b);
  const double seen = expected.separation + time * std::max(0.0, approach.dot(contact.normal));
  if ((!put_clear && std::abs(point.separation - seen) > tolerance) || contact.code != 0 || point.slot != 0 ||
      std::abs(contact.normal.norm() - 1) > 1e-6)
    return false;
  if (!expected.normal_is_unique) return true;
  const double angle =
      time > 0 ? 2e-2 : 1e-3; /* at an impact the shapes are a hair apart, of which rounding is a larger part */
  const bool is_in_place = guards ? is_in_a_centre(a, b, point, tolerance)
                                  : (a.center() + point.offset - expected.point).norm() < 1e3 * tolerance;
  return (contact.normal - expected.normal).norm() < angle && is_in_place;
}

/* How near two spheres, whose turning moves nothing, come to the plane of their contact by the end of the step. */
double left_before_plane(const TestBody &a, const TestBody &b, const Contact &contact, double step)
{
  return contact.points[0].separation + step * (b.linear - a.linear).cast<double>().dot(contact.normal);
}

/* The gap at which two spheres pass each other, whenever that is; below 0 they meet. */
double passing_gap(const TestBody &a, const TestBody &b)
{
  const Vector between = b.center() - a.center(), velocity = (b.linear - a.linear).cast<double>();
  const double nearest = velocity.squaredNorm() > 0 ? -between.dot(velocity) / velocity.squaredNorm() : 0;
  return (between + nearest * velocity).norm() - double(a.size.x()) - double(b.size.x());
}

/* Contacts of the start and those at impact against `reference` of where the bodies are then; what is left out must
 * miss. Spheres that miss have a contact where they pass each other, whose plane they do not meet. */
template <class Reference> void compare(PairScene &scene, Kernel kernel, Reference reference)
{
  const Outputs outputs = scene.run({kernel});
  size_t touching = 0, at_impact = 0, missing = 0, passing = 0, clear = 0, staying = 0, wrong = 0;
  for (size_t pair = 0; pair < scene.size(); ++pair) {
    const TestBody &a = scene.a(pair), &b = scene.b(pair);
    const bool stays = outputs.normals[pair].w < 0;
    const double moment = std::abs(outputs.normals[pair].w), time = moment > 1e-11 ? moment : 0,
                 scale = scale_of(a) + scale_of(b), step = scene.parameters.step;
    const double tolerance = 2e-6 * ((b.center() - a.center()).norm() + scale + time * (a.linear - b.linear).norm());
    Expected expected = reference(moved(a, time), moved(b, time));
    const bool of_spheres = kernel == Kernel::collide_sphere_sphere && time > 0;
    if (of_spheres && std::abs(passing_gap(a, b)) < 2 * tolerance) continue; /* rounding says whether they meet */
    const bool passes = of_spheres && (passing_gap(a, b) > 0 || expected.separation > 16 * tolerance);
    const double limit = reach(scene, pair, expected.normal);
    if (time == 0 && std::abs(expected.separation - limit) < tolerance * 4) continue;
    const bool near = time > 0 || expected.separation < limit, guards = moment == step;
    bool good = true;
    if (outputs.counts[pair] > 0) {
      const Contact contact = scene.contact(outputs, pair);
      const Turning turning = turning_of(moved(a, time), moved(b, time), contact, time, step);
      const double gap = expected.separation, seen = contact.points[0].separation;
      const bool put_clear =
          !stays && (time == 0 || passes) && seen > gap + tolerance && turning.is_put_clear(seen, 8 * tolerance);
      clear += put_clear, staying += stays;
      good = near && is_as_expected(moved(a, time), moved(b, time), contact, expected, time,
                                    tolerance * (time > 0 ? 4 : 1), guards, put_clear);
      good = good && (!(put_clear || stays) || least_before(a, b, step, reference) > -4 * tolerance);
      good = good && (!stays || turning.must_stay(gap, 8 * tolerance));
      good = good && (!passes || stays || turning.is_clear(seen + 8 * tolerance));
      good = good && (time == 0 || least_before(a, b, time, reference) > -4 * tolerance);
      good = good && (!passes || left_before_plane(a, b, contact, step) > -4 * tolerance);
      (passes ? passing : time > 0 ? at_impact : touching) += 1;
    } else if (near) {
      good = least_before(a, b, step, reference) > -4 * tolerance;
      ++missing;
    }
    if (!good && wrong++ < 3) {
      CAPTURE(pair, time, expected.separation, limit, outputs.counts[pair], expected.normal);
      CHECK(good);
    }
  }
  CAPTURE(touching, at_impact, missing, passing, clear, staying);
  CHECK(wrong == 0);
  CHECK(touching > scene.size() / 4);
  CHECK((kernel == Kernel::collide_sphere_half_space || clear > 0));
  CHECK((kernel == Kernel::collide_sphere_half_space ||
         (at_impact > scene.size() / 500 && missing + passing > scene.size() / 500)));
}

/* b at a given gap from a along a direction, plus noise: touching, apart and overlapping alike. */
double random_gap(Random &random, double size)
{
  switch (random.below(4)) {
  case 0: return random.uniform(-1, 1) * 1e-6 * size;
  case 1: return random.uniform(-0.05, 0.05) * size;
  case 2: return random.uniform(0, 0.5) * size;
  default: return -random.uniform(0, 1) * size;
  }
}

} // namespace

TEST_CASE("sphere against sphere: distance of centres less the radii")
{
  Random random(1);
  PairScene scene;
  while (scene.size() < pairs) {
    const bool extreme = random.below(4) == 0;
    TestBody a = random_body(random, sphere, extreme ? 1e-3 : 0.1, extreme ? 1e3 : 1);
    TestBody b = random_body(random, sphere, extreme ? 1e-3 : 0.1, extreme ? 1e3 : 1);
    const double sum = double(a.size.x()) + b.size.x();
    a.position = random.in_cube(1).cast<float>();
    const double distance = std::max(0.0, sum + random_gap(random, std::min(a.size.x(), b.size.x())));
    b.position = a.position + (random.direction() * distance).cast<float>();
    scene.add(a, b);
  }
  compare(scene, Kernel::collide_sphere_sphere, [](const TestBody &a, const TestBody &b) {
    const Vector between = b.center() - a.center();
    const double distance = between.norm(), separation = distance - a.size.x() - b.size.x();
    const Vector normal = distance > 0 ? Vector(between / distance) : Vector(Vector::UnitY());
    return Expected{normal, separation, a.center() + normal * (a.size.x() + separation / 2), distance > 1e-6};
  });
}

TEST_CASE("coincident spheres part sideways, in directions that add up to nothing")
{
  PairScene scene;
  TestBody ball;
  ball.shape = sphere;
  const size_t pairs = 1024;
  while (scene.size() < pairs) scene.add(ball, ball);
  const Outputs outputs = scene.run({Kernel::collide_sphere_sphere});
  Vector sum = Vector::Zero(), squares = Vector::Zero();
  for (size_t pair = 0; pair < pairs; ++pair) {
    const Contact contact = scene.contact(outputs, pair);
    REQUIRE(contact.points.size() == 1);
    REQUIRE(contact.points[0].separation == -2);
    REQUIRE(contact.normal.norm() == Approx(1));
    REQUIRE(contact.normal.y() == 0);
    sum += contact.normal;
    squares += contact.normal.cwiseAbs2();
  }
  CHECK(sum.norm() <
        4 * std::sqrt(double(pairs))); /* as of random directions: one of sixteen thousand sums is longer */
  CHECK(squares.x() == Approx(pairs / 2.0).margin(pairs / 10.0));
}

TEST_CASE("sphere against box: the nearest point, or the face of least depth")
{
  Random random(2);
  PairScene scene;
  while (scene.size() < pairs) {
    const bool extreme = random.below(4) == 0;
    TestBody ball = random_body(random, sphere, extreme ? 1e-3 : 0.1, extreme ? 1e3 : 1);
    TestBody brick = random_body(random, box, extreme ? 1e-3 : 0.1, extreme ? 1e3 : 1);
    brick.position = random.in_cube(1).cast<float>();
    /* The direction outward from a point of the surface. */
    Vector on_surface = random.in_cube(1);
    const uint32_t kept = random.below(3);
    on_surface[kept] = random.sign();
    if (random.below(2)) on_surface[(kept + 1) % 3] = random.sign();
    const Vector outward = (brick.axes() * on_surface.array().round().matrix()).normalized();
    const double size = std::min<double>(ball.size.x(), brick.size.minCoeff());
    const bool inside = random.below(3) == 0;
    const double gap = inside ? -ball.size.x() - random.uniform(0, 1) * size : random_gap(random, size);
    const Vector center =
        brick.center() + brick.axes() * on_surface.cwiseProduct(brick.extent()) + outward * (ball.size.x() + gap);
    ball.position = center.cast<float>();
    if (random.below(2)) scene.add(ball, brick);
    else scene.add(brick, ball);
  }
  compare(scene, Kernel::collide_sphere_box, [](const TestBody &a, const TestBody &b) {
    const bool sphere_first = a.shape == sphere;
    const TestBody &ball = sphere_first ? a : b, &brick = sphere_first ? b : a;
    const Vector local = brick.axes().transpose() * (ball.center() - brick.center());
    const Vector nearest = local.cwiseMax(-brick.extent()).cwiseMin(brick.extent());
    const double distance = (local - nearest).norm();
    Vector outward;
    double surface = distance;
    bool unique = true;
    if (distance > 0) {
      outward = (local - nearest) / distance;
      unique = distance > 1e-3 * (brick.extent().norm() + local.norm());
    } else {
      const Vector depth = brick.extent() - local.cwiseAbs();
      int face;
      surface = -depth.minCoeff(&face);
      outward = Vector::Unit(face) * (local[face] < 0 ? -1 : 1);
      const double margin = 1e-5 * brick.extent().norm();
      unique = (depth.array() < depth.minCoeff() + margin).count() == 1 && std::abs(local[face]) > margin &&
               depth.minCoeff() > margin;
    }
    const double separation = surface - ball.size.x();
    const Vector world = brick.axes() * outward;
    return Expected{sphere_first ? Vector(-world) : world, separation,
                    ball.center() - world * (ball.size.x() + separation / 2), unique};
  });
}

TEST_CASE("sphere against half-space: height above the plane")
{
  Random random(3);
  PairScene scene;
  while (scene.size() < pairs) {
    TestBody ball = random_body(random, sphere, 1e-3, 1e3);
    TestBody ground = random_body(random, half_space, 1, 1);
    ground.position = random.in_cube(1).cast<float>();
    const Vector up = ground.axes().col(1);
    const Vector along = ground.axes().col(0) * random.uniform(-5, 5);
    ball.position = (ground.center() + along + up * (ball.size.x() + random_gap(random, ball.size.x()))).cast<float>();
    if (random.below(2)) scene.add(ball, ground);
    else scene.add(ground, ball);
  }
  compare(scene, Kernel::collide_sphere_half_space, [](const TestBody &a, const TestBody &b) {
    const bool sphere_first = a.shape == sphere;
    const TestBody &ball = sphere_first ? a : b, &ground = sphere_first ? b : a;
    const Vector up = ground.axes().col(1);
    const double separation = up.dot(ball.center() - ground.center()) - ball.size.x();
    return Expected{sphere_first ? Vector(-up) : up, separation, ball.center() - up * (ball.size.x() + separation / 2),
                    true};
  });
}
