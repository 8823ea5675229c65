/* Joints move bodies as theory says: pendulums, tops and slides have closed forms. The integrator is of first order, so
 * most bounds are a rate of the motion times the substep. */
#include <map>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr double epsilon = 0x1p-23; /* the relative spacing of floats */

/* A ball at the end of an arm of a metre that hangs from the origin, let go at an angle from the vertical. */
struct Pendulum {
  static constexpr double radius = 0.2, length = 1;
  Scene scene = empty_scene();

  explicit Pendulum(double angle, JointType type = JointType::hinge)
  {
    Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(float(radius)),
                          {length * std::sin(angle), -length * std::cos(angle), 0});
    ball.orientation = turn_about(Vector::UnitZ(), angle);
    connect(scene, type, no_body, 0, Vector::Zero(), Vector::UnitZ());
  }
  /* rad/s, of small swings; the ball turns with the arm */
  static double rate() { return std::sqrt(gravity * length / (length * length + 0.4 * radius * radius)); }
  static double period(double angle) { return 2 * pi / rate() * lengthening_of_period(angle); }
};

double angle_of_pendulum(World &world)
{
  const Point p = world.precise_bodies()[0].position;
  return std::atan2(p[0], -p[1]);
}

double energy_of(World &world) { return conserved_quantities(world.scene(), world.precise_bodies()).energy(); }

/* A pendulum's first period and the energy over 10 s, of the energy above the lowest point. */
struct Swing {
  double period = 0, energy = 0, lost = 0, gained = 0, open = 0;
};
Swing swing_of(const Pendulum &pendulum, const Settings &settings)
{
  World world(pendulum.scene, settings, on_serial);
  ZeroCrossings crossings;
  Swing swing;
  swing.energy = energy_of(world) + gravity * Pendulum::length;
  const int steps = int(std::lround(10 / double(settings.step)));
  for (int k = 1; k <= steps; ++k) {
    world.step();
    crossings.note(k * double(settings.step), angle_of_pendulum(world));
    const double change = (energy_of(world) + gravity * Pendulum::length) / swing.energy - 1;
    swing.gained = std::max(swing.gained, change);
    swing.lost = std::max(swing.lost, -change);
    swing.open = std::max(swing.open, open_joints(world).max_distance);
  }
  swing.period = crossings.interval(0, 1);
  return swing;
}

/* What theory says of the errors of a pendulum, which has a mass of 1 kg and an arm of 1 m. */
struct PendulumBounds {
  double open, energy, shortest, longest;

  PendulumBounds(double angle, const Settings &settings)
  {
    const Softness soft(settings);
    const double h = substep_of(settings), w = Pendulum::rate(), fall = gravity * (1 - std::cos(angle));
    const double tension = gravity + 2 * fall, fastest = std::sqrt(2 * fall);
    /* A substep leaves the circle by (v h)^2 / 2, of which the joint closes a share; and the load stretches it. */
    const double stretch = soft.stretch * tension;
    open = 0.5 * fastest * fastest * h / soft.rate + stretch;
    /* The energy of Euler's method swings by w h / 2. The open joint holds at most the work of its load, and
     * loses some of it as it is stretched twice a period, with a damping of 2 ratio (2 pi hertz), over 10 s. */
    const double damping = 2 * double(settings.joint_damping_ratio) / std::sqrt(soft.stretch);
    const double lost = 10 * 0.5 * damping * std::pow(2 * w * stretch, 2);
    energy = 0.5 * w * h + (open * tension + lost) / fall;
    /* The period is that of an energy within this bound, and of second order beside it. */
    const double own = (w * h) * (w * h) / 24 + 0.5 * stretch;
    shortest = Pendulum::period(angle_of(fall * (1 - energy))) * (1 - own);
    longest = Pendulum::period(angle_of(fall * (1 + energy))) * (1 + own);
  }
  static double angle_of(double fall) { return std::acos(std::max(1 - fall / gravity, -0.99999)); }
};

/* The angle about y, rad, that grows without jumps. */
class Azimuth {
public:
  double add(double x, double z)
  {
    const double now = std::atan2(-z, x);
    if (known_) total_ += std::remainder(now - last_, 2 * pi);
    known_ = true;
    last_ = now;
    return total_;
  }

private:
  bool known_ = false;
  double last_ = 0, total_ = 0;
};

