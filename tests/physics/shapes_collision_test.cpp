/* Collisions of all shapes: conserved quantities, losses, and piles of every shape that must be carried. */
#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

TEST_CASE("a ball bounces off the end and the side of a capsule and the face of a hull at e times its speed",
          "[physics]")
{
  const float e = GENERATE(0.0f, 0.3f, 0.8f, 1.0f);
  const bool fixed = GENERATE(true, false);
  const Quat across = turn_about({0, 0, 1}, pi / 2);
  struct Target {
    const char *name;
    Shape shape;
    Quat turn;
    double top;
  };
  const Target targets[] = {{"capsule end", capsule_shape(0.3f, 0.5f), {0, 0, 0, 1}, 0.8},
                            {"capsule side", capsule_shape(0.3f, 0.5f), across, 0.3},
                            {"hull", hull_of_box(0.5f, 0.4f, 0.5f), {0, 0, 0, 1}, 0.4},
                            {"cylinder cap", cylinder_shape(0.4f, 0.3f), {0, 0, 0, 1}, 0.3},
                            {"cone from below", cone_shape(0.4f, 0.3f), turn_about({1, 0, 0}, pi), 0.3}};
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].restitution = e;
  for (const Target &target : targets) {
    const double x = 3.0 * double(scene.bodies.size());
    add_dynamic_body(scene, target.shape, {x, 0, 0}, target.turn, 2).type = fixed ? BodyType::fixed : BodyType::dynamic;
    add_dynamic_body(scene, sphere_shape(0.25f), {x, target.top + 0.25 + 0.731, 0}).linear_velocity = {0, -3, 0};
  }
  World world(scene);
  run(world, 60);
  const std::vector<BodyState> states = world.bodies();
  for (size_t k = 0; k < std::size(targets); ++k) {
    const BodyState &target = states[2 * k], &ball = states[2 * k + 1];
    const double parting = double(ball.linear_velocity[1]) - double(target.linear_velocity[1]);
    CAPTURE(targets[k].name, e, fixed, parting, vector_of(target.angular_velocity).norm());
    CHECK(parting == Approx(3 * double(e)).epsilon(0.002).margin(1e-4));
    if (!fixed)
      CHECK(ball.linear_velocity[1] ==
            Approx(-3 + 2 * (1 + double(e))).epsilon(0.002).margin(1e-4)); /* 2 of 3 kg are the target's */
    CHECK(vector_of(target.angular_velocity).norm() < 1e-3);
  }
}

