/* Closed systems: any collision keeps linear and angular momentum, and kinetic energy grows by at most a stated
 * amount. */
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Spheres and boxes of several sizes and densities, thrown at each other off centre and spinning, without gravity. */
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
    const Shape shape = i % 2 ? sphere_shape(size) : box_shape(size, 0.7f * size, 1.2f * size);
    Body &body = add_body(scene, BodyType::dynamic, shape, point_of(place));
    body.orientation = random.orientation();
    body.mass = float(random.uniform(0.5, 4));
    body.linear_velocity = vec3_of(-1.5 * place + uniform3(1));
    body.angular_velocity = vec3_of(uniform3(3));
  }
  return scene;
}

struct Worst {
  double linear = 0, angular = 0, energy_growth = 0, energy_lost = 0;
  uint32_t contacts = 0;
};

Worst run_collision(const Scene &scene, const Settings &settings, const Placement &placement, int steps)
{
  World world(scene, settings, placement);
  const Momentum start = momentum_of(world);
  const double energy_at_start = world.statistics().kinetic_energy;
  double energy = energy_at_start;
  Worst worst;
  for (int step = 0; step < steps; ++step) {
    world.step();
    const Momentum now = momentum_of(world);
    const Statistics statistics = world.statistics();
    worst.linear = std::max(worst.linear, (now.linear - start.linear).norm() / start.linear_scale);
    worst.angular = std::max(worst.angular, (now.angular - start.angular).norm() / start.angular_scale);
    worst.energy_growth = std::max(worst.energy_growth, (statistics.kinetic_energy - energy) / energy_at_start);
    worst.contacts += statistics.contacts;
    energy = statistics.kinetic_energy;
  }
  worst.energy_lost = 1 - energy / energy_at_start;
  return worst;
}

} // namespace

TEST_CASE("collisions of many bodies conserve linear and angular momentum", "[physics]")
{
  const float friction = GENERATE(0.0f, 0.6f), restitution = GENERATE(0.0f, 0.5f, 1.0f);
  const uint64_t seed = GENERATE(1, 2, 3);
  const Worst worst = run_collision(collision(seed, friction, restitution), {}, {}, 120);
  INFO("friction " << friction << ", restitution " << restitution << ", seed " << seed << ": momentum " << worst.linear
                   << ", angular " << worst.angular << ", energy grown " << worst.energy_growth << ", lost "
                   << worst.energy_lost << ", contacts " << worst.contacts);
  CHECK(worst.contacts > 20);
  CHECK(worst.linear < 1e-5);
  CHECK(worst.angular < 1e-5);
  /* Impacts of several bodies in one step are not simultaneous in the solver: a body that another contact has slowed
   * still parts at e times the speed it came with, so a pile-up of bouncing bodies can gain a little. */
  CHECK(worst.energy_growth < (restitution == 0 ? 1e-4 : 0.02));
  CHECK(worst.energy_lost > (restitution == 0 ? 0.3 : -0.02));
}

/* Two bodies thrown at each other, off centre and spinning, near the origin. */
Scene impact(Random &random, int kind, float friction, float restitution)
{
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = friction;
  scene.materials[0].restitution = restitution;
  const auto uniform3 = [&](double size) {
    return Vector(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  for (int side : {-1, 1}) {
    const bool ball = side < 0 ? kind % 3 == 0 : kind % 3 < 2;
    const Shape shape = ball ? sphere_shape(0.4f) : box_shape(0.5f, 0.3f, 0.4f);
    Body &body = add_body(scene, BodyType::dynamic, shape, point_of(Vector(1.2 * side, 0, 0) + uniform3(0.2)));
    body.orientation = random.orientation();
    body.mass = float(random.uniform(0.5, 4));
    body.linear_velocity = vec3_of(Vector(-2.0 * side, 0, 0) + uniform3(0.3));
    body.angular_velocity = vec3_of(uniform3(2));
  }
  return scene;
}

TEST_CASE("an impact of two bodies conserves momentum and adds hardly any energy", "[physics][address]")
{
  const float friction = GENERATE(0.0f, 0.6f), restitution = GENERATE(0.0f, 0.5f, 1.0f);
  Random random(11);
  Worst worst;
  for (int kind = 0; kind < 30; ++kind) {
    const Worst one =
        run_collision(impact(random, kind, friction, restitution), {}, Placement{"serial", {}, false}, 60);
    CHECK(one.contacts > 0);
    worst.linear = std::max(worst.linear, one.linear);
    worst.angular = std::max(worst.angular, one.angular);
    worst.energy_growth = std::max(worst.energy_growth, one.energy_growth);
  }
  INFO("pairs, friction " << friction << ", restitution " << restitution << ": momentum " << worst.linear
                          << ", angular " << worst.angular << ", energy grown " << worst.energy_growth);
  CHECK(worst.linear < 1e-5);
  CHECK(worst.angular < 1e-5);
  /* Pushing out of penetration and taking its speed out again is one step of an iteration each for a box on several
   * points, and a box that parts at the speed with which it came turns within the step of the impact. */
  CHECK(worst.energy_growth < (restitution == 1 ? 0.025 : 1e-3));
}
