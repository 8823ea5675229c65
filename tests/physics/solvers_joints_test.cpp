/* Joints in every solver that solves them: closed forms of what they hold, limit, drive and brake, with the settings
 * that the solver has by default. Those of soft-step have tests of their own (joints_test.cpp, joint_axes_test.cpp). */
#include <memory>

#include <tandem/metrics.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Each solver, with its defaults. */
Settings each_solver()
{
  const Solver solver = GENERATE(values(
      {Solver::soft_step, Solver::pgs, Solver::nncg, Solver::xpbd, Solver::avbd, Solver::jacobi, Solver::direct}));
  UNSCOPED_INFO("solver " << name_of(solver));
  return settings_for(solver);
}

/* The share of a gap that a substep closes, and the gap under a load of 1 m/s^2 that does not change, m: joints of xpbd
 * close all of it, those of avbd a twentieth (shared/solve/avbd_penalties.h) and have multipliers that bear loads, and
 * those of direct give way by a ten-thousandth (host/pipeline/solvers/island_joints.cpp). */
double share_closed(const Settings &settings)
{
  if (settings.solver == Solver::avbd) return 0.05;
  return settings.solver == Solver::xpbd ? 1 : Softness(settings).rate * substep_of(settings);
}
double gap_under_load(const Settings &settings)
{
  const double h = substep_of(settings);
  if (settings.solver == Solver::xpbd || settings.solver == Solver::avbd) return 0; /* closed before bodies move */
  if (settings.solver == Solver::direct) return 1e-4 * h * h / share_closed(settings);
  return Softness(settings).stretch;
}

/* A cube of 1 kg at the origin that a joint to the world holds; its moment of inertia is 1/6 kg m^2. */
struct HeldCube {
  static constexpr double moment = 1.0 / 6;
  Scene scene;
  explicit HeldCube(JointType type, const Vec3 &gravity = {0, 0, 0}) : scene(empty_scene(gravity))
  {
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0, 0});
    connect(scene, type, no_body, 0, Vector::Zero());
  }
  JointAxis &direction() { return scene.joints[0].directions[0]; }
  JointAxis &rotation() { return scene.joints[0].rotations[0]; }
};

double way_of(World &world) { return world.precise_bodies()[0].position[0]; }
double speed_along_x(World &world) { return world.precise_bodies()[0].linear_velocity[0]; }
double spin_about_x(World &world) { return world.precise_bodies()[0].angular_velocity[0]; }

} // namespace

TEST_CASE("solvers with joints: a pendulum has the period of theory, and its joint opens no more than it may",
          "[physics]")
{
  const Settings settings = each_solver();
  const double angle = 0.6, h = substep_of(settings), length = 1, radius = 0.2;
  Scene scene = empty_scene();
  Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(float(radius)),
                        {length * std::sin(angle), -length * std::cos(angle), 0});
  ball.orientation = turn_about(Vector::UnitZ(), angle);
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  World world(scene, settings, on_serial);
  ZeroCrossings crossings;
  double open = 0;
  for (int k = 1; k <= 360; ++k) {
    world.step();
    const Point p = world.precise_bodies()[0].position;
    crossings.note(k * double(settings.step), std::atan2(p[0], -p[1]));
    open = std::max(open, open_joints(world).max_distance);
  }
  const double rate = std::sqrt(gravity * length / (length * length + 0.4 * radius * radius));
  const double fall = gravity * (1 - std::cos(angle)), tension = gravity + 2 * fall;
  /* A substep leaves the circle by (v h)^2 / 2, of which the joint closes a share; and the load opens it. */
  const double may_open = fall * h * h / share_closed(settings) + gap_under_load(settings) * tension + 1e-6;
  const double period = 2 * pi / rate * lengthening_of_period(angle);
  CHECK(open < may_open);
  /* Euler's method swings the energy by w h / 2, and the period changes by angle^2 / 16 of that; it is of second order
   * beside it. What is open lengthens the arm. */
  const double own = 0.5 * rate * h * angle * angle / 16 + std::pow(rate * h, 2) / 24;
  CHECK(std::abs(crossings.interval(0, 1) / period - 1) < own + 0.5 * may_open);
}

