/* Manifolds of convex shapes: the positions of their points, their depths, and the part of the contact that they
 * span. */
#include "tests/catch.h"
#include "tests/shared/narrowphase/convex_shapes.h"

using namespace tandem;
using namespace tandem::convex_tests;

namespace {

constexpr uint_lanes methods[] = {CONVEX_EXPANSION, CONVEX_SAMPLED, CONVEX_AXES};
constexpr real slop = R(0.005);

struct Contact {
  Vector normal;
  std::vector<Vector> points;
  std::vector<double> separations;
  std::vector<int> slots;
  uint_lanes code;

  explicit Contact(const manifold &m) : normal(m.normal.x, m.normal.y, m.normal.z), code(m.code)
  {
    for (int slot = 0; slot < 4; ++slot)
      if (m.kept[slot]) {
        points.push_back({m.point[slot].x, m.point[slot].y, m.point[slot].z});
        separations.push_back(m.point[slot].w);
        slots.push_back(slot);
      }
  }
  double deepest() const { return *std::min_element(separations.begin(), separations.end()); }
  bool finite() const
  {
    bool good = normal.allFinite() && std::abs(normal.norm() - 1) < 2e-6;
    for (const Vector &p : points) good = good && p.allFinite();
    for (double s : separations) good = good && std::isfinite(s);
    return good;
  }
};

Contact contact_of(const Shape &a, const Shape &b, double reach, uint_lanes method)
{
  const convex record_a = a.record(), record_b = b.record();
  return Contact(convex_contact(&record_a, &record_b, real(reach), slop, method));
}

/* Twice the area of the triangle or quadrilateral spanned, seen along a direction. */
double spanned_area(std::vector<Vector> points, const Vector &direction)
{
  if (points.size() < 3) return 0;
  const Vector u = direction.unitOrthogonal(), v = direction.cross(u);
  Vector middle = Vector::Zero();
  for (const Vector &p : points) middle += p / double(points.size());
  const auto angle = [&](const Vector &p) { return std::atan2((p - middle).dot(v), (p - middle).dot(u)); };
  std::sort(points.begin(), points.end(), [&](const Vector &p, const Vector &q) { return angle(p) < angle(q); });
  double area = 0;
  for (size_t k = 0; k < points.size(); ++k) {
    const Vector &p = points[k], &q = points[(k + 1) % points.size()];
    area += (p - middle).cross(q - middle).dot(direction);
  }
  return std::abs(area) / 2;
}

/* Is a point inside the convex polygon of points around it, seen along a direction? */
bool holds(const std::vector<Vector> &points, const Vector &direction, const Vector &inside)
{
  std::vector<Vector> with = points;
  double area = spanned_area(points, direction), fan = 0;
  for (size_t i = 0; i < points.size(); ++i)
    for (size_t j = i + 1; j < points.size(); ++j)
      for (size_t k = j + 1; k < points.size(); ++k) {
        const double whole = spanned_area({points[i], points[j], points[k]}, direction);
        fan = spanned_area({inside, points[i], points[j]}, direction) +
              spanned_area({inside, points[j], points[k]}, direction) +
              spanned_area({inside, points[k], points[i]}, direction);
        if (fan < whole + 1e-4 * area) return true;
      }
  return false;
}

Shape shape_of_kind(uint_lanes kind, float x, float y, float z)
{
  Shape shape;
  shape.kind = kind;
  shape.size = Eigen::Vector3f(x, y, z);
  return shape;
}
Shape turned(Shape shape, double angle, const Vector &axis)
{
  shape.orientation = (Eigen::AngleAxisd(angle, axis) * shape.orientation.cast<double>()).cast<float>();
  return shape;
}

/* The ground is body a, whose centre lies one below its face. */
Contact on_ground(Shape shape, double gap, uint_lanes method = CONVEX_EXPANSION)
{
  const Shape floor = shape_of_kind(SHAPE_BOX, 50, 1, 50);
  shape.center.y() = 0;
  shape.center.y() = float(1 + gap - shape.support(-Vector::UnitY()).y());
  return contact_of(floor, shape, 0.02, method);
}

double spread(const std::vector<Vector> &points)
{
  double most = 0;
  for (const Vector &p : points)
    for (const Vector &q : points) most = std::max(most, (p - q).norm());
  return most;
}

} // namespace