/* How a body goes around the vertical from the origin, compared with a steady rate, rad/s. */
struct Precession {
  double rate_error = 0, momentum_error = 0, height = 0;
};
Precession precession_of(const Scene &scene, const Settings &settings, const Placement &placement, double rate,
                         double time)
{
  World world(scene, settings, placement);
  const double momentum = conserved_quantities(scene, world.precise_bodies()).angular_momentum[1];
  const double height = scene.bodies[0].position[1];
  Azimuth azimuth;
  Precession result;
  double turned = 0;
  const int steps = int(std::lround(time / double(settings.step)));
  for (int k = 0; k <= steps; ++k) {
    if (k > 0) world.step();
    const PreciseBodies bodies = world.precise_bodies();
    turned = azimuth.add(bodies[0].position[0], bodies[0].position[2]);
    result.height = std::max(result.height, std::abs(bodies[0].position[1] - height));
    const double now = conserved_quantities(scene, bodies).angular_momentum[1];
    result.momentum_error = std::max(result.momentum_error, std::abs(now / momentum - 1));
  }
  result.rate_error = std::abs(turned / (rate * steps * double(settings.step)) - 1);
  return result;
}

/* Of the heights, which follow the error of the state at once; a rate over a whole time errs with a higher order. */
std::vector<double> heights_by_step(const Scene &scene, double rate, double time)
{
  std::vector<double> heights;
  for (const double step : {1.0 / 60, 1.0 / 120, 1.0 / 240})
    heights.push_back(precession_of(scene, stiff_settings(step), in_double, rate, time).height);
  return heights;
}

/* A box that turns about no principal axis of its own: its moments would take it off the hinge. */
Scene out_of_balance(double spin)
{
  Scene scene = empty_scene({0, 0, 0});
  Body &body = add_body(scene, BodyType::dynamic, box_shape(0.4f, 0.1f, 0.2f), {0, 0, 0});
  body.orientation = turn_about({0, 0, 1}, 0.5);
  body.angular_velocity = {0, float(spin), 0};
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitY());
  return scene;
}

/* How far the axis leans, and the spin that is lost, relative, in 3 s. */
struct Balance {
  double lean = 0, lost = 0;
};
Balance balance_of(double spin, const Settings &settings, const Placement &placement)
{
  const Scene scene = out_of_balance(spin);
  World world(scene, settings, placement);
  Balance balance;
  for (int k = 0; k < int(std::lround(3 / double(settings.step))); ++k) {
    world.step();
    balance.lean = std::max(balance.lean, open_joints(world).max_angle);
  }
  balance.lost = 1 - world.precise_bodies()[0].angular_velocity[1] / spin;
  return balance;
}

} // namespace

TEST_CASE("a pendulum swings with the period and the energy of theory, little and wide", "[physics]")
{
  const double angle = GENERATE(0.05, 1.0, 2.0, 3.0);
  const double step = GENERATE(1.0 / 60, 1.0 / 1000);
  const JointType type = GENERATE(JointType::hinge, JointType::ball);
  const Settings settings = settings_with(step);
  const Swing swing = swing_of(Pendulum(angle, type), settings);
  const PendulumBounds bounds(angle, settings);
  CAPTURE(name_of_type(type), angle, step, swing.period, Pendulum::period(angle), swing.lost, swing.gained, swing.open,
          bounds.open, bounds.energy, bounds.shortest, bounds.longest);
  CHECK(swing.period > bounds.shortest);
  CHECK(swing.period < bounds.longest);
  CHECK(swing.lost < bounds.energy);
  CHECK(swing.gained < bounds.energy);
  CHECK(swing.open < bounds.open);
}

TEST_CASE("a rod on a hinge swings with the period of its moment of inertia", "[physics]")
{
  const double offset = GENERATE(0.1, 0.5), step = GENERATE(1.0 / 60, 1.0 / 1000);
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.2f), {0, -offset, 0}).orientation =
      turn_about(Vector::UnitZ(), -0.5 * pi);
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  const double turn = 0.1;
  scene.bodies[0].position = {offset * std::sin(turn), -offset * std::cos(turn), 0};
  scene.bodies[0].orientation = turn_about(Vector::UnitZ(), turn - 0.5 * pi);
  const double moment = (0.25 + 0.0025) / 3 + offset * offset, w = std::sqrt(gravity * offset / moment);
  const Settings settings = settings_with(step);
  World world(scene, settings, on_serial);
  ZeroCrossings crossings;
  for (int k = 1; k * step < 12; ++k) {
    world.step();
    crossings.note(k * double(settings.step), angle_of_pendulum(world));
  }
  const double expected = 2 * pi / w * lengthening_of_period(turn);
  const double error = crossings.interval(0, 3) / expected - 1;
  CAPTURE(offset, step, expected, error);
  /* Euler's method errs by (w h)^2 / 24. A stretched joint changes the arm; and the energy that it takes, as with the
   * pendulum above, changes the amplitude, on which the period depends by a sixteenth of its square. */
  const double h = substep_of(settings), stretch = 2 * gravity * Softness(settings).stretch / offset;
  CHECK(std::abs(error) < (w * h) * (w * h) / 24 + stretch + turn * turn / 16 * 0.5 * w * h + 10 * epsilon);
}

