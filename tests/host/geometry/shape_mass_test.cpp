/* shape_mass_test.cpp - a body's frame has its shape's centre of mass and principal axes, checked by sums over volume
 * elements in the world. */
#include <cstring>
#include <functional>

#include <Eigen/Dense>

#include "host/base/random.h"
#include "host/geometry/shape_mass.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

Vector eigen(const Vec3 &v) { return {v[0], v[1], v[2]}; }
Vector eigen(const Double3 &v) { return {v[0], v[1], v[2]}; }
Eigen::Quaterniond turn_of(const Quat &q) { return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized(); }

Vector in_world(const Body &body, const Vector &p)
{
  return eigen(body.position) +
         turn_of(body.orientation) * (eigen(body.shape_position) + turn_of(body.shape_orientation) * p);
}

/* Is p in the hull of two spheres? The nearest point of any sphere of the family between them, looked for by ternary
 * search. */
bool in_capsule(const Vec3 &size, const Vector &p)
{
  const auto depth = [&](double t) {
    const double radius = size[0] + (double(size[2]) - size[0]) * t, y = size[1] * (2 * t - 1);
    return radius - (p - Vector(0, y, 0)).norm(); /* concave in t */
  };
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (depth(a) < depth(b) ? low : high) = depth(a) < depth(b) ? a : b;
  }
  return depth((low + high) / 2) >= 0;
}

bool in_shape(const Shape &shape, const Vector &p)
{
  const double a = shape.size[0], b = shape.size[1], c = shape.size[2];
  switch (shape.type) {
  case ShapeType::sphere: return p.norm() <= a;
  case ShapeType::box: return std::abs(p.x()) <= a && std::abs(p.y()) <= b && std::abs(p.z()) <= c;
  case ShapeType::capsule: return in_capsule(shape.size, p);
  case ShapeType::cylinder:
    return std::abs(p.y()) <= b && std::hypot(p.x(), p.z()) <= a + (c - a) * (p.y() / b + 1) / 2;
  case ShapeType::hull:
    return std::all_of(shape.hull->planes.begin(), shape.hull->planes.end(),
                       [&](const HullPlane &plane) { return eigen(plane.normal).dot(p) <= plane.distance; });
  default: return false;
  }
}

struct Sum {
  double volume = 0;
  Vector center = Vector::Zero();
  Matrix inertia = Matrix::Zero(); /* about the centre, world axes, density 1 */
};

AxisAlignedBox bounds_of(const Shape &shape)
{
  if (shape.type == ShapeType::hull) return tandem::bounds_of(shape.hull->vertices);
  const auto &[a, b, c] = shape.size;
  const float radius = std::max(a, c), below = shape.type == ShapeType::capsule ? b + a : b,
              above = shape.type == ShapeType::capsule ? b + c : b;
  if (shape.type == ShapeType::box || shape.type == ShapeType::sphere) return {{-a, -b, -c}, {a, b, c}};
  return {{-radius, -below, -radius}, {radius, above, radius}};
}

/* Equal blocks of the shape's bounds whose middles lie inside. The bounds fit, so that flat ends lie between blocks. */
Sum summed(const Body &body, const Shape &shape, int cells)
{
  const AxisAlignedBox bounds = bounds_of(shape);
  const Vector low = eigen(bounds.lower), side = (eigen(bounds.upper) - low) / cells;
  const double volume = side.prod();
  Sum sum;
  Matrix second = Matrix::Zero();
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k) {
        const Vector p = low + side.cwiseProduct(Vector(i + 0.5, j + 0.5, k + 0.5));
        if (!in_shape(shape, p)) continue;
        const Vector at = in_world(body, p);
        sum.volume += volume;
        sum.center += volume * at;
        second += volume * at * at.transpose();
      }
  sum.center /= sum.volume;
  const Matrix covariance = second - sum.volume * sum.center * sum.center.transpose();
  sum.inertia = covariance.trace() * Matrix::Identity() - covariance;
  return sum;
}

std::vector<Vec3> cloud(Random &random, int count)
{
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i)
    points.push_back({float(random.uniform(-0.4, 1)), float(random.uniform(-0.9, 0.5)), float(random.uniform(0, 0.6))});
  return points;
}