TEST_CASE("convex contact: the deepest point is as deep as the shapes, all lie between their surfaces")
{
  ShapeMaker maker(1);
  const double reach = 0.02;
  for (uint_lanes method : methods) {
    Errors depth, outside, normals;
    size_t touching = 0, wrong = 0, missed = 0, points = 0;
    for (size_t pair = 0; pair < 40000; ++pair) {
      const Shape a = maker.any(0.2, 2);
      Shape b = maker.any(0.2, 2);
      const double least = std::max(1e-3, std::min(a.least(), b.least())), size = a.radius() + b.radius();
      if (pair % 8 == 0) b.orientation = a.orientation;
      const double gap = maker.random.uniform(-0.02, 0.02) * (pair % 2 ? least : 1);
      ShapeMaker::place(a, b, maker.random.direction(), gap);
      ShapeMaker::place(a, b, find(a, b, CONVEX_EXPANSION).normal.normalized(), gap);
      const Contact contact = contact_of(a, b, reach, method);
      if (!contact.finite()) ++wrong;
      const Found found = find(a, b, method);
      if (contact.points.empty()) {
        missed += found.gap < reach - 1e-3;
        continue;
      }
      ++touching;
      points += contact.points.size();
      depth.add(std::abs(contact.deepest() - gap_between(a, b, contact.normal.normalized())) / size, pair);
      normals.add(std::abs(contact.deepest() - found.gap), pair);
      for (size_t k = 0; k < contact.points.size(); ++k) {
        const double slack = std::abs(contact.separations[k]) / 2;
        outside.add(
            std::max(0.0, std::max(outside_by(a, contact.points[k]), outside_by(b, contact.points[k])) - slack) / size,
            pair);
      }
    }
    INFO("method " << method << ": " << touching << " touch, with " << points
                   << " points; deepest against the gap along the normal: largest " << depth.largest << " (pair "
                   << depth.worst << "), 99.9% " << depth.quantile(0.999) << "; outside: largest " << outside.largest
                   << " (pair " << outside.worst << "), 99.9% " << outside.quantile(0.999));
    CHECK(wrong == 0);
    CHECK(missed == 0);
    CHECK(depth.largest < 2e-4);
    CHECK(outside.quantile(0.999) < 2e-4);
    if (method != CONVEX_SAMPLED)
      CHECK(outside.largest < 1e-2); /* a normal far from the least depth has no point of both along it */
    CHECK(touching > 10000);
  }
}

TEST_CASE("convex contact: boxes face to face span the whole overlap, by every method")
{
  Random random(2);
  for (uint_lanes method : methods) {
    size_t wrong = 0;
    for (size_t pair = 0; pair < 3000; ++pair) {
      Shape a = shape_of_kind(SHAPE_BOX, 1, 0.5f, 0.8f), b = shape_of_kind(SHAPE_BOX, 0.3f, 0.4f, 0.5f);
      if (pair % 2) {
        a.kind = SHAPE_HULL;
        static const auto hull = box_hull({1, 0.5, 0.8});
        a.hull = hull;
      }
      a.orientation = random.orientation().cast<float>();
      const double angle = random.uniform(0, 6);
      b.orientation = (a.orientation.cast<double>() * Eigen::AngleAxisd(angle, Vector::UnitY())).cast<float>();
      const double gap = random.uniform(-0.01, 0.01);
      const Vector up = a.axes().col(1),
                   sideways = a.axes() * Vector(random.uniform(-0.3, 0.3), 0, random.uniform(-0.1, 0.1));
      b.center = (up * (0.9 + gap) + sideways).cast<float>();
      const Contact contact = pair % 3 ? contact_of(a, b, 0.02, method) : contact_of(b, a, 0.02, method);
      bool good = contact.points.size() == 4 && std::abs(contact.deepest() - gap) < 1e-5;
      const double sense = pair % 3 ? 1 : -1;
      good = good && (contact.normal - sense * up).norm() < 1e-5;
      good = good && std::abs(spanned_area(contact.points, up) - 4 * 0.3 * 0.5) < 1e-4;
      const Vector middle = pair % 3 ? b.middle() : Vector::Zero();
      /* seen from the centre of body a, which is b's where the two are swapped */
      if (pair % 3) good = good && holds(contact.points, up, middle);
      wrong += !good;
    }
    CAPTURE(method);
    CHECK(wrong == 0);
  }
}

