/* Boxes and spheres around shapes at any pose in their bodies: they contain the whole shape and are no larger than
 * needed. */
#include "host/scene/shape_bounds.h"
#include "tests/catch.h"
#include "tests/host/scene/shape_points.h"

using namespace tandem;
using namespace tandem::shape_points;

namespace {

/* Rims are sampled every tenth of a degree, which takes 4e-7 of the radius. */
constexpr double tight = 1e-5;

Vector lowest(const std::vector<Vector> &points)
{
  Vector low = points.front();
  for (const Vector &p : points) low = low.cwiseMin(p);
  return low;
}
Vector highest(const std::vector<Vector> &points)
{
  Vector high = points.front();
  for (const Vector &p : points) high = high.cwiseMax(p);
  return high;
}

} // namespace

TEST_CASE("the box around a shape holds its surface and is no larger")
{
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    Scene scene;
    const Body body = add_any(scene, random, {0, 0, 0});
    const std::vector<Vector> points = points_of(scene, body, random);
    const ShapeBox box = box_around(scene, body);
    const Vector center = physics_tests::vector_of(box.center), half = physics_tests::vector_of(box.half_extents);
    const Vector below = lowest(points) - (center - half), above = center + half - highest(points);
    CAPTURE(i, int(scene.shapes[0].type), below.transpose(), above.transpose());
    REQUIRE(below.minCoeff() > -1e-12); /* of rotations in double; the box is rounded outward */
    REQUIRE(above.minCoeff() > -1e-12);
    /* One half extent serves both sides: what the rounding of the centre takes from one is left on the other. */
    REQUIRE(below.maxCoeff() < tight);
    REQUIRE(above.maxCoeff() < tight);
  }
}

TEST_CASE("the bounding radius reaches to the farthest point of a shape, and no farther")
{
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    Scene scene;
    const Body body = add_any(scene, random, {0, 0, 0});
    double farthest = 0;
    for (const Vector &p : points_of(scene, body, random)) farthest = std::max(farthest, p.norm());
    const double radius = bounding_radius(scene, body);
    CAPTURE(i, int(scene.shapes[0].type), radius, farthest);
    REQUIRE(farthest < radius * (1 + 2.4e-7)); /* of a box about its own centre hypot of floats may lack two ulps */
    REQUIRE(farthest > radius - tight);
  }
}

TEST_CASE("a half-space has no bounding radius")
{
  Scene scene;
  CHECK(bounding_radius(scene, physics_tests::add_ground(scene)) == 0);
}

TEST_CASE("what kernels read as the size of a hull is a box about its origin")
{
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Shape shape = physics_tests::random_hull_shape(random, 20, 1);
    Vector most = Vector::Zero();
    for (const Vec3 &v : shape.hull->vertices) most = most.cwiseMax(physics_tests::vector_of(v).cwiseAbs());
    REQUIRE(physics_tests::vector_of(kernel_size(shape)) == most);
  }
  CHECK(kernel_size(cone_shape(2, 3)) == Vec3{2, 3, 0});
}