TEST_CASE("solvers with joints: a spring with a damper answers a step as theory says", "[physics]")
{
  const Settings settings = each_solver();
  const double stiffness = 40, damping = 4, decay = damping / 2, rate = std::sqrt(stiffness - decay * decay);
  HeldCube held(JointType::slider);
  held.direction() = {.target_position = 1, .stiffness = float(stiffness), .damping = float(damping)};
  World world(held.scene, settings, on_serial);
  double worst = 0;
  for (int k = 1; k <= 180; ++k) {
    world.step();
    const double t = k / 60.0;
    const double exact = 1 - std::exp(-decay * t) * (std::cos(rate * t) + decay / rate * std::sin(rate * t));
    worst = std::max(worst, std::abs(way_of(world) - exact));
  }
  CHECK(worst < 0.5 * stiffness * substep_of(settings) / decay); /* implicit Euler of first order */
}

TEST_CASE("solvers with joints: no spring is too stiff", "[physics]")
{
  const Settings settings = each_solver();
  const float stiffness = GENERATE(1e3f, 1e9f);
  HeldCube held(JointType::slider, {10, 0, 0});
  held.direction() = {.target_position = 0.5f, .stiffness = stiffness, .damping = 0.05f * stiffness};
  World world(held.scene, settings, on_serial);
  run(world, 300);
  CHECK(std::abs(way_of(world) - 0.5 - 10 / double(stiffness)) < 1e-4);
  CHECK(std::abs(speed_along_x(world)) < 1e-4);
}

TEST_CASE("solvers with joints: a motor speeds up with its largest torque and then holds its speed", "[physics]")
{
  const double torque = 0.5, target = 6, growth = torque / HeldCube::moment;
  HeldCube held(JointType::hinge);
  held.rotation() = {.target_velocity = float(target), .motor = true, .max_force = float(torque)};
  World world(held.scene, each_solver(), on_serial);
  double worst = 0;
  for (int k = 1; k <= 180; ++k) {
    world.step();
    worst = std::max(worst, std::abs(spin_about_x(world) - std::min(target, growth * k / 60)));
  }
  CHECK(worst < 1e-4 * target);
}

TEST_CASE("solvers with joints: friction brakes with its force and then holds", "[physics]")
{
  const Settings settings = each_solver();
  const double friction = 2, start = 3;
  HeldCube held(JointType::slider);
  held.scene.bodies[0].linear_velocity = {float(start), 0, 0};
  held.direction() = {.friction = float(friction)};
  World world(held.scene, settings, on_serial);
  run(world, 120);
  CHECK(std::abs(way_of(world) - start * start / (2 * friction)) < 0.51 * start * substep_of(settings));
  CHECK(std::abs(speed_along_x(world)) < 1e-6);
}

TEST_CASE("solvers with joints: limits stop a body from both sides, at any speed, and give back their restitution",
          "[physics]")
{
  const Settings settings = each_solver();
  const double speed = GENERATE(0.5, 20.0), sign = GENERATE(-1.0, 1.0), restitution = GENERATE(0.0, 0.5);
  HeldCube held(JointType::slider);
  held.scene.bodies[0].linear_velocity = {float(sign * speed), 0, 0};
  held.direction() = {.lower = -0.7f, .upper = 0.7f, .restitution = float(restitution)};
  World world(held.scene, settings, on_serial);
  double farthest = 0, back = 0;
  for (int k = 0; k < 120; ++k) {
    world.step();
    farthest = std::max(farthest, std::abs(way_of(world)));
    back = std::max(back, -sign * speed_along_x(world));
  }
  CHECK(farthest < 0.7 + 1e-3);
  const bool bounces = restitution > 0 && speed > double(settings.restitution_speed);
  CHECK(back == Approx(bounces ? restitution * speed : 0).margin(0.02));
}