std::vector<Shape> shapes()
{
  Random random(7);
  return {sphere_shape(0.7f),
          box_shape(0.3f, 0.9f, 0.5f),
          capsule_shape(0.4f, 0.5f),
          {ShapeType::capsule, {0.6f, 0.5f, 0.25f}},
          {ShapeType::capsule, {0.2f, 0.4f, 0.7f}},
          cylinder_shape(0.7f, 0.4f),
          {ShapeType::cylinder, {0.3f, 0.6f, 0.8f}},
          cone_shape(0.8f, 0.7f),
          {ShapeType::cylinder, {0, 0.5f, 0.4f}},
          hull_shape(cloud(random, 9), "cloud"),
          hull_shape(cloud(random, 40), "cloud")};
}

Scene with_shape(const Shape &shape)
{
  Scene scene;
  scene.shapes = {shape};
  scene.bodies.resize(1);
  return scene;
}

void place_anyhow(Random &random, Body &body)
{
  for (double &x : body.position) x = random.uniform(-3, 3);
  body.orientation = random.orientation();
  for (float &x : body.shape_position) x = float(random.uniform(-1, 1));
  body.shape_orientation = random.orientation();
}

bool same_bits(const Body &a, const Body &b)
{
  return std::memcmp(&a.position, &b.position, sizeof a.position) == 0 &&
         std::memcmp(&a.orientation, &b.orientation, sizeof a.orientation) == 0 &&
         std::memcmp(&a.shape_position, &b.shape_position, sizeof a.shape_position) == 0 &&
         std::memcmp(&a.shape_orientation, &b.shape_orientation, sizeof a.shape_orientation) == 0;
}

} // namespace

TEST_CASE("shape mass: the body's frame is the centre and the principal axes of its shape")
{
  Random random(11);
  const float mass = 2.5f;
  for (const Shape &shape : shapes()) {
    INFO("shape type " << int(shape.type) << ", size " << shape.size[0] << " " << shape.size[1] << " "
                       << shape.size[2]);
    Scene scene = with_shape(shape);
    Body &body = scene.bodies[0];
    body.mass = mass;
    place_anyhow(random, body);
    take_mass_properties(scene, body);
    const Sum sum = summed(body, shape, 90);
    const Vec3 moments = inertia_of(shape, mass);
    const Matrix axes = turn_of(body.orientation).toRotationMatrix(), expected = eigen(moments).asDiagonal(),
                 actual = axes.transpose() * sum.inertia * axes * (mass / sum.volume);
    CHECK(mass_properties_of(shape).mass == Approx(sum.volume).epsilon(0.004));
    CHECK((eigen(body.position) - sum.center).norm() < 0.002);
    CHECK((actual - expected).cwiseAbs().maxCoeff() < 0.006 * expected.maxCoeff());
    CHECK_NOTHROW(validate(scene, "taken"));
  }
}

TEST_CASE("shape mass: the shape stays where it is in the world")
{
  Random random(12);
  for (const Shape &shape : shapes()) {
    Scene scene = with_shape(shape);
    Body before = scene.bodies[0];
    place_anyhow(random, before);
    before.position[0] += 1e6; /* positions are exact far out too */
    Body after = before;
    take_mass_properties(scene, after);
    for (const Vector &p : {Vector(0, 0, 0), Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1)})
      CHECK((in_world(after, p) - in_world(before, p)).norm() < 4e-7);
    Body again = after;
    take_mass_properties(scene, again);
    CHECK((eigen(again.position) - eigen(after.position)).norm() < 4e-7);
    CHECK(std::abs(turn_of(again.orientation).dot(turn_of(after.orientation))) > 1 - 1e-12);
  }
}

TEST_CASE("shape mass: a centred shape along its principal axes is left alone to the bit")
{
  Random random(13);
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.push_back({k & 1 ? 0.3f : -0.3f, k & 2 ? 0.7f : -0.7f, k & 4 ? 0.1f : -0.1f});
  for (const Shape &shape : {sphere_shape(0.3f), box_shape(0.1f, 0.7f, 0.3f), capsule_shape(0.3f, 0.7f),
                             cylinder_shape(0.1f, 0.9f), hull_shape(corners, "box"), half_space_shape()}) {
    const Scene scene = with_shape(shape);
    Body body;
    for (double &x : body.position) x = random.uniform(-3, 3);
    body.orientation = random.orientation();
    const Body before = body;
    take_mass_properties(scene, body);
    CHECK(same_bits(body, before));
  }
}