TEST_CASE("a conical pendulum goes around at the rate of theory and keeps its angular momentum", "[physics]")
{
  const double angle = GENERATE(0.3, 1.0), step = GENERATE(1.0 / 60, 1.0 / 1000);
  Pendulum pendulum(angle, JointType::ball);
  const double rate = std::sqrt(gravity / std::cos(angle));
  pendulum.scene.bodies[0].linear_velocity = vec3_of(Vector(0, rate, 0).cross(Vector(std::sin(angle), 0, 0)));
  pendulum.scene.bodies[0].angular_velocity = {0, float(rate), 0};
  const Settings settings = settings_with(step);
  const Precession result = precession_of(pendulum.scene, settings, on_serial, rate, 5);
  const std::vector<double> heights = heights_by_step(pendulum.scene, rate, 2);
  CAPTURE(angle, step, result.rate_error, result.momentum_error, result.height, heights);
  /* Euler's method errs by half a substep, and the arm is longer by what its tension g / cos opens. */
  const double tension = gravity / std::cos(angle), h = substep_of(settings);
  const double open = tension * (Softness(settings).stretch + 0.5 * h / Softness(settings).rate);
  CHECK(result.rate_error < 0.5 * rate * h + open);
  CHECK(result.momentum_error < 0.5 * rate * h + open);
  CHECK(result.height < 0.5 * rate * h * std::sin(angle) * std::sin(angle) + 2 * open);
  CHECK(falls_with_first_order(heights));
}

TEST_CASE("a gyroscope on a ball joint precesses at the rate of theory", "[physics]")
{
  const double step = GENERATE(1.0 / 60, 1.0 / 1000), spin = GENERATE(30.0, 100.0);
  Scene scene = empty_scene();
  Body &top = add_body(scene, BodyType::dynamic, box_shape(0.05f, 0.3f, 0.3f), {0.5, 0, 0});
  const float top_moment = 0.03f;
  top.inertia = {0.05f, top_moment, top_moment};
  connect(scene, JointType::ball, no_body, 0, Vector::Zero());
  /* With its axis level, a top on a support precesses steadily at m g l / (I spin), whatever its other moments. */
  const double rate = gravity * 0.5 / (double(top.inertia[0]) * spin);
  scene.bodies[0].angular_velocity = {float(spin), float(rate), 0};
  scene.bodies[0].linear_velocity = {0, 0, float(-0.5 * rate)};
  const Settings settings = settings_with(step);
  const Precession result = precession_of(scene, settings, on_serial, rate, 3);
  CAPTURE(step, spin, result.rate_error, result.momentum_error, result.height);
  /* The support opens by its load, the weight, as an acceleration of the end of the top, whose effective mass is
   * small. */
  const double h = substep_of(settings), end = 1 + 0.5 * 0.5 / double(top_moment);
  const double open = gravity * end * (Softness(settings).stretch + 0.5 * h / Softness(settings).rate);
  CHECK(result.rate_error < 0.5 * rate * h + open);
  CHECK(result.momentum_error < 0.5 * rate * h + open);
  CHECK(result.height < 0.5 * 0.5 * rate * h + 2 * open);
}

TEST_CASE("a slider on an incline without friction falls with the gravity along it", "[physics]")
{
  const double slope = GENERATE(0.2, 0.8, 1.5), step = GENERATE(1.0 / 60, 1.0 / 1000);
  const Vector axis(std::cos(slope), -std::sin(slope), 0);
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.2f, 0.1f), {0, 0, 0}).mass = 5;
  connect(scene, JointType::slider, no_body, 0, Vector::Zero(), axis);
  const Settings settings = settings_with(step);
  World world(scene, settings, on_serial);
  const int steps = int(std::lround(2 / step));
  run(world, steps);
  const double time = steps * double(settings.step), along = gravity * std::sin(slope);
  const PreciseBodyState body = world.precise_bodies()[0];
  const Vector way(body.position.data()), speed(body.linear_velocity.data());
  const double speed_error = std::abs(speed.dot(axis) / (along * time) - 1);
  const double way_error = std::abs(way.dot(axis) / (0.5 * along * time * time) - 1);
  CAPTURE(slope, step, speed_error, way_error);
  /* Each substep rounds the velocity to half a spacing; Euler's method runs ahead by half a substep; and the joint
   * opens by the load across it. */
  const double h = substep_of(settings), rounding = epsilon * steps * settings.substeps;
  CHECK(speed_error < rounding);
  CHECK(way_error < h / time + rounding);
  CHECK(open_joints(world).max_distance < 1.01 * gravity * std::cos(slope) * Softness(settings).stretch + epsilon);
  CHECK(open_joints(world).max_angle < 10 * epsilon);
}