namespace {

/* Every shape, of several sizes and densities, thrown at each other off centre and spinning, without gravity. */
Scene collision(uint64_t seed, float friction, float restitution)
{
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = friction;
  scene.materials[0].restitution = restitution;
  Random random(seed);
  const auto uniform3 = [&](double size) {
    return Vector(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  for (int i = 0; i < 12; ++i) {
    const Vector place(1.5 * (i % 3 - 1), 1.5 * (i / 3 % 2) - 0.75, 1.5 * (i / 6) - 0.75);
    const float size = float(random.uniform(0.2, 0.4));
    const Shape shapes[] = {sphere_shape(size),
                            box_shape(size, 0.7f * size, 1.2f * size),
                            capsule_shape(0.5f * size, 0.7f * size),
                            cylinder_shape(0.8f * size, size),
                            cone_shape(size, 0.8f * size),
                            Shape{ShapeType::capsule, {0.8f * size, 0.5f * size, 0.4f * size}},
                            Shape{ShapeType::cylinder, {0.6f * size, size, 0.9f * size}},
                            random_hull_shape(random, 20, 1.3 * size)};
    Body &body = add_dynamic_body(scene, shapes[i % 8], place, random.orientation(), float(random.uniform(0.5, 4)));
    body.linear_velocity = vec3_of(-1.5 * place + uniform3(1));
    body.angular_velocity = vec3_of(uniform3(3));
  }
  return scene;
}

} // namespace

TEST_CASE("collisions of every shape conserve linear and angular momentum", "[physics]")
{
  const float friction = GENERATE(0.0f, 0.6f), restitution = GENERATE(0.0f, 0.5f, 1.0f);
  const Narrowphase narrowphase = GENERATE(from_range(choices<Narrowphase>()));
  for (uint64_t seed : {1, 2, 3}) {
    Settings settings;
    settings.narrowphase = narrowphase;
    World world(collision(seed, friction, restitution), settings);
    const Momentum start = momentum_of(world);
    const double energy_at_start = world.statistics().kinetic_energy;
    double linear = 0, angular = 0, growth = 0, energy = energy_at_start;
    uint32_t contacts = 0;
    for (int step = 0; step < 120; ++step) {
      world.step();
      const Momentum now = momentum_of(world);
      const Statistics statistics = world.statistics();
      linear = std::max(linear, (now.linear - start.linear).norm() / start.linear_scale);
      angular = std::max(angular, (now.angular - start.angular).norm() / start.angular_scale);
      growth = std::max(growth, (statistics.kinetic_energy - energy) / energy_at_start);
      energy = statistics.kinetic_energy;
      contacts += statistics.contacts;
    }
    const double lost = 1 - energy / energy_at_start;
    CAPTURE(narrowphase, friction, restitution, seed, linear, angular, growth, lost, contacts);
    CHECK(contacts > 20);
    CHECK(linear < 1e-5);
    CHECK(angular < 1e-5);
    CHECK(growth < (restitution == 0 ? 1e-4 : 0.02)); /* as in momentum_test.cpp */
    CHECK(lost > (restitution == 0 ? 0.2 : -0.02));
  }
}

/* A body that starts inside the ground is lifted out of it, by no more than its depth. */
TEST_CASE("a hull that is dropped comes to rest and never gains energy", "[physics]")
{
  const int points = GENERATE(6, 12, 32);
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    Scene scene = empty_scene();
    add_ground(scene);
    add_dynamic_body(scene, random_hull_shape(random, points, 0.4), {0, 1.2, 0}, random.orientation());
    World world(scene);
    double energy = mechanical_energy(world), beyond = -INFINITY;
    for (int step = 0; step < 480; ++step) {
      world.step();
      const double now = mechanical_energy(world), lift = gravity * world.statistics().max_penetration;
      beyond = std::max(beyond, now - energy - lift);
      energy = now;
    }
    const BodyState state = world.bodies()[1];
    CAPTURE(points, seed, beyond, vector_of(state.linear_velocity).norm(), vector_of(state.angular_velocity).norm());
    CHECK(beyond < 1e-4); /* J, of 12: rounding, and the integration of its tumbling */
    CHECK(vector_of(state.linear_velocity).norm() < 0.001);
    CHECK(vector_of(state.angular_velocity).norm() < 0.005);
  }
}

namespace {

struct Pile {
  double deepest = 0, lowest = 1e9, farthest = 0;
};

/* Steps until it should lie, then the worst of a second. */
Pile settled(World &world, int steps)
{
  run(world, steps);
  Pile pile;
  for (int i = 0; i < 12; ++i) {
    run(world, 5);
    pile.deepest = std::max(pile.deepest, world.statistics().max_penetration);
  }
  const std::vector<BodyState> states = world.bodies();
  REQUIRE(all_finite(states));
  for (size_t i = 0; i < states.size(); ++i) {
    if (world.scene().bodies[i].type != BodyType::dynamic) continue;
    pile.lowest = std::min(pile.lowest, states[i].position[1]);
    pile.farthest = std::max(pile.farthest, std::hypot(states[i].position[0], states[i].position[2]));
  }
  return pile;
}

} // namespace

TEST_CASE("a hundred hulls settle with less than a centimetre of penetration", "[physics]")
{
  World world(load_scene("convex-hulls:n=100"));
  const Pile pile = settled(world, 300);
  CAPTURE(pile.deepest, pile.lowest, pile.farthest);
  CHECK(pile.deepest < 0.01);
  CHECK(pile.lowest > 0.1);
  CHECK(pile.farthest < 6);
}

/* The sampled directions may miss the least depth: a normal that is not that of the surfaces reports more than there
 * is. */
TEST_CASE("every narrowphase carries a pile of every shape", "[physics]")
{
  const Narrowphase narrowphase = GENERATE(from_range(choices<Narrowphase>()));
  Settings settings;
  settings.narrowphase = narrowphase;
  World world(load_scene("shapes:n=100"), settings);
  const Pile pile = settled(world, 420); /* one shape wedged among others sinks for a while */
  CAPTURE(narrowphase, pile.deepest, pile.lowest, pile.farthest);
  CHECK(pile.deepest < (narrowphase == Narrowphase::gjk_sampled ? 0.015 : 0.01));
  CHECK(pile.lowest > 0.05);
  CHECK(pile.farthest < 7);
}