TEST_CASE("shape mass: spheres and boxes have the moments they always had")
{
  Random random(14);
  for (int i = 0; i < 1000; ++i) {
    const float mass = float(random.uniform(0.01, 100));
    const float a = float(random.uniform(0.01, 9)), b = float(random.uniform(0.01, 9)),
                c = float(random.uniform(0.01, 9));
    const double m = mass, x = a, y = b, z = c;
    const float sphere = float(0.4 * m * x * x);
    CHECK(inertia_of(sphere_shape(a), mass) == Vec3{sphere, sphere, sphere});
    CHECK(inertia_of(box_shape(a, b, c), mass) ==
          Vec3{float(m / 3 * (y * y + z * z)), float(m / 3 * (x * x + z * z)), float(m / 3 * (x * x + y * y))});
  }
  CHECK(inertia_of(half_space_shape(), 1) == Vec3{0, 0, 0});
}

TEST_CASE("shape mass: moments in closed form, of a cylinder, a cone and a capsule")
{
  const double m = 3, r = 0.5, h = 1.25; /* m, radius, half the height */
  const Vec3 cylinder = inertia_of(cylinder_shape(0.5f, 1.25f), 3), cone = inertia_of(cone_shape(0.5f, 1.25f), 3);
  CHECK(cylinder[0] == Approx(m * (3 * r * r + 4 * h * h) / 12));
  CHECK(cylinder[1] == Approx(m * r * r / 2));
  CHECK(cylinder[2] == cylinder[0]);
  CHECK(cone[0] == Approx(m * (3.0 / 20 * r * r + 3.0 / 80 * 4 * h * h)));
  CHECK(cone[1] == Approx(0.3 * m * r * r));
  Scene scene = with_shape(cone_shape(0.5f, 1.25f));
  take_mass_properties(scene, scene.bodies[0]);
  CHECK(scene.bodies[0].position == Point{0, -h / 2, 0}); /* a quarter up from the base */
  CHECK(scene.bodies[0].shape_position == Vec3{0, float(h / 2), 0});
  const double ends = 4.0 / 3 * r, middle = 2 * h, whole = ends + middle; /* volumes over pi r² */
  const double across =
      m * (middle / whole * (r * r / 4 + h * h / 3) + ends / whole * (0.4 * r * r + h * h + 0.75 * r * h));
  CHECK(inertia_of(capsule_shape(0.5f, 1.25f), 3)[0] == Approx(across));
}

TEST_CASE("shape mass: another frame for a body moves nothing in the world")
{
  Random random(15);
  for (int i = 0; i < 200; ++i) {
    Body before;
    place_anyhow(random, before);
    Body after = before;
    const Quat q = random.orientation();
    const Double3 position{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5)};
    move_frame(after, position, {q[0], q[1], q[2], q[3]});
    CHECK((eigen(after.position) - eigen(position)).norm() < 2e-6);
    CHECK(turn_of(after.orientation).angularDistance(turn_of(q)) < 1e-6);
    CHECK((in_world(after, {1, 2, 3}) - in_world(before, {1, 2, 3})).norm() < 4e-6);
    CHECK((in_world(after, {0, 0, 0}) - in_world(before, {0, 0, 0})).norm() < 1e-14 * 20);
  }
}

TEST_CASE("shape mass: a hull is the hull of its own vertices")
{
  Random random(16);
  for (int count : {4, 8, 20, 100, 400}) {
    const Shape shape = hull_shape(cloud(random, count), "cloud"), again = hull_shape(shape.hull->vertices, "again");
    CHECK(shape.hull->vertices == again.hull->vertices);
    CHECK(shape.hull->faces == again.hull->faces);
    CHECK(shape.hull->edges == again.hull->edges);
  }
  std::vector<Vec3> round; /* many points that the tolerance of faces merges */
  for (int i = 0; i < 500; ++i) {
    const double y = random.uniform(-1, 1), angle = random.uniform(0, 6.2831853), across = std::sqrt(1 - y * y);
    round.push_back({float(across * std::cos(angle)), float(y), float(2e-6 * across * std::sin(angle))});
  }
  const Shape disc = hull_shape(round, "disc"), again = hull_shape(disc.hull->vertices, "again");
  CHECK(disc.hull->vertices == again.hull->vertices);
  CHECK(disc.hull->faces == again.hull->faces);
}