TEST_CASE("solvers with joints: a soft limit gives way by its stiffness, from both sides", "[physics]")
{
  const Settings settings = each_solver();
  const double sign = GENERATE(-1.0, 1.0), stiffness = GENERATE(500.0, 1e6);
  HeldCube held(JointType::slider, {float(10 * sign), 0, 0});
  held.direction() = {
      .lower = -0.2f, .upper = 0.2f, .limit_stiffness = float(stiffness), .limit_damping = float(0.1 * stiffness)};
  World world(held.scene, settings, on_serial);
  run(world, 300);
  CHECK(way_of(world) == Approx(sign * (0.2 + 10 / stiffness)).margin(1e-4));
  CHECK(std::abs(speed_along_x(world)) < 1e-4);
}

TEST_CASE("solvers with joints: a slider is no faster than its largest speed", "[physics]")
{
  HeldCube held(JointType::slider, {10, 0, 0});
  held.direction() = {.max_speed = 2};
  World world(held.scene, each_solver(), on_serial);
  double fastest = 0;
  for (int k = 0; k < 60; ++k) {
    world.step();
    fastest = std::max(fastest, speed_along_x(world));
  }
  CHECK(fastest < 2.01);
  CHECK(speed_along_x(world) == Approx(2).epsilon(1e-3));
}

TEST_CASE("solvers with joints: the forces of a chain are the weights below", "[physics]")
{
  World world(hanging_boxes(5, 2), each_solver(), on_serial);
  run(world, 300);
  const std::vector<JointReading> readings = world.read_joints(world.joint_ids());
  for (int k = 0; k < 5; ++k) {
    CAPTURE(k);
    CHECK(readings[size_t(k)].force[1] == Approx(2 * gravity * (5 - k)).epsilon(5e-3));
    CHECK(std::abs(readings[size_t(k)].force[0]) < 1e-3);
  }
}

TEST_CASE("solvers with joints: a load just below the limit holds, and one just above it breaks the joint", "[physics]")
{
  const Settings settings = each_solver();
  for (const bool breaks : {false, true}) {
    CAPTURE(breaks);
    World world(hanging_boxes(3, 2), settings, on_serial);
    run(world, 300);
    Joint link = world.scene().joints[1];
    link.break_force = float((breaks ? 0.95 : 1.05) * 2 * 2 * gravity);
    world.set_joint(world.id_of_joint(1), link);
    size_t broken = 0;
    for (int k = 0; k < 30; ++k) {
      world.step();
      broken += world.joint_breaks().size();
    }
    CHECK(broken == (breaks ? 1 : 0));
    CHECK(world.scene().joints[1].enabled == !breaks);
  }
}

TEST_CASE("solvers with joints: what hangs on a joint that goes falls, and the rest of the chain holds its own weight",
          "[physics]")
{
  const Settings settings = each_solver();
  World world(hanging_boxes(4, 2), settings, on_serial);
  run(world, 240);
  const auto height = [&](uint32_t body) { return world.precise_bodies()[body].position[1]; };
  const double third = height(2), fourth = height(3);
  world.destroy_joint(world.id_of_joint(2));
  run(world, 60);
  /* the iterations of avbd do not take all of the last joint's force away in the first step */
  CHECK(height(2) - third == Approx(-0.5 * gravity).epsilon(settings.solver == Solver::avbd ? 0.05 : 0.03));
  CHECK(height(3) - height(2) == Approx(fourth - third).margin(2e-3)); /* which is open under a load before */
  run(world, 60);
  CHECK(world.read_joint(world.id_of_joint(0)).force[1] == Approx(2 * 2 * gravity).epsilon(5e-3));
}

/* Each body of avbd is moved by itself, so action equals reaction only as far as its iterations have converged. */
TEST_CASE("solvers with joints: free bodies with a joint of each type keep their momentum", "[physics]")
{
  const Settings settings = each_solver();
  const double tolerance = settings.solver == Solver::avbd ? 2e-3 : 1e-5;
  for (size_t number = 0; number < joint_type_names().size(); ++number) {
    const auto type = static_cast<JointType>(number);
    Random random(7);
    World world(tumbling_pair(random, type), settings, on_serial);
    const Momentum start = momentum_of(world);
    run(world, 200);
    const Momentum now = momentum_of(world);
    CAPTURE(name_of_type(type));
    CHECK((now.linear - start.linear).norm() / start.linear_scale < tolerance);
    CHECK((now.angular - start.angular).norm() / start.angular_scale < tolerance);
    /* they turn by less than 4 rad/s; the frames are no farther from the centres than these from each other */
    const auto states = world.precise_bodies();
    const double arm = (vector_of(states[1].position) - vector_of(states[0].position)).norm();
    CHECK(open_joints(world).max_distance <
          arm * (0.5 * std::pow(4 * substep_of(settings), 2) / share_closed(settings) + 16 * gap_under_load(settings)) +
              1e-6);
  }
}