TEST_CASE("a hinge holds the axis of a body that is out of balance at 50 rad/s", "[physics]")
{
  const double step = GENERATE(1.0 / 60, 1.0 / 1000), spin = 50;
  const Settings settings = settings_with(step);
  const Balance balance = balance_of(spin, settings, on_serial);
  const Scene scene = out_of_balance(spin);
  const Vector moments = moments_of(scene, scene.bodies[0]);
  /* The moment that turns the axis, by Euler's equations, as an acceleration: it stretches the joint, and each substep
   * leans by half of it. */
  const double pull = spin * spin * std::sin(0.5) * std::cos(0.5) * (moments.y() - moments.x()) / moments.z();
  const double lean = pull * (Softness(settings).stretch + 0.5 * substep_of(settings) / Softness(settings).rate);
  std::vector<double> lost;
  for (const double shorter : {1.0 / 240, 1.0 / 480, 1.0 / 960})
    lost.push_back(balance_of(spin, stiff_settings(shorter), in_double).lost);
  CAPTURE(step, balance.lean, lean, balance.lost, lost);
  CHECK(balance.lean < lean);
  CHECK(balance.lost > -10 * epsilon * settings.substeps);
  CHECK(falls_with_first_order(lost));
}

TEST_CASE("free bodies with a joint of each type keep their momentum", "[physics]")
{
  const JointType type = GENERATE(from_range(std::begin(all_joint_types), std::end(all_joint_types)));
  const uint64_t seed = GENERATE(3, 4, 5);
  Random random(seed);
  World world(tumbling_pair(random, type), {}, on_serial);
  const Momentum start = momentum_of(world);
  double linear = 0, angular = 0;
  for (int step = 0; step < 300; ++step) {
    world.step();
    const Momentum now = momentum_of(world);
    linear = std::max(linear, (now.linear - start.linear).norm() / start.linear_scale);
    angular = std::max(angular, (now.angular - start.angular).norm() / start.angular_scale);
  }
  CAPTURE(name_of_type(type), seed, linear, angular);
  CHECK(linear < 1e-5);
  CHECK(angular < 1e-5);
}

/* Pushes along and about each axis of the frame, one world each: three directions, then three rotations. */
TEST_CASE("each type holds what it says and leaves the rest free with the full mass", "[physics]")
{
  const JointType type = GENERATE(from_range(std::begin(all_joint_types), std::end(all_joint_types)));
  const bool body_first = GENERATE(false, true);
  /* by docs/joints.md: x y z, then the rotations */
  const std::map<JointType, std::string> freedoms = {{JointType::ball, "---xyz"},        {JointType::fixed, "------"},
                                                     {JointType::hinge, "---x--"},       {JointType::slider, "x-----"},
                                                     {JointType::cylindrical, "x--x--"}, {JointType::plane, "-yzx--"},
                                                     {JointType::parallel, "xyzx--"}};
  for (int push = 0; push < 6; ++push) {
    const Eigen::Quaterniond axes = turn_of_x_to({1, 2, -1});
    Scene scene = empty_scene({0, 0, 0});
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.4f, 0.5f), {3, -2, 1});
    body.mass = 2.5f;
    body.orientation = quat_of(axes);
    connect(scene, type, body_first ? 0 : no_body, body_first ? no_body : 0, {3, -2, 1}, {1, 2, -1});
    World world(scene, {}, on_serial);
    const Vector along = axes * Vector(Vector::Unit(push % 3)), moments = moments_of(scene, scene.bodies[0]);
    const Vec3 impulse = vec3_of(0.5 * along);
    if (push < 3) world.add_impulse(world.id_of(0), {.impulse = impulse});
    else world.add_impulse(world.id_of(0), {.angular_impulse = impulse});
    run(world, 60);
    const PreciseBodyState now = world.precise_bodies()[0];
    const Vector way = Vector(now.position.data()) - Vector(3, -2, 1), speed(now.linear_velocity.data()),
                 spin(now.angular_velocity.data());
    const bool is_free = freedoms.at(type)[size_t(push)] != '-';
    const double linear = is_free && push < 3 ? 0.5 / 2.5 : 0,
                 angular = is_free && push >= 3 ? 0.5 / moments[push % 3] : 0;
    CAPTURE(name_of_type(type), push, is_free, body_first);
    CHECK((speed - linear * along).norm() < 1e-5);
    CHECK((spin - angular * along).norm() < 1e-5 * std::max(1.0, angular));
    CHECK((way - linear * along).norm() < 1e-4);
    CHECK(open_joints(world).max_distance < 1e-4);
    CHECK(open_joints(world).max_angle < 1e-4);
  }
}
