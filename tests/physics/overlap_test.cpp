/* Invalid starts with coincident bodies: the bodies part, and neither fly away nor climb. */
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Scene dense_cluster(const Shape &shape, int n, const Vec3 &gravity = {0, -10, 0})
{
  Scene scene = empty_scene(gravity);
  if (gravity[1] != 0) add_ground(scene);
  for (int i = 0; i < n; ++i) add_body(scene, BodyType::dynamic, shape, {0, 0.5f, 0});
  return scene;
}

struct Energy {
  double kinetic = 0, gained = 0; /* J/kg */
};

/* Without spin: what a crowd has of it is small beside the rest. */
Energy energy_of(World &world, size_t first)
{
  Energy sum;
  const std::vector<BodyState> states = world.bodies();
  for (size_t i = first; i < states.size(); ++i) {
    sum.kinetic += vector_of(states[i].linear_velocity).squaredNorm() / 2;
    sum.gained += gravity * (states[i].position[1] - 0.5);
  }
  const double n = double(states.size() - first);
  return {sum.kinetic / n, (sum.gained + sum.kinetic) / n};
}

double deepest(World &world) { return world.statistics().max_penetration; }

} // namespace

TEST_CASE("64 bodies in one place part without flying up or away", "[physics]")
{
  const Shape shape = GENERATE(box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.5f));
  World world(dense_cluster(shape, 64));
  double most = 0;
  for (int i = 0; i < 600; ++i) {
    world.step();
    most = std::max(most, energy_of(world, 1).gained);
  }
  CHECK(most < 5); /* as much as to lift all by half their size */
  CHECK(deepest(world) < 0.02);
}

TEST_CASE("bodies in one place in empty space part, keep their momentum and hardly move on", "[physics]")
{
  const Shape shape = GENERATE(box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.5f));
  World world(dense_cluster(shape, 16, {0, 0, 0}));
  for (int i = 0; i < 600; ++i) {
    world.step();
    REQUIRE(momentum_of(world).linear.norm() < 1e-3);
  }
  CHECK(deepest(world) < 0.02);
  CHECK(energy_of(world, 0).kinetic < 1);
}

/* 0.3 m deep; deep is more than a tenth of half a metre, and slow a tenth of the push speed. */
TEST_CASE("a box deep in a fixed one comes out slowly, at one speed, and stays where it is out", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.7f, 0});
  add_body(scene, BodyType::fixed, box_shape(2, 0.5f, 2), {0, 0, 0});
  World world(scene);
  for (int i = 0; i < 300; ++i) {
    const double before = world.bodies()[0].position[1];
    world.step();
    const double out = world.bodies()[0].position[1] - before,
                 slow = 0.1 * world.settings().push_speed * world.settings().step;
    if (before < 0.94) REQUIRE(out == Approx(slow).epsilon(0.02));
    REQUIRE(vector_of(world.bodies()[0].linear_velocity).norm() < 0.3);
  }
  CHECK(world.bodies()[0].position[1] == Approx(1).margin(0.02));
}
