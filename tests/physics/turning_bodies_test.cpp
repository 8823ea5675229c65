/* Long bodies that turn by radians within a step gain no energy: in contacts with each other, and where their motion is
 * cut at a wall. */
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

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

/* Above a wall, and fast enough to be stopped at it. */
Scene thrown_rod(Random &random, float friction)
{
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0] = rubbing(friction, 0);
  add_body(scene, BodyType::fixed, box_shape(20, 0.1f, 20), {0, 0, 0});
  const Quat turn = any_turn(random);
  Body &rod = add_dynamic_body(scene, box_shape(0.5f, 0.02f, 0.02f), {0, random.uniform(0.7, 1.5), 0}, turn, 1);
  rod.linear_velocity = {0, -float(logarithmic(random, 20, 300)), 0};
  rod.angular_velocity = vec3_of(logarithmic(random, 10, 2000) * direction(random));
  rod.continuous = true;
  return scene;
}

struct Gain {
  Solver solver;
  float friction;
  double share; /* of the energy, that a step may add */
};

} // namespace

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
    World world(thrown_rod(random, gain.friction), settings_for(gain.solver));
    REQUIRE(largest_gain(world, 4) < gain.share);
  }
}

/* A rod that is held about an axis cannot turn its spin with it. */
TEST_CASE("spinning rods held about an axis gain no energy where they are stopped at a wall", "[physics]")
{
  const Axes held = GENERATE(Axes{true, false, false}, Axes{false, true, false}, Axes{false, false, true});
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    Scene scene = thrown_rod(random, 0);
    Body &rod = scene.bodies[1];
    rod.linear_velocity[0] = float(random.uniform(-30, 30));
    rod.angular_locks = held;
    if (held.x) rod.angular_velocity[0] = 0;
    if (held.y) rod.angular_velocity[1] = 0;
    if (held.z) rod.angular_velocity[2] = 0;
    World world(scene);
    REQUIRE(largest_gain(world, 4) < 0.001);
  }
}
