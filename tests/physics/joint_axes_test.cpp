/* What joints limit, drive and brake: closed forms of springs, motors and stops. Bodies have no gravity unless a test
 * gives it. */
#include <tandem/metrics.h>

#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr double edge = 0.5; /* m, half of that of the cube of 1 kg that all joints hold to the world */
constexpr double moment = 2.0 / 3.0 * edge * edge;

/* A cube at the origin on a joint to the world, whose frames are those of world and cube. */
struct Held {
  Scene scene;
  Joint joint;

  explicit Held(JointType type, const Vec3 &gravity = {0, 0, 0}) : scene(empty_scene(gravity))
  {
    add_body(scene, BodyType::dynamic, box_shape(float(edge), float(edge), float(edge)), {0, 0, 0});
    joint.type = type;
    joint.body_b = 0;
  }
  Body &body() { return scene.bodies[0]; }
  World world(double step = 1.0 / 60, uint32_t substeps = 4)
  {
    scene.joints = {joint};
    return World(scene, settings_with(step, substeps), {});
  }
};

double x_of(World &world) { return world.precise_bodies()[0].position[0]; }
double speed_of(World &world) { return world.precise_bodies()[0].linear_velocity[0]; }
double turn_speed_of(World &world) { return world.precise_bodies()[0].angular_velocity[0]; }

/* Of a body that turns about x alone, -pi .. pi. */
double angle_of(World &world)
{
  const auto q = world.precise_bodies()[0].orientation;
  return 2 * std::atan2(q[0], q[3]) - (q[3] < 0 ? 2 * pi * (q[0] < 0 ? -1 : 1) : 0);
}

/* The angle between the axes x of the body and of the world. */
double lean_of(World &world)
{
  const auto q = world.precise_bodies()[0].orientation;
  return 2 * std::atan2(std::hypot(q[1], q[2]), std::hypot(q[0], q[3]));
}

} // namespace

TEST_CASE("joint axes: a spring with a damper answers a step as theory says, at every step", "[physics]")
{
  const double step = GENERATE(1.0 / 60, 1.0 / 1000), stiffness = 40, damping = 4, target = 1;
  Held held(JointType::slider);
  held.joint.directions[0] = {
      .target_position = float(target), .stiffness = float(stiffness), .damping = float(damping)};
  World world = held.world(step);
  const double decay = damping / 2, rate = std::sqrt(stiffness - decay * decay), h = step / 4;
  double worst = 0;
  for (int k = 1; k * step <= 3; ++k) {
    world.step();
    const double t = k * step;
    const double exact =
        target - target * std::exp(-decay * t) * (std::cos(rate * t) + decay / rate * std::sin(rate * t));
    worst = std::max(worst, std::abs(x_of(world) - exact));
  }
  /* implicit Euler shifts the decay by about rate^2 h / 2, and the swing lasts for about 1 / decay */
  CHECK(worst < 0.5 * stiffness * h / decay * target);
  CHECK(worst > 1e-3 * stiffness * h / decay * target); /* it is of first order, no better */
}

TEST_CASE("joint axes: no spring is too stiff", "[physics]")
{
  const float stiffness = GENERATE(1e3f, 1e6f, 1e9f, 1e12f);
  Held held(JointType::hinge, {0, -10, 0});
  held.joint.position_b = {0, 1, 0}; /* the axis x is 1 m above the centre */
  held.joint.position_a = {0, 1, 0};
  held.joint.rotations[0] = {.target_position = 0.5f, .stiffness = stiffness, .damping = 0.05f * stiffness};
  World world = held.world();
  run(world, 600);
  /* the weight turns it back by its moment at that angle over the stiffness */
  CHECK(std::abs(angle_of(world) - 0.5) < 10 * std::sin(0.5) / double(stiffness) + 1e-3);
  CHECK(std::abs(turn_speed_of(world)) < 1e-3);
}