TEST_CASE("solvers with joints: gears hold their ratio, and weights on a pulley fall as Atwood's do", "[physics]")
{
  const Settings settings = each_solver();
  if (!solves_couplings(settings.solver)) return;
  Scene scene = empty_scene();
  for (int k = 0; k < 2; ++k) {
    add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0, 2.0 * k, 0}).mass = float(1 + k);
    connect(scene, JointType::hinge, no_body, uint32_t(k), {0, 2.0 * k, 0});
  }
  scene.joints[0].rotations[0] = {.target_velocity = 12, .motor = true, .max_force = 20};
  Coupling coupling;
  coupling.joint_b = 1;
  coupling.teeth_a = 20;
  coupling.teeth_b = 30;
  scene.couplings = {coupling};
  World wheels(scene, settings, on_serial);
  run(wheels, 300);
  const auto spinning = wheels.precise_bodies();
  CHECK(spinning[0].angular_velocity[0] == Approx(12).epsilon(1e-3));
  CHECK(spinning[1].angular_velocity[0] == Approx(-8).epsilon(1e-3));

  Scene weights = empty_scene({0, -10, 0});
  for (int k = 0; k < 2; ++k) {
    add_body(weights, BodyType::dynamic, sphere_shape(0.1f), {0, -5, double(k)}).mass = float(3 - k);
    connect(weights, JointType::distance, no_body, uint32_t(k), {0, 0, double(k)});
    place_frame(weights, uint32_t(k), {0, -5, double(k)}, Eigen::Quaterniond::Identity(),
                weights.joints.back().position_b, weights.joints.back().orientation_b);
  }
  Coupling rope;
  rope.type = CouplingType::pulley;
  rope.joint_b = 1;
  rope.offset = 10;
  weights.couplings = {rope};
  World atwoods(weights, settings, on_serial);
  run(atwoods, 45);
  const auto falling = atwoods.precise_bodies();
  CHECK(falling[0].linear_velocity[1] == Approx(-2 * 0.75).epsilon(5e-3)); /* (3 - 2) / (3 + 2) of 10 m/s^2 */
  CHECK(falling[1].linear_velocity[1] == Approx(2 * 0.75).epsilon(5e-3));
}

TEST_CASE("solvers with joints: people fall over, and lie on the ground with their joints closed", "[physics]")
{
  const Settings settings = each_solver();
  World world(load_scene("ragdolls:n=2,height=0"), settings, {"tbb", {}, false});
  run(world, 400);
  CHECK(world.statistics().kinetic_energy < 0.05);
  CHECK(open_joints(world).max_distance < 0.02);
  for (const PreciseBodyState &state : world.precise_bodies()) REQUIRE(state.position[1] > -0.05);
}

TEST_CASE("solvers with joints: a chain falls asleep as one, wakes, and hangs as before", "[physics]")
{
  Settings settings = each_solver();
  settings.sleeping = true;
  World world(hanging_boxes(4, 2), settings, on_serial);
  run(world, 600);
  CHECK(world.statistics().asleep == 4);
  const double before = world.precise_bodies()[3].position[1];
  world.wake_body(world.id_of(3));
  run(world, 5);
  CHECK(std::abs(world.precise_bodies()[3].position[1] - before) < 1e-3);
}

/* A chain that holds still has no speed after its first step, in which no impulse is known; what is left is the error
 * of the passes. */