TEST_CASE("convex contact: a cylinder lying, standing and tilted on the ground")
{
  const Shape can = shape_of_kind(SHAPE_CYLINDER, 0.5f, 1, 0.5f);
  for (double gap : {-0.004, 0.0, 0.01}) {
    for (double heading : {0.0, 0.3, 1.1, 2.0}) {
      CAPTURE(gap, heading);
      const Contact lying = on_ground(turned(turned(can, M_PI / 2, Vector::UnitX()), heading, Vector::UnitY()), gap);
      REQUIRE(lying.points.size() == 2);
      CHECK(spread(lying.points) == Approx(2).epsilon(1e-4));
      CHECK((lying.normal - Vector::UnitY()).norm() < 1e-5);
      CHECK(lying.deepest() == Approx(gap).margin(1e-5));

      const Contact standing = on_ground(turned(can, heading, Vector::UnitY()), gap);
      REQUIRE(standing.points.size() == 4);
      CHECK(spanned_area(standing.points, Vector::UnitY()) > 0.5 * M_PI * 0.25);
      CHECK(holds(standing.points, Vector::UnitY(), Vector(0, 1, 0)));
      CHECK(standing.deepest() == Approx(gap).margin(1e-5));

      for (double tilt : {0.2, 0.7, 1.2}) {
        CAPTURE(tilt);
        const Contact tilted = on_ground(turned(turned(can, tilt, Vector::UnitX()), heading, Vector::UnitY()), gap);
        CHECK(tilted.points.size() >= 1);
        CHECK(tilted.points.size() <= 2);
        CHECK(tilted.deepest() == Approx(gap).margin(1e-5));
      }
    }
  }
}

TEST_CASE("convex contact: a cone on its side and on its base, a capsule lying and standing")
{
  const Shape cone = shape_of_kind(SHAPE_CYLINDER, 0.5f, 1, 0), capsule = shape_of_kind(SHAPE_CAPSULE, 0.3f, 1, 0.3f);
  const Contact base = on_ground(cone, -0.001);
  CHECK(base.points.size() == 4);
  CHECK(base.deepest() == Approx(-0.001).margin(1e-5));
  const Contact side = on_ground(turned(cone, M_PI / 2 + std::atan2(0.5, 2.0), Vector::UnitX()), -0.001);
  REQUIRE(side.points.size() == 2);
  CHECK(spread(side.points) == Approx(std::hypot(2, 0.5)).epsilon(1e-3));
  const Contact tip = on_ground(turned(cone, M_PI, Vector::UnitX()), -0.001);
  CHECK(tip.points.size() == 1);
  const Contact lying = on_ground(turned(capsule, M_PI / 2, Vector::UnitZ()), 0.005);
  REQUIRE(lying.points.size() == 2);
  CHECK(spread(lying.points) == Approx(2).epsilon(1e-4));
  CHECK(lying.deepest() == Approx(0.005).margin(1e-5));
  CHECK(on_ground(capsule, -0.003).points.size() == 1);
  Shape tapered = shape_of_kind(SHAPE_CAPSULE, 0.2f, 1, 0.5f);
  const Contact on_both = on_ground(turned(tapered, M_PI / 2 - std::asin(0.3 / 2), Vector::UnitX()), -0.002);
  REQUIRE(on_both.points.size() == 2);
  CHECK(on_both.deepest() == Approx(-0.002).margin(1e-5));
}

TEST_CASE("convex contact: two cylinders side by side touch along a line, crossed in a point")
{
  const Shape a = shape_of_kind(SHAPE_CYLINDER, 0.5f, 1, 0.5f);
  Shape b = shape_of_kind(SHAPE_CYLINDER, 0.4f, 0.7f, 0.4f);
  b.center = Eigen::Vector3f(0.895f, 0.6f, 0);
  const Contact along = contact_of(a, b, 0.02, CONVEX_EXPANSION);
  REQUIRE(along.points.size() == 2);
  CHECK(spread(along.points) == Approx(1.1).epsilon(1e-3)); /* from -0.1 to 1 */
  CHECK(along.deepest() == Approx(-0.005).margin(1e-5));
  const Contact crossed = contact_of(a, turned(b, M_PI / 2, Vector::UnitX()), 0.02, CONVEX_EXPANSION);
  CHECK(crossed.points.size() == 1);
  CHECK(crossed.deepest() == Approx(-0.005).margin(1e-5));
}