TEST_CASE("joint axes: a motor speeds up with its largest force and then holds its speed", "[physics]")
{
  const double largest = 0.5, target = 6;
  Held held(JointType::hinge);
  held.joint.rotations[0] = {.target_velocity = float(target), .motor = true, .max_force = float(largest)};
  World world = held.world();
  const double growth = largest / moment; /* rad/s^2 */
  for (int k = 1; k <= 180; ++k) {
    world.step();
    CHECK(std::abs(turn_speed_of(world) - std::min(target, growth * k / 60)) < 1e-4 * target);
  }
}

TEST_CASE("joint axes: a motor on a slider lifts a weight, or not, as its force says", "[physics]")
{
  const auto [force, lifts] = GENERATE(std::pair(9.5f, false), std::pair(10.5f, true));
  Held held(JointType::slider, {-10, 0, 0});
  held.joint.directions[0] = {.lower = 0, .target_velocity = 0.5f, .motor = true, .max_force = force};
  World world = held.world();
  run(world, 240);
  if (lifts) CHECK(std::abs(speed_of(world) - 0.5) < 1e-3);
  else CHECK(std::abs(x_of(world)) < 0.01);
}

TEST_CASE("joint axes: friction brakes with its force and then holds", "[physics]")
{
  const double friction = 2, start = 3;
  Held held(JointType::slider);
  held.body().linear_velocity = {float(start), 0, 0};
  held.joint.directions[0] = {.friction = float(friction)};
  World world = held.world();
  run(world, 120);
  /* it comes to rest after v^2 / (2 a); Euler's method goes less far by half of a substep of the first speed */
  CHECK(std::abs(x_of(world) - start * start / (2 * friction)) < 0.51 * start / 240);
  CHECK(speed_of(world) == 0);
}

TEST_CASE("joint axes: no faster than its largest speed", "[physics]")
{
  Held held(JointType::slider, {10, 0, 0});
  held.joint.directions[0] = {.max_speed = 2};
  World world = held.world();
  run(world, 120);
  CHECK(std::abs(speed_of(world) - 2) < 1e-4);
  const double before = x_of(world);
  run(world, 60);
  CHECK(std::abs(x_of(world) - before - 2) < 0.01 * 2); /* gravity adds what a substep gains before it is braked */
}

TEST_CASE("joint axes: limits stop a body from both sides, at any speed", "[physics]")
{
  const double speed = GENERATE(0.5, 20.0, 300.0), sign = GENERATE(-1.0, 1.0);
  Held held(JointType::slider);
  held.body().linear_velocity = {float(sign * speed), 0, 0};
  held.joint.directions[0] = {.lower = -0.7f, .upper = 0.7f};
  World world = held.world();
  double farthest = 0;
  for (int k = 0; k < 240; ++k) {
    world.step();
    farthest = std::max(farthest, std::abs(x_of(world)));
  }
  CHECK(farthest < 0.7 + 1e-3);
  CHECK(std::abs(sign * x_of(world) - 0.7) < 1e-3); /* it stays where it was stopped */
}

TEST_CASE("joint axes: a hinge stops at its limits under its weight, near half a turn as well", "[physics]")
{
  const double limit = GENERATE(0.2, 1.5, 3.0);
  Held held(JointType::hinge, {0, -10, 0});
  held.joint.position_a = held.joint.position_b = {0, -1, 0}; /* the axis is below, so it falls over */
  held.body().angular_velocity = {0.5f, 0, 0};
  held.body().linear_velocity = {0, 0, 0.5f};
  held.joint.rotations[0] = {.lower = float(-limit), .upper = float(limit)};
  World world = held.world();
  run(world, 900);
  CHECK(std::abs(angle_of(world) - limit) < 0.01);
  CHECK(std::abs(turn_speed_of(world)) < 0.01);
}

TEST_CASE("joint axes: a soft limit gives way as its stiffness says", "[physics]")
{
  Held held(JointType::slider, {10, 0, 0});
  held.joint.directions[0] = {.upper = 0, .limit_stiffness = 500, .limit_damping = 50};
  World world = held.world();
  run(world, 600);
  CHECK(std::abs(x_of(world) - 10.0 / 500) < 1e-4);
}

