/* Soft limits of joints in avbd: what falls on one gets no energy from it, whatever its stiffness, it goes as deep as
 * theory says, and free bodies with soft limits keep their momentum. What a soft limit is in every solver is a test of
 * solvers_joints_test.cpp. */
#include <cmath>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const Placement on_one_thread{"serial", {}, false};
const double drop = 0.1; /* m, of all that falls here */

JointAxis soft_range(double lower, double upper, double stiffness, double damping)
{
  JointAxis axis;
  axis.lower = float(lower);
  axis.upper = float(upper);
  axis.limit_stiffness = float(stiffness);
  axis.limit_damping = float(damping);
  return axis;
}

/* A ball of 1 kg on a vertical slider, 0.1 m above its lower limit and below its upper one. */
Scene ball_on_slider(double stiffness, double damping)
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0, 0, 0});
  connect(scene, JointType::slider, no_body, 0, Vector::Zero(), Vector::UnitY()).directions[0] =
      soft_range(-drop, drop, stiffness, damping);
  return scene;
}

/* Balls of 1 kg one below the other on elastic ropes of 1 m, each 0.1 m shorter than its rope. */
Scene balls_on_ropes(uint32_t balls, double stiffness, double damping)
{
  Scene scene = empty_scene();
  for (uint32_t k = 0; k < balls; ++k) {
    add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0, -(1 - drop) * (k + 1.0), 0}).filter_mask = 0;
    Joint rope;
    rope.type = JointType::distance;
    rope.body_a = k == 0 ? no_body : k - 1;
    rope.body_b = k;
    rope.directions[0] = soft_range(0, 1, stiffness, damping);
    scene.joints.push_back(rope);
  }
  return scene;
}

/* Balls of 1 kg in a level line on taut ropes of 0.5 m, of no stiffness hard ones; the last one is heavier. */
Scene level_ropes(uint32_t balls, double last_mass, double stiffness)
{
  Scene scene = empty_scene();
  for (uint32_t k = 0; k < balls; ++k) {
    Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {0.5 * (k + 1), 0, 0});
    ball.filter_mask = 0;
    if (k + 1 == balls) ball.mass = float(last_mass);
    Joint rope;
    rope.type = JointType::distance;
    rope.body_a = k == 0 ? no_body : k - 1;
    rope.body_b = k;
    rope.directions[0] = soft_range(0, 0.5, stiffness, 0);
    scene.joints.push_back(rope);
  }
  return scene;
}

/* A rod that begins level on a hinge at its end, with a soft stop 0.1 rad below. */
Scene rod_on_hinge(double mass, double length, double stiffness, double damping)
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(float(length / 2), 0.05f, 0.05f), {length / 2, 0, 0}).mass = float(mass);
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ()).rotations[0] =
      soft_range(-0.1, 0.1, stiffness, damping);
  return scene;
}

/* A small hub with long rods, hinged along them, that turns about the axis between them. */
Scene spinning_star(uint32_t rods, double stiffness)
{
  const Vector spin(0, 3, 0);
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {0, 0, 0}).angular_velocity = vec3_of(spin);
  for (uint32_t k = 0; k < rods; ++k) {
    const double angle = 2 * pi * k / rods;
    const Vector out = Vector(0.3 * std::cos(angle), 1, 0.3 * std::sin(angle)).normalized(), center = 1.1 * out;
    Body &rod = add_body(scene, BodyType::dynamic, box_shape(1, 0.05f, 0.05f), point_of(center));
    rod.mass = 0.5f;
    rod.orientation = quat_of(turn_of_x_to(out));
    rod.linear_velocity = vec3_of(spin.cross(center));
    rod.angular_velocity = vec3_of(spin);
    Joint &hinge = connect(scene, JointType::hinge, 0, k + 1, 0.1 * out, out);
    if (stiffness > 0) hinge.rotations[0] = soft_range(-0.1, 0.1, stiffness, 0);
  }
  for (Body &body : scene.bodies) body.filter_mask = 0;
  return scene;
}

/* Kinetic energy, and that of heights half a step ago: a fall by Euler's method keeps this sum, J. */
double energy_of(World &world)
{
  double energy = world.statistics().kinetic_energy;
  const auto states = world.precise_bodies();
  for (size_t k = 0; k < states.size(); ++k)
    energy += double(world.scene().bodies[k].mass) * gravity *
              (states[k].position[1] - 0.5 * substep_of(world.settings()) * double(states[k].linear_velocity[1]));
  return energy;
}

/* The most energy beyond that at the start, J. */
double most_gained(const Scene &scene)
{
  World world(scene, settings_for(Solver::avbd), on_one_thread);
  const double start = energy_of(world);
  double most = 0;
  for (int k = 0; k < 1200; ++k) {
    world.step();
    const double gained = energy_of(world) - start;
    if (!(gained <= most)) most = gained; /* also of what is no number */
  }
  return most;
}

