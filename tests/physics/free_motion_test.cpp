/* Bodies without contacts: parabolas, damping, and the free spin of a rigid body, against closed forms. */
#include "tests/catch.h"
#include "tests/physics/physics.h"
#include "tools/stability/flip.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* The relative spacing of floats. */
constexpr double epsilon = 0x1p-23;

} // namespace

TEST_CASE("free fall and projectiles follow the parabola to float rounding", "[physics][address]")
{
  const double step = GENERATE(1.0 / 30, 1.0 / 60, 1.0 / 100);
  const uint32_t substeps = GENERATE(1, 4, 7);
  const std::string backend = GENERATE("serial", "tbb");
  Scene scene = empty_scene({0.5f, -10, 0.25f});
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 30, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.2f, 0.3f), {20, 5, 0}).linear_velocity = {3, 12, -4};
  scene.bodies[1].angular_velocity = {1, 2, 3};
  const Settings settings = settings_with(step, substeps);
  World world(scene, settings, Placement{backend, {}, false});
  const int steps = int(2 / step);
  run(world, steps);
  const double t = steps * double(settings.step);
  const Vector pull = vector_of(scene.gravity);
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const Vector speed = vector_of(scene.bodies[i].linear_velocity);
    const Vector position = vector_of(scene.bodies[i].position) + t * speed + 0.5 * t * t * pull;
    const BodyState state = world.bodies()[i];
    const double position_error = (vector_of(state.position) - position).norm();
    const double velocity_error = (vector_of(state.linear_velocity) - (speed + t * pull)).norm();
    /* Each substep rounds a velocity of up to 20 m/s to half an ulp and the substep itself is rounded; the
     * position gathers that over 2 s and rounds 30 m once a step. Euler's method would be off by 5 t h: ten times
     * more. */
    const double velocity_bound = 20 * epsilon * steps * substeps,
                 position_bound = t * velocity_bound + 30 * epsilon * steps;
    CAPTURE(step, substeps, i, position_error, position_bound, velocity_error, velocity_bound);
    CHECK(velocity_error < velocity_bound);
    CHECK(position_error < position_bound);
    CHECK(position_error < 0.1 * 5 * t * step / substeps);
  }
}

TEST_CASE("gravity_factor scales the fall", "[physics]")
{
  Scene scene = empty_scene();
  for (float factor : {0.0f, 0.5f, 2.0f, -1.0f})
    add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {3.0f * float(scene.bodies.size()), 0, 0}).gravity_factor =
        factor;
  World world(scene);
  run(world, 60);
  for (size_t i = 0; i < scene.bodies.size(); ++i)
    CHECK(world.bodies()[i].position[1] == Approx(-5.0 * scene.bodies[i].gravity_factor).margin(1e-4));
}

TEST_CASE("damping is the implicit decay of each substep, close to the exponential", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  for (float damping : {0.1f, 1.0f, 5.0f}) {
    Body &body = add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {3.0f * float(scene.bodies.size()), 0, 0});
    body.linear_damping = damping;
    body.angular_damping = 0.5f * damping;
    body.linear_velocity = {0, 4, 0};
    body.angular_velocity = {0, 0, 4};
  }
  World world(scene);
  run(world, 60);
  const int substeps = 60 * int(world.settings().substeps);
  const double h = 1.0 / substeps;
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyState state = world.bodies()[i];
    const double c = scene.bodies[i].linear_damping;
    CHECK(state.linear_velocity[1] == Approx(4 * std::pow(1 + h * c, -substeps)).epsilon(2e-5));
    CHECK(state.angular_velocity[2] == Approx(4 * std::pow(1 + 0.5 * h * c, -substeps)).epsilon(2e-5));
    CHECK(state.linear_velocity[1] == Approx(4 * std::exp(-c)).epsilon(0.6 * h * c * c + 2e-5));
    /* Positions are sums of the velocities after damping: v0 h sum of d^k. */
    CHECK(state.position[1] == Approx((4 - state.linear_velocity[1]) / c).epsilon(1e-3));
  }
}

TEST_CASE("free spin keeps its angular momentum and its energy", "[physics]")
{
  const double speed = GENERATE(2.0, 10.0, 30.0);
  Scene scene = empty_scene({0, 0, 0});
  Random random(7);
  for (int i = 0; i < 12; ++i) {
    const float a = float(random.uniform(0.1, 1)), b = float(random.uniform(0.1, 1)), c = float(random.uniform(0.1, 1));
    Body &body = add_body(scene, BodyType::dynamic, box_shape(a, b, c), {5.0f * float(i), 0, 0});
    body.orientation = random.orientation();
    const Vector axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    body.angular_velocity = vec3_of(speed * axis.normalized());
  }
  World world(scene);
  const std::vector<BodyState> start = world.bodies();
  double worst_momentum = 0, worst_energy = 0;
  for (int second = 0; second < 10; ++second) {
    run(world, 60);
    const std::vector<BodyState> now = world.bodies();
    for (size_t i = 0; i < now.size(); ++i) {
      const Body &body = scene.bodies[i];
      const Vector before = spin_momentum(scene, body, start[i]), after = spin_momentum(scene, body, now[i]);
      const double energy_before = before.dot(vector_of(start[i].angular_velocity)),
                   energy_after = after.dot(vector_of(now[i].angular_velocity));
      worst_momentum = std::max(worst_momentum, (after - before).norm() / before.norm());
      worst_energy = std::max(worst_energy, std::abs(energy_after / energy_before - 1));
    }
  }
  INFO("free spin at " << speed << " rad/s, 10 s: drift of angular momentum " << worst_momentum << ", of energy "
                       << worst_energy);
  CHECK(worst_momentum < 1e-4);
  /* The explicit midpoint rule keeps L by construction, up to rounding, and energy to second order in angle per
   * substep. */
  CHECK(worst_energy < (speed > 20 ? 3e-2 : speed > 5 ? 1e-3 : 1e-4));
}

TEST_CASE("a body spinning about its middle axis flips on time", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  const double tilt = GENERATE(0.02, 0.1, 0.3);
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.1f), {0, 0, 0}).angular_velocity = {float(4 * tilt), 4, 0};
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.1f), {5, 0, 0}).angular_velocity = {0, 4, float(4 * tilt)};
  World world(scene);
  std::vector<FlipClock> clocks(2);
  for (int step = 1; step <= 30 * 60; ++step) {
    world.step();
    const std::vector<BodyState> states = world.bodies();
    for (size_t i = 0; i < 2; ++i)
      clocks[i].note(step / 60.0,
                     (axes_of(states[i].orientation).transpose() * vector_of(states[i].angular_velocity)).y());
  }
  for (size_t i = 0; i < 2; ++i) {
    const double expected =
        flip_interval(moments_of(scene, scene.bodies[i]), vector_of(scene.bodies[i].angular_velocity));
    INFO("flip of body " << i << " tilted by " << tilt << ": " << clocks[i].interval() << " s, theory " << expected
                         << " s, " << clocks[i].flips() << " flips");
    REQUIRE(clocks[i].flips() >= 3);
    CHECK(clocks[i].interval() == Approx(expected).epsilon(0.01));
  }
}