TEST_CASE("joint axes: the damper of a soft limit brakes nothing before the limit", "[physics]")
{
  const float damping = GENERATE(0.0f, 1.0f, 100.0f, 10000.0f);
  Held held(JointType::slider);
  held.body().linear_velocity = {-1, 0, 0};
  held.joint.directions[0] = {.lower = -1.01f, .limit_stiffness = 1, .limit_damping = damping};
  World world = held.world();
  for (int k = 1; k < 60; ++k) {
    world.step();
    REQUIRE(std::abs(x_of(world) + k / 60.0) < 1e-5);
    REQUIRE(std::abs(speed_of(world) + 1) < 1e-5);
  }
  run(world, 30);
  if (damping >= 100) CHECK(std::abs(speed_of(world)) < 0.02);
  CHECK(x_of(world) < -1.01 + 1e-5);
}

/* m x'' = -k x - c x' from the moment at which it reaches the limit. */
TEST_CASE("joint axes: a body leaves a soft limit with what its damper leaves it", "[physics]")
{
  const double stiffness = 400, damping = 8, decay = damping / 2, rate = std::sqrt(stiffness - decay * decay);
  Held held(JointType::slider);
  held.body().linear_velocity = {-1, 0, 0};
  held.joint.directions[0] = {.lower = -0.5f, .limit_stiffness = float(stiffness), .limit_damping = float(damping)};
  World world = held.world(1.0 / 1000);
  run(world, 1000);
  const double lost = std::exp(-decay * (pi - std::atan2(2 * decay * rate, rate * rate - decay * decay)) / rate);
  CHECK(std::abs(speed_of(world) - lost) < 0.02);
}

/* The least floats vanish where kernels divide by them, and the largest leave the range of numbers. */
TEST_CASE("joint axes: no stiffness or damping is too small or too large", "[physics]")
{
  const float number = GENERATE(1e-45f, 1e-40f, 1e-37f, 1e-33f, 1e36f, 3e38f);
  CAPTURE(number);
  const JointAxis axes[] = {{.target_position = 100, .stiffness = number},
                            {.target_velocity = 1, .damping = number},
                            {.target_position = 100, .stiffness = number, .damping = number},
                            {.upper = 0.5f, .limit_stiffness = number},
                            {.upper = 0.5f, .limit_stiffness = number, .limit_damping = number}};
  for (const JointAxis &axis : axes) {
    Held held(JointType::slider);
    held.body().linear_velocity = {1, 0, 0};
    held.joint.directions[0] = axis;
    World world = held.world();
    run(world, 120);
    CAPTURE(&axis - axes, x_of(world), speed_of(world));
    CHECK(world.quarantined().empty());
    CHECK(std::abs(x_of(world)) < 101);
    CHECK(std::abs(speed_of(world)) < 1000);
  }
}

TEST_CASE("joint axes: a range of nothing holds the axis", "[physics]")
{
  Held held(JointType::slider, {10, 0, 0});
  held.joint.directions[0] = {.lower = 0, .upper = 0};
  World world = held.world();
  run(world, 300);
  CHECK(std::abs(x_of(world)) < 1e-3);
  CHECK(std::abs(speed_of(world)) < 1e-4);
}

TEST_CASE("joint axes: a rope lets go and holds, a rod does both, and both swing as pendulums", "[physics]")
{
  const bool rod = GENERATE(false, true);
  Held held(JointType::distance, {0, -10, 0});
  held.body().position = {0, -0.5, 0};
  held.joint.directions[0] = {.lower = rod ? 0.5f : -JointAxis::unlimited, .upper = 1};
  if (rod) held.joint.directions[0].upper = 0.5f;
  World world = held.world();
  run(world, 300);
  const double length = -world.precise_bodies()[0].position[1];
  CHECK(std::abs(length - (rod ? 0.5 : 1.0)) < 2e-3);
}

TEST_CASE("joint axes: a cone stops every swing at its angle, and the twist at its own", "[physics]")
{
  const double cone = 0.6, direction = GENERATE(0.0, 0.7, 1.6, 3.9);
  Held held(JointType::cone_twist);
  held.body().angular_velocity = {1.0f, float(2 * std::cos(direction)), float(2 * std::sin(direction))};
  held.joint.rotations[0] = {.lower = -0.3f, .upper = 0.3f};
  held.joint.rotations[1] = {.upper = float(cone)};
  World world = held.world();
  double widest = 0;
  for (int k = 0; k < 240; ++k) {
    world.step();
    widest = std::max(widest, lean_of(world));
  }
  CHECK(widest > cone - 0.02);
  CHECK(widest < cone + 0.02);
}