double deepest_on_slider(double stiffness, const Settings &settings)
{
  World world(ball_on_slider(stiffness, 0), settings, on_one_thread);
  double deepest = 0;
  for (int k = 0; k < int(0.6 / double(settings.step)); ++k) {
    world.step();
    deepest = std::max(deepest, -world.precise_bodies()[0].position[1] - drop);
  }
  return deepest;
}

/* The largest changes of momentum in 300 steps, as shares of what there is, and of kinetic energy. */
struct Changes {
  double linear = 0, angular = 0, energy = 0;
};
Changes changes_of(const Scene &scene)
{
  World world(scene, settings_for(Solver::avbd), on_one_thread);
  const Momentum start = momentum_of(world);
  const double energy = world.statistics().kinetic_energy;
  Changes most;
  for (int k = 0; k < 300; ++k) {
    world.step();
    const Momentum now = momentum_of(world);
    most.linear = std::max(most.linear, (now.linear - start.linear).norm() / start.linear_scale);
    most.angular = std::max(most.angular, (now.angular - start.angular).norm() / start.angular_scale);
    most.energy = std::max(most.energy, world.statistics().kinetic_energy / energy - 1);
  }
  return most;
}

} // namespace

TEST_CASE("soft limits of avbd: a ball that falls on one gets no energy, on a slider and on a rope", "[physics]")
{
  const double stiffness = GENERATE(1e2, 1e3, 1e4, 1e5, 2e5, 1e6, 1e7, 1e9), damping = GENERATE(0.0, 10.0, 1000.0);
  CAPTURE(stiffness, damping);
  const double work = gravity * drop;
  CHECK(most_gained(ball_on_slider(stiffness, damping)) < 0.02 * work);
  CHECK(most_gained(balls_on_ropes(1, stiffness, damping)) < 0.02 * work);
}

TEST_CASE("soft limits of avbd: balls on a chain of elastic ropes get no energy", "[physics]")
{
  const double stiffness = GENERATE(1e3, 1e4, 1e5, 1e6, 1e7, 1e9), damping = GENERATE(0.0, 10.0);
  CAPTURE(stiffness, damping);
  CHECK(most_gained(balls_on_ropes(2, stiffness, damping)) < 0.05 * gravity * (drop + 2 * drop));
}

/* The ropes throw the light balls to and fro across the pull of the heavy one. */
TEST_CASE("soft limits of avbd: a line of ropes that swings down gets no energy, also with a heavy end", "[physics]")
{
  const uint32_t balls = GENERATE(2u, 3u, 5u);
  const double stiffness = GENERATE(0.0, 1e4, 1e6, 1e7, 1e9), last_mass = GENERATE(1.0, 10.0, 100.0);
  CAPTURE(balls, stiffness, last_mass);
  CHECK(most_gained(level_ropes(balls, last_mass, stiffness)) < 0.02 * gravity * last_mass * 0.5 * balls);
}

TEST_CASE("soft limits of avbd: a rod that falls on a soft stop of its hinge gets no energy", "[physics]")
{
  const double stiffness = GENERATE(1e2, 1e3, 1e4, 1e5, 1e6, 1e9), damping = GENERATE(0.0, 1.0);
  CAPTURE(stiffness, damping);
  CHECK(most_gained(rod_on_hinge(0.1, 0.3, stiffness, damping)) < 0.05 * 0.1 * gravity * 0.3);
  CHECK(most_gained(rod_on_hinge(1, 1, stiffness, damping)) < 0.05 * gravity);
}

/* m g (drop + x) = k x^2 / 2 at the deepest. Euler's implicit method takes the share w h / 2 of a swing in each radian,
 * and the stop begins within a step. */
TEST_CASE("soft limits of avbd: a ball goes as deep as theory says, with an error of first order in the step",
          "[physics]")
{
  const double stiffness = GENERATE(100.0, 1e4);
  std::vector<double> errors;
  for (const double share : {0.02, 0.01, 0.005}) {
    Settings settings = settings_for(Solver::avbd);
    settings.step = float(share / std::sqrt(stiffness));
    const double rest = gravity / stiffness, exact = rest + std::sqrt(rest * rest + 2 * rest * drop);
    errors.push_back(std::abs(deepest_on_slider(stiffness, settings) / exact - 1));
    CHECK(errors.back() < 0.5 * pi * share);
  }
  CHECK(falls_with_first_order(errors));
}

/* Hinges along the rods begin in the middle of their range; nothing but the turn of the star moves them. */
TEST_CASE("soft limits of avbd: free bodies keep their momentum as well as without limits", "[physics]")
{
  const uint32_t rods = GENERATE(1u, 2u, 3u, 6u);
  const double stiffness = GENERATE(0.0, 1e3, 1e4, 1e5, 1e6);
  CAPTURE(rods, stiffness);
  const Changes most = changes_of(spinning_star(rods, stiffness));
  CHECK(most.linear < 0.005);
  CHECK(most.angular < 0.005);
  CHECK(most.energy < 0.02);
}
