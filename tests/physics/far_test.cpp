/* Far from the origin a scene moves as at the origin, because a position is two floats and stages work on
 * differences. */
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* A column, a sliding box that falls from a height and a turning ball on a block; `origin` is no multiple of anything.
 */
Scene yard(const Point &origin, double height)
{
  Scene scene = empty_scene();
  const auto at = [&](double x, double y, double z) { return Point{origin[0] + x, origin[1] + y, origin[2] + z}; };
  add_body(scene, BodyType::fixed, box_shape(32, 1, 8), at(0, -1, 0));
  for (int i = 0; i < 4; ++i)
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), at(0.1 * i, 0.5 + i, 0.03 * i));
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.25f, 0.4f), at(-8.3, height, 3.1)).linear_velocity =
      {5, 0, 0.3f};
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), at(-8.7, 0.913, -3.3)).angular_velocity = {0, 2, -7};
  return scene;
}

double farthest_apart(World &far, World &near, const Point &origin)
{
  const std::vector<BodyState> a = far.bodies(), b = near.bodies();
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i)
    worst = std::max(worst, (vector_of(a[i].position) - vector_of(b[i].position) - vector_of(origin)).norm());
  return worst;
}

} // namespace

/* They start apart by what two 24-bit numbers lose, 4 nm at most; then speeds of 3 m/s are rounded otherwise, 0.2 um/s
 * at a time. Where the box lands just as a substep ends, that decides in which it is braked. */
TEST_CASE("far from the origin everything moves as at the origin", "[physics]")
{
  for (const double distance : {1234.5678, 20000.123, 1000000.777}) {
    const Point origin{distance, -0.31 * distance, 0.7 * distance};
    std::vector<double> apart;
    for (int k = 0; k <= 20; ++k) {
      const double height = 0.26 + 0.001 * k;
      World near(yard({0, 0, 0}, height)), far(yard(origin, height));
      run(near, 120);
      run(far, 120);
      apart.push_back(farthest_apart(far, near, origin));
    }
    std::sort(apart.begin(), apart.end());
    INFO(distance << " m away");
    CHECK(apart[10] < 5e-6);
    CHECK(apart[17] < 1e-5);
    CHECK(apart[20] < 5e-5);
  }
}

TEST_CASE("a slow body far away gets on: 1 mm/s at 1,000 km", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {1e6, 0, 0}).linear_velocity = {0.001f, 0, 0};
  World world(scene);
  run(world, 600);
  CHECK(world.bodies()[0].position[0] - 1e6 == Approx(0.01).epsilon(1e-5));
}