/* A cube that turns about all axes alike, so that its angular velocity keeps its direction and the brake finds it there
 * while the angle is small. */
TEST_CASE("joint axes: friction and damper of a cone brake the way around it, too, at any angle", "[physics]")
{
  const bool is_damper = GENERATE(false, true), in_tree = GENERATE(false, true);
  const double lean = GENERATE(0.5, 1.5), start = 0.5, brake = 2, lasts = 0.05;
  CAPTURE(is_damper, in_tree, lean);
  Held held(JointType::cone_twist);
  held.body().orientation = {0, 0, float(std::sin(lean / 2)), float(std::cos(lean / 2))};
  held.body().angular_velocity = {float(-start * std::sin(lean / 2)), float(start * std::cos(lean / 2)), 0};
  held.joint.rotations[1] =
      is_damper ? JointAxis{.damping = float(brake)} : JointAxis{.friction = float(brake * moment)};
  held.scene.joints = {held.joint};
  if (in_tree) held.scene.articulations.push_back({"", {0}, no_body, {}});
  World world(held.scene, settings_with(0.001, 1), {});
  run(world, int(std::lround(lasts / 0.001)));
  const Vec3 &turns = world.bodies()[0].angular_velocity;
  const double left = std::hypot(turns[0], turns[1], turns[2]),
               expected = is_damper ? start * std::exp(-brake / moment * lasts) : start - brake * lasts;
  CHECK(std::abs(left - expected) < 0.01 * start);
  run(world, is_damper ? 6000 : 600);
  CHECK(std::abs(world.bodies()[0].angular_velocity[1]) < 1e-4);
}

TEST_CASE("joint axes: a universal joint turns about its two axes and holds the third", "[physics]")
{
  Held held(JointType::universal);
  held.body().angular_velocity = {1, 2, 0};
  held.joint.rotations = {};
  World world = held.world();
  double crossed = 0, twist_speed = 0;
  for (int k = 0; k < 240; ++k) {
    world.step();
    const Matrix axes = axes_of(world.bodies()[0].orientation);
    crossed = std::max(crossed, std::abs(axes.col(1).x())); /* y of the body and x of the world */
    twist_speed = std::max(twist_speed, std::abs(turn_speed_of(world)));
  }
  CHECK(crossed < 1e-3);
  CHECK(twist_speed > 0.5);
}

TEST_CASE("joint axes: what arrives at a limit leaves it with its restitution's share of the speed", "[physics]")
{
  for (const JointType type : {JointType::slider, JointType::hinge, JointType::distance})
    for (const double restitution : {0.0, 0.5, 1.0}) {
      CAPTURE(name_of_type(type), restitution);
      const bool turns = type == JointType::hinge;
      Scene scene = empty_scene({0, 0, 0});
      Body &body = add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), {1, 0, 0});
      (turns ? body.angular_velocity : body.linear_velocity) = {3, 0, 0};
      Joint joint;
      joint.type = type;
      joint.body_b = 0;
      if (type != JointType::distance) joint.position_a = {1, 0, 0};
      const float from = type == JointType::distance ? 0.5f : -0.5f, to = type == JointType::distance ? 1.7f : 0.7f;
      JointAxis &axis = turns ? joint.rotations[0] : joint.directions[0];
      axis = {.lower = from, .upper = to, .restitution = float(restitution)};
      scene.joints.push_back(joint);
      World world(scene, {}, {"serial", {}, false});
      const auto speed = [&] {
        const BodyState state = world.bodies()[0];
        return double((turns ? state.angular_velocity : state.linear_velocity)[0]);
      };
      run(world, 30);
      CHECK(speed() == Approx(-3 * restitution).margin(0.02));
      run(world, 60); /* the other limit */
      if (restitution > 0.4) CHECK(std::abs(speed()) <= 3 * restitution + 0.02);
      if (restitution == 1) CHECK(std::abs(speed()) == Approx(3).margin(0.05));
    }
}