TEST_CASE("solvers with joints: conjugate gradients leave a chain less speed than as many passes of pgs", "[physics]")
{
  const auto speed_left = [](Solver solver, uint32_t iterations) {
    Settings settings = settings_for(solver);
    settings.iterations = iterations;
    settings.joint_hertz = 1e4f; /* as stiff as it gets, so that softness is a small part of it */
    World world(hanging_boxes(12, 2), settings, on_serial);
    world.step();
    return fastest(world);
  };
  CHECK(speed_left(Solver::nncg, 10) < speed_left(Solver::pgs, 10));
  /* of twelve joints there are twelve directions */
  CHECK(speed_left(Solver::nncg, 20) < 0.4 * speed_left(Solver::pgs, 20));
  CHECK(speed_left(Solver::nncg, 1) == speed_left(Solver::pgs, 1));
}

/* Where a body cannot move along a row at all, because of locks or of inertia without end, the row takes no part. */
TEST_CASE("solvers with joints: a joint of a body that cannot give way along some of its rows holds the others",
          "[physics]")
{
  const Settings settings = each_solver();
  const auto scene_of = [](JointType type, const auto &change) {
    Scene scene = empty_scene();
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {0.5, 0, 0});
    connect(scene, type, no_body, 0, Vector::Zero(), Vector::UnitZ());
    change(scene.bodies[0], scene.joints[0]);
    return scene;
  };
  const std::vector<Scene> scenes = {
      scene_of(JointType::fixed, [](Body &body, Joint &) { body.infinite_inertia = true; }),
      scene_of(JointType::hinge,
               [](Body &body, Joint &) {
                 body.angular_locks = {false, true, false};
               }),
      scene_of(JointType::hinge,
               [](Body &body, Joint &) {
                 body.angular_locks = {true, true, true};
               }),
      scene_of(JointType::ball,
               [](Body &body, Joint &) {
                 body.linear_locks = {false, false, true};
               }),
      scene_of(JointType::slider,
               [](Body &body, Joint &) {
                 body.angular_locks = {true, true, true};
               }),
      scene_of(JointType::slider,
               [](Body &body, Joint &joint) {
                 body.linear_locks = {false, false, true};
                 joint.directions[0] = {.lower = -0.1f, .upper = 0.1f};
               }),
  };
  for (size_t k = 0; k < scenes.size(); ++k) {
    CAPTURE(k);
    if (settings.solver == Solver::avbd && locks_of(scenes[k].bodies[0]) != 0) continue; /* has no locks */
    World world(scenes[k], settings, on_serial);
    run(world, 60);
    CHECK(world.statistics().nonfinite == 0);
    /* the heaviest load turns with up to 6 rad/s at half a metre */
    const double may_open = 0.5 * 0.5 * std::pow(6 * substep_of(settings), 2) / share_closed(settings) +
                            2 * gravity * gap_under_load(settings) + 1e-6;
    CHECK(open_joints(world).max_distance < may_open);
    /* its weight at half a metre turns it by 60 rad/s^2; xpbd solves rotations before the directions that turn it */
    const double turns = settings.solver == Solver::xpbd ? std::pow(substep_of(settings), 2) : gap_under_load(settings);
    CHECK(open_joints(world).max_angle < 2 * may_open + 60 * turns);
    if (settings.solver == Solver::direct) CHECK(world.statistics().direct_islands == 1);
  }
}

/* xpbd begins each substep without impulses, so its motors let go of loads heavier than what they turn. */
TEST_CASE("solvers with joints: a motor without a largest torque is a brake, whatever hangs on it", "[physics]")
{
  const Settings settings = each_solver();
  if (settings.solver == Solver::xpbd) return;
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f), {0.5, 0, 0});
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  scene.joints[0].rotations[0].motor = true;
  add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {1, 0, 0}).mass = 10;
  connect(scene, JointType::fixed, 0, 1, {1, 0, 0});
  World world(scene, settings, on_serial);
  const auto height = [&] { return world.precise_bodies()[1].position[1]; };
  run(world, 60);
  const double before = height();
  run(world, 600);
  CHECK(std::abs(height() - before) < 5e-4); /* it has sagged by the softness of the joints, and does not creep */
  if (settings.solver == Solver::direct) CHECK(std::abs(height() - before) < 1e-5);
}
