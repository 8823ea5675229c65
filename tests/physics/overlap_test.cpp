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

/* Rods, cubes and plates, some continuous, that fly through each other among slabs: a third of them fixed, a third
 * heavy, and a third fixed or turning. */
Scene fast_cluster(uint64_t seed, const Material &material, BodyType third = BodyType::fixed)
{
  Random random(seed);
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0] = material;
  const auto somewhere = [&random] {
    Vector at(random.uniform(-6, 6), 0, 0);
    at.y() = random.uniform(0, 5);
    at.z() = random.uniform(-6, 6);
    return at;
  };
  for (int i = 0; i < 24; ++i) {
    Body &slab = add_dynamic_body(scene, box_shape(3, 0.1f, 3), somewhere(), {0, 0, 0, 1}, 5);
    if (i % 3 == 0) slab.type = BodyType::fixed;
    if (i % 3 == 2) slab.type = third;
    if (slab.type == BodyType::kinematic) slab.angular_velocity = vec3_of(9 * direction(random));
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

/* The most that one step adds to the kinetic energy, as a share of it. */
double largest_gain(World &world, int steps)
{
  double most = 0, before = world.statistics().kinetic_energy;
  for (int i = 0; i < steps; ++i) {
    world.step();
    const double now = world.statistics().kinetic_energy;
    most = std::max(most, now / before - 1);
    before = now;
  }
  return most;
}

Material rubbing(float friction, float restitution)
{
  Material material;
  material.static_friction = material.dynamic_friction = friction;
  material.restitution = restitution;
  return material;
}

/* Nothing drives these bodies, and contacts only take energy. Long bodies turn by radians within a step, so that masses
 * of its start are wrong in its end by up to a thousand. */
TEST_CASE("bodies that fly through each other gain no energy", "[physics]")
{
  const Solver solver = GENERATE(Solver::soft_step, Solver::pgs, Solver::nncg, Solver::jacobi, Solver::xpbd);
  const float friction = GENERATE(0.0f, 0.5f), restitution = GENERATE(0.0f, 0.4f);
  CAPTURE(solver, friction, restitution);
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    World world(fast_cluster(seed, rubbing(friction, restitution)), settings_for(solver));
    REQUIRE(largest_gain(world, 20) < 0.01);
  }
}

/* The slabs' rims move at 38 m/s, and what bounces between two of them gains twice that. A body squeezed between one
 * and a fixed one may leave faster than either moves. */
TEST_CASE("bodies that fly through each other among turning slabs stay as fast as these make them", "[physics]")
{
  const Solver solver = GENERATE(Solver::soft_step, Solver::pgs, Solver::nncg, Solver::jacobi, Solver::xpbd);
  CAPTURE(solver);
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    World world(fast_cluster(seed, rubbing(0.5f, 0.4f), BodyType::kinematic), settings_for(solver));
    for (int i = 0; i < 20; ++i) {
      world.step();
      REQUIRE(fastest(world) < 120 + 4 * 38);
    }
  }
}

struct Gain {
  Solver solver;
  float friction;
  double share; /* of the energy, that a step may add */
};

/* The motion is cut at the wall, and with it the turn, by radians. Solvers that take one substep, or start each without
 * impulses, find the rods elsewhere when they remove what pushed them; so does friction whose normal force is gone. */
TEST_CASE("spinning rods that are stopped at a wall gain no energy", "[physics]")
{
  const Gain gain =
      GENERATE(Gain{Solver::soft_step, 0, 0.01}, Gain{Solver::jacobi, 0, 0.01}, Gain{Solver::avbd, 0, 0.01},
               Gain{Solver::direct, 0, 0.01}, Gain{Solver::pgs, 0, 0.1}, Gain{Solver::nncg, 0, 0.1},
               Gain{Solver::xpbd, 0, 0.15}, Gain{Solver::soft_step, 0.6f, 0.5}, Gain{Solver::direct, 0.6f, 0.01},
               Gain{Solver::avbd, 0.6f, 0.6}, Gain{Solver::xpbd, 0.6f, 0.2}, Gain{Solver::jacobi, 0.6f, 2},
               Gain{Solver::nncg, 0.6f, 2.5}, Gain{Solver::pgs, 0.6f, 4});
  CAPTURE(gain.solver, gain.friction);
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    Scene scene = empty_scene({0, 0, 0});
    scene.materials[0] = rubbing(gain.friction, 0);
    add_body(scene, BodyType::fixed, box_shape(20, 0.1f, 20), {0, 0, 0});
    const Quat turn = any_turn(random);
    Body &rod = add_dynamic_body(scene, box_shape(0.5f, 0.02f, 0.02f), {0, random.uniform(0.7, 1.5), 0}, turn, 1);
    rod.linear_velocity = {0, -float(logarithmic(random, 20, 300)), 0};
    rod.angular_velocity = vec3_of(logarithmic(random, 10, 2000) * direction(random));
    rod.continuous = true;
    World world(scene, settings_for(gain.solver));
    REQUIRE(largest_gain(world, 4) < gain.share);
  }
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