/* Both angles of a universal joint, from where the axes are: y of the body about x of the world, and about y. */
std::pair<double, double> angles_of_cross(World &world)
{
  const Matrix axes = axes_of(world.bodies()[0].orientation);
  return {std::atan2(axes(2, 1), axes(1, 1)), std::atan2(axes(0, 2), axes(0, 0))};
}

TEST_CASE("joint axes: limits of a universal joint stop both turns at their angles, however far the other is",
          "[physics]")
{
  const double first = GENERATE(0.4, 1.4, 2.5), second = GENERATE(0.3, 1.3, 2.9);
  CAPTURE(first, second);
  Held held(JointType::universal);
  held.body().angular_velocity = {3, 2, 0};
  held.joint.rotations = {};
  held.joint.rotations[0] = {.lower = -0.1f, .upper = float(first)};
  held.joint.rotations[1] = {.lower = -0.1f, .upper = float(second)};
  World world = held.world();
  double widest_turn = 0, widest_spin = 0;
  for (int k = 0; k < 360; ++k) {
    world.step();
    const auto [turn, spin] = angles_of_cross(world);
    widest_turn = std::max(widest_turn, turn);
    widest_spin = std::max(widest_spin, spin);
  }
  CHECK(widest_turn == Approx(first).margin(0.02));
  CHECK(widest_spin == Approx(second).margin(0.02));
}

TEST_CASE("joint axes: a wheel rests on its spring, stays where it is steered, and a motor spins it up", "[physics]")
{
  Scene scene = empty_scene();
  Body &wheel = add_body(scene, BodyType::dynamic, cylinder_shape(0.3f, 0.1f), {0, 0, 0});
  wheel.mass = 8;
  Joint joint;
  joint.type = JointType::wheel;
  joint.body_b = 0;
  joint.orientation_a = turn_about(Vector::UnitZ(), pi / 2); /* x, the suspension, points up */
  joint.orientation_b = turn_about(Vector::UnitZ(), 0);      /* y is the axle, along which the cylinder lies */
  const double torque = 6, steering = 0.3, stiffness = 2000;
  joint.orientation_a = quat_of(turn_of_x_to(Vector::UnitY()));
  joint.directions[0] = {.stiffness = float(stiffness), .damping = 200};
  joint.rotations[0].lower = joint.rotations[0].upper = float(steering);
  joint.rotations[1] = {.target_velocity = 1000, .motor = true, .max_force = float(torque)};
  scene.bodies[0].orientation =
      quat_of(eigen_of(joint.orientation_a) * Eigen::Quaterniond(Eigen::AngleAxisd(steering, Vector::UnitX())));
  scene.joints.push_back(joint);
  World world(scene, {}, {"serial", {}, false});
  run(world, 300);
  const JointReading reading = world.read_joint(world.id_of_joint(0));
  const double inertia = moments_of(scene, scene.bodies[0]).y(), seconds = 5;
  CHECK(reading.directions[0] == Approx(-8 * gravity / stiffness).epsilon(0.01));
  CHECK(reading.rotations[0] == Approx(steering).margin(2e-3));
  CHECK(reading.rotation_speeds[1] == Approx(torque / inertia * seconds).epsilon(0.01));
  CHECK(open_joints(world).max_angle < 2e-3);
  CHECK(open_joints(world).max_distance < 1e-4);
}

TEST_CASE("joint axes: a joint of six degrees of freedom that holds all but one is a slider or a hinge", "[physics]")
{
  Held six(JointType::six_dof, {10, -10, 3}), slider(JointType::slider, {10, -10, 3});
  six.joint.held_directions = {false, true, true};
  six.joint.held_rotations = {true, true, true};
  six.joint.directions[0] = slider.joint.directions[0] = {.upper = 2, .stiffness = 3, .damping = 0.1f};
  World one = six.world(), other = slider.world();
  run(one, 120);
  run(other, 120);
  CHECK(one.body_hash() == other.body_hash());
}
