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

/* Rods, cubes and plates, some continuous, that fly through each other among slabs, a third of which turn and a third
 * of which are heavy. */
Scene fast_cluster(uint64_t seed)
{
  Random random(seed);
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].restitution = 0.4f;
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0.5f;
  const auto somewhere = [&random] {
    Vector at(random.uniform(-6, 6), 0, 0);
    at.y() = random.uniform(0, 5);
    at.z() = random.uniform(-6, 6);
    return at;
  };
  for (int i = 0; i < 24; ++i) {
    const BodyType motion = i % 3 == 0 ? BodyType::fixed : i % 3 == 1 ? BodyType::dynamic : BodyType::kinematic;
    Body &slab = add_dynamic_body(scene, box_shape(3, 0.1f, 3), somewhere(), {0, 0, 0, 1}, 5);
    slab.type = motion;
    if (motion == BodyType::kinematic) slab.angular_velocity = vec3_of(9 * direction(random));
  }
  const Shape shapes[] = {box_shape(0.5f, 0.02f, 0.02f), box_shape(0.2f, 0.2f, 0.2f), box_shape(0.1f, 0.3f, 0.2f)};
  for (int i = 0; i < 220; ++i) {
    const Vector at = somewhere();
    const Quat turn = any_turn(random);
    Body &body = add_dynamic_body(scene, shapes[i % 3], at, turn, float(logarithmic(random, 0.1, 3)));
    body.linear_velocity = vec3_of(logarithmic(random, 10, 120) * direction(random));
    body.angular_velocity = vec3_of(logarithmic(random, 1, 60) * direction(random));
    body.continuous = i % 5 < 2;
  }
  return scene;
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
/* Long bodies that turn by radians within a step slide on arms and masses that are no longer theirs; friction for those
 * drives them to any speed: 56 of the first 60 crowds beyond 272 m/s, 28 beyond 1640. The slabs' rims move at 38
 * m/s, and what bounces between two of them gains twice that, once a step at most; few do so more than twice. */
TEST_CASE("bodies that fly through each other gain no speed by friction", "[physics]")
{
  const Solver solver = GENERATE(Solver::soft_step, Solver::pgs);
  CAPTURE(solver);
  constexpr int steps = 20;
  constexpr double at_first = 120, of_bounce = 2 * 38;
  uint32_t fast_crowds = 0;
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    World world(fast_cluster(seed), settings_for(solver));
    double most = 0;
    for (int i = 0; i < steps; ++i) {
      world.step();
      most = std::max(most, double(fastest(world)));
    }
    REQUIRE(most < at_first + (solver == Solver::pgs ? 2 : steps) * of_bounce);
    if (most > at_first + 2 * of_bounce) ++fast_crowds;
  }
  CHECK(fast_crowds <= 5);
}

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
