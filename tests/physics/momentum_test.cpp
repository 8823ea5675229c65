/* Closed systems: whatever collides, linear and angular momentum stay, and kinetic energy never grows. */
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
    Body &body = add_body(scene, Motion::dynamic, shape, vec3_of(place));
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

struct Sums {
  Vector linear = Vector::Zero(), angular = Vector::Zero();
  double energy = 0, linear_scale = 0, angular_scale = 0;
};

Worst run_collision(const Scene &scene, const Settings &settings, const Placement &placement)
{
  World world(scene, settings, placement);
  const Momentum start = momentum_of(world);
  const double energy_at_start = world.statistics().kinetic_energy;
  double energy = energy_at_start;
  Worst worst;
  for (int step = 0; step < 120; ++step) {
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

TEST_CASE("collisions conserve linear and angular momentum and never add energy", "[physics]")
{
  const float friction = GENERATE(0.0f, 0.6f), restitution = GENERATE(0.0f, 0.5f, 1.0f);
  const uint64_t seed = GENERATE(1, 2, 3);
  const Worst worst = run_collision(collision(seed, friction, restitution), {}, {});
  WARN("friction " << friction << ", restitution " << restitution << ", seed " << seed << ": momentum " << worst.linear << ", angular "
                   << worst.angular << ", energy grown " << worst.energy_growth << ", lost " << worst.energy_lost << ", contacts "
                   << worst.contacts);
  CHECK(worst.contacts > 20);
  CHECK(worst.linear < 1e-5);
  CHECK(worst.angular < 1e-5);
  /* Impacts of several bodies in one step are not simultaneous in the solver: a body that another contact has slowed
   * still parts at e times the speed it came with, so a pile-up of bouncing bodies can gain a little. */
  CHECK(worst.energy_growth < (restitution == 0 ? 1e-4 : 0.02));
  CHECK(worst.energy_lost > (restitution == 0 ? 0.3 : -0.02));
}

/* Impacts of two bodies, many pairs in one world, each far from the others. */
TEST_CASE("an impact of two bodies conserves momentum and adds no energy", "[physics][sanitizer]")
{
  const float friction = GENERATE(0.0f, 0.6f), restitution = GENERATE(0.0f, 0.5f, 1.0f);
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = friction;
  scene.materials[0].restitution = restitution;
  Random random(11);
  const auto uniform3 = [&](double size) { return Vector(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)); };
  constexpr int pairs = 60;
  std::vector<Vector> origins;
  for (int i = 0; i < pairs; ++i) {
    origins.push_back(Vector(8.0 * (i % 8), 8.0 * (i / 8), 0));
    for (int side : {-1, 1}) {
      const bool ball = side < 0 ? i % 3 == 0 : i % 3 < 2;
      const Shape shape = ball ? sphere_shape(0.4f) : box_shape(0.5f, 0.3f, 0.4f);
      Body &body = add_body(scene, Motion::dynamic, shape, vec3_of(origins.back() + Vector(1.2 * side, 0, 0) + uniform3(0.2)));
      body.orientation = random.orientation();
      body.mass = float(random.uniform(0.5, 4));
      body.linear_velocity = vec3_of(Vector(-2.0 * side, 0, 0) + uniform3(0.3));
      body.angular_velocity = vec3_of(uniform3(2));
    }
  }
  World world(scene);
  const std::vector<BodyState> start = world.bodies();
  const auto sums = [&](const std::vector<BodyState> &states, int pair) {
    Sums total;
    for (int i = 2 * pair; i < 2 * pair + 2; ++i) {
      const Body &body = scene.bodies[size_t(i)];
      const Vector linear = double(body.mass) * vector_of(states[size_t(i)].linear_velocity);
      const Vector spin = spin_momentum(scene, body, states[size_t(i)]);
      total.linear += linear;
      total.angular += (vector_of(states[size_t(i)].position) - origins[size_t(pair)]).cross(linear) + spin;
      total.energy += 0.5 * linear.dot(vector_of(states[size_t(i)].linear_velocity)) + 0.5 * spin.dot(vector_of(states[size_t(i)].angular_velocity));
      total.linear_scale += linear.norm();
      total.angular_scale += linear.norm() + spin.norm(); /* arms of about a metre */
    }
    return total;
  };
  run(world, 60);
  const std::vector<BodyState> now = world.bodies();
  double linear = 0, angular = 0, growth = 0;
  int met = 0;
  for (int pair = 0; pair < pairs; ++pair) {
    const Sums before = sums(start, pair), after = sums(now, pair);
    linear = std::max(linear, (after.linear - before.linear).norm() / before.linear_scale);
    angular = std::max(angular, (after.angular - before.angular).norm() / before.angular_scale);
    growth = std::max(growth, after.energy / before.energy - 1);
    met += (vector_of(now[size_t(2 * pair)].linear_velocity) - vector_of(start[size_t(2 * pair)].linear_velocity)).norm() > 0.1;
  }
  WARN("pairs, friction " << friction << ", restitution " << restitution << ": momentum " << linear << ", angular " << angular << ", energy grown "
                          << growth << ", impacts " << met);
  CHECK(met > pairs * 3 / 4);
  CHECK(linear < 1e-5);
  CHECK(angular < 1e-5);
  CHECK(growth < 1e-3);
}