/* A millimetre over a kilometre: to the size of the small one while the large one is seen in its own axes. */
TEST_CASE("convex contact: tiny on huge keeps the precision of the tiny one")
{
  ShapeMaker maker(6);
  for (uint_lanes method : methods) {
    Errors errors, turned_too;
    for (size_t pair = 0; pair < 20000; ++pair) {
      Shape huge, tiny = maker.any(1e-3, 1e-2);
      if (tiny.kind == SHAPE_HULL) continue;
      huge.size = Eigen::Vector3f(1000, 512, 800);
      if (pair % 2) huge.orientation = maker.random.orientation().cast<float>();
      const Vector up = huge.axes().col(1), sideways = huge.axes().col(0) * maker.random.uniform(-900, 900);
      const double gap = maker.random.uniform(-0.3, 1) * tiny.least();
      tiny.center = (up * (512 + gap - up.dot(tiny.support(-up))) + sideways).cast<float>();
      const double exact = gap_between(huge, tiny, up);
      if (exact < -0.9 * tiny.least()) continue;
      const Contact contact = contact_of(huge, tiny, 0.02, method);
      const double error = contact.points.empty() ? 1 : std::abs(contact.deepest() - exact);
      if (pair % 2) turned_too.add(error / 1000, pair);
      else errors.add(error / tiny.radius(), pair);
    }
    INFO("method " << method << ": largest error " << errors.largest << " of the tiny size, worst pair " << errors.worst
                   << ", 99.9% " << errors.quantile(0.999) << "; where the huge is turned: " << turned_too.largest
                   << " of its size");
    CHECK(errors.largest < 1e-4);
    CHECK(turned_too.largest < 2e-6); /* of a normalised quaternion's rounding */
  }
}

TEST_CASE("convex contact: slots and features stay with their points while a shape creeps")
{
  for (uint_lanes kind : {SHAPE_BOX, SHAPE_CYLINDER}) {
    Shape shape = shape_of_kind(kind, 0.5f, 0.5f, 0.5f);
    Random random(3);
    const Contact before = on_ground(shape, -0.002);
    REQUIRE(before.points.size() == 4);
    size_t moved = 0;
    for (int step = 0; step < 500; ++step) {
      Shape now = turned(shape, random.uniform(-1e-5, 1e-5), random.direction());
      now.center = Eigen::Vector3f(float(random.uniform(-1e-4, 1e-4)), 0, 0);
      const Contact after = on_ground(now, random.uniform(-0.003, -0.001));
      REQUIRE(after.points.size() == 4);
      moved += after.code != before.code || after.slots != before.slots;
      for (int k = 0; k < 4; ++k) moved += (after.points[k] - before.points[k]).norm() > 0.01;
    }
    CAPTURE(kind);
    CHECK(moved == 0);
  }
}

TEST_CASE("convex contact: a centre of mass off the middle moves the shape, not the contact")
{
  const Shape floor = shape_of_kind(SHAPE_BOX, 50, 1, 50);
  const Shape cone = turned(shape_of_kind(SHAPE_CYLINDER, 0.5f, 1, 0.2f), 0.4, Vector::UnitZ());
  const vec3 middle = make_vec3(0, R(0.25), 0), offset = make_vec3(0, R(2.0), 0);
  const convex record =
                   convex_of(cone.kind, make_vec3(0.5f, 1, 0.2f), cone.rotation(), offset, middle, 0, hull_tables{}),
               a = floor.record();
  Shape same = cone;
  same.center = Eigen::Vector3f(0, 2, 0) + (cone.axes() * Vector(0, 0.25, 0)).cast<float>();
  const Contact first(convex_contact(&a, &record, R(0.5), slop, CONVEX_EXPANSION)),
      second = contact_of(floor, same, 0.5, CONVEX_EXPANSION);
  REQUIRE(first.points.size() == second.points.size());
  CHECK(first.deepest() == Approx(second.deepest()).margin(1e-6));
}

TEST_CASE("convex contact: on a half-space the gap is the height of the lowest point")
{
  ShapeMaker maker(7);
  Errors errors, outside;
  size_t wrong = 0;
  for (size_t pair = 0; pair < 100000; ++pair) {
    Shape shape = maker.any(0.1, 2);
    const Vector up = maker.random.direction().cast<float>().cast<double>().normalized();
    const double height = shape.support(-up).dot(up) - maker.random.uniform(-0.05, 0.05);
    const convex record = shape.record();
    const vec3 normal = make_vec3(real(up.x()), real(up.y()), real(up.z()));
    const Contact contact(convex_on_half_space(&record, normal, real(height), R(0.1)));
    wrong += !contact.finite() || contact.points.empty();
    if (contact.points.empty()) continue;
    errors.add(std::abs(contact.deepest() - (shape.support(-up).dot(up) - height)) / shape.radius(), pair);
    for (size_t k = 0; k < contact.points.size(); ++k)
      outside.add(std::max(0.0, outside_by(shape, contact.points[k]) - std::abs(contact.separations[k]) / 2) /
                      shape.radius(),
                  pair);
  }
  INFO("largest error " << errors.largest << " of the size, 99.9% " << errors.quantile(0.999) << "; outside "
                        << outside.largest);
  CHECK(wrong == 0);
  CHECK(errors.largest < 2e-4); /* the deepest must lead by 1e-4 of the size */
  CHECK(outside.largest < 1e-5);
}
