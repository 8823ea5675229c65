/* Boxes against half-spaces: the eight corners of the box against the plane, in double precision. */
#include "tests/catch.h"
#include "tests/shared/narrowphase/box_reference.h"

using namespace tandem;
using namespace tandem::narrowphase_tests;

namespace {

struct Corner {
  Vector offset; /* from the centre of the box */
  double separation;
};

std::vector<Corner> corners_over(const TestBody &brick, const TestBody &ground)
{
  std::vector<Corner> corners;
  for (int bits = 0; bits < 8; ++bits) {
    const Vector signs(bits & 1 ? 1 : -1, bits & 2 ? 1 : -1, bits & 4 ? 1 : -1);
    const Vector offset = brick.axes() * signs.cwiseProduct(brick.extent());
    corners.push_back({offset, ground.axes().col(1).dot(brick.center() + offset - ground.center())});
  }
  return corners;
}

/* Every point is a corner, midway to the plane; the lowest corner is there; all four of the face where all are near. */
bool matches(const Contact &contact, const TestBody &a, const TestBody &b, double reach, double tolerance)
{
  const TestBody &brick = a.shape == box ? a : b, &ground = a.shape == box ? b : a;
  const std::vector<Corner> corners = corners_over(brick, ground);
  const Vector up = ground.axes().col(1);
  double lowest = INFINITY;
  for (const Corner &corner : corners) lowest = std::min(lowest, corner.separation);
  if (lowest > reach + tolerance) return contact.points.empty();
  if (lowest > reach - tolerance) return true;
  if (contact.points.empty()) return false;
  if ((contact.normal - (a.shape == box ? -up : up)).norm() > 1e-5) return false;
  double found = INFINITY;
  for (const Point &point : contact.points) {
    const Vector in_world = a.center() + point.offset;
    const bool is_corner = std::any_of(corners.begin(), corners.end(), [&](const Corner &corner) {
      return std::abs(corner.separation - point.separation) < tolerance &&
             (brick.center() + corner.offset - up * corner.separation / 2 - in_world).norm() < tolerance;
    });
    if (!is_corner) return false;
    found = std::min(found, point.separation);
  }
  return std::abs(found - lowest) < tolerance;
}

} // namespace

TEST_CASE("box against half-space: corners of the face turned to the plane")
{
  Random random(4);
  PairScene scene;
  while (scene.size() < 20000) {
    TestBody brick, ground;
    ground.shape = half_space;
    ground.orientation = random.orientation().cast<float>();
    ground.position = random.in_cube(1).cast<float>();
    const bool extreme = random.below(4) == 0;
    for (int k = 0; k < 3; ++k) brick.size[k] = float(random.logarithmic(extreme ? 1e-3 : 0.1, extreme ? 1e3 : 2));
    const Vector up = ground.axes().col(1);
    Eigen::Quaterniond orientation = random.orientation();
    if (random.below(2)) /* flat, or tilted a little */
      orientation = Eigen::AngleAxisd(random.below(2) ? random.uniform(-1e-3, 1e-3) : 0, random.direction()) *
                    Eigen::AngleAxisd(random.uniform(0, 6), up) * ground.orientation.cast<double>();
    brick.orientation = orientation.normalized().cast<float>();
    brick.linear = random.in_cube(2).cast<float>();
    const double radius = (brick.axes().transpose() * up).cwiseAbs().dot(brick.extent());
    const double height = radius + random.uniform(-0.2, 0.1) * brick.extent().minCoeff();
    brick.position = (ground.center() + up * height + ground.axes().col(2) * random.uniform(-3, 3)).cast<float>();
    if (random.below(2)) scene.add(brick, ground);
    else scene.add(ground, brick);
  }
  const Outputs outputs = scene.run({Kernel::collide_box_half_space});
  size_t touching = 0, apart = 0, full = 0, wrong = 0;
  for (size_t pair = 0; pair < scene.size(); ++pair) {
    const Contact contact = scene.contact(outputs, pair);
    const TestBody &a = scene.a(pair), &b = scene.b(pair);
    const Vector normal = a.shape == box ? Vector(-b.axes().col(1)) : Vector(a.axes().col(1));
    const double closing = -(b.linear - a.linear).cast<double>().dot(normal);
    const double reach = 0.02f + std::max(0.0, closing) / 60;
    const double size = (b.center() - a.center()).norm() + std::max(a.size.norm(), b.size.norm());
    (contact.points.empty() ? apart : touching) += 1;
    full += contact.points.size() == 4;
    if (!matches(contact, a, b, reach, 2e-6 * size) && wrong++ < 3) FAIL_CHECK("pair " << pair);
  }
  CHECK(wrong == 0);
  CHECK(touching > scene.size() / 2);
  CHECK(apart > scene.size() / 100);
  CHECK(full > scene.size() / 8);
}

TEST_CASE("a box flat on the ground has its four corners, one a slot, far from the origin too")
{
  for (float far : {0.0f, 4096.0f}) {
    TestBody brick, ground;
    ground.shape = half_space;
    ground.position = {far, 0, far};
    brick.size = {0.5f, 0.25f, 1.0f};
    brick.position = {far + 3, 0.25f - 0.001f, far};
    PairScene scene;
    scene.add(brick, ground);
    const Contact contact = scene.contact(scene.run({Kernel::collide_box_half_space}), 0);
    REQUIRE(contact.points.size() == 4);
    CHECK(contact.normal == Vector(0, -1, 0));
    std::vector<Vector> offsets;
    for (size_t k = 0; k < 4; ++k) {
      CHECK(contact.points[k].slot == k);
      CHECK(contact.points[k].separation == Approx(-0.001).epsilon(1e-3));
      offsets.push_back(contact.points[k].offset);
    }
    CHECK(hull_area(offsets, Vector::UnitY()) == Approx(2.0));
  }
}
