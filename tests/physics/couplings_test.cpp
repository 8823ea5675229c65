/* Couplings of joints against closed forms: gears, rack and pinion, screw, pulley, differential and planetary gear, and
 * an integrator in double that eliminates the joints. */
#include <functional>

#include <tandem/metrics.h>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* A wheel about x, which is its cylinder's axis y turned. */
uint32_t add_wheel(Scene &scene, double radius, const Vector &at, double mass = 1, double half_width = 0.05)
{
  Body &body = add_body(scene, BodyType::dynamic, cylinder_shape(float(radius), float(half_width)), point_of(at));
  body.orientation = turn_about(Vector::UnitZ(), -pi / 2);
  body.mass = float(mass);
  body.filter_mask = 0;
  return uint32_t(scene.bodies.size() - 1);
}

double moment_of_wheel(const Scene &scene, uint32_t body) { return moments_of(scene, scene.bodies[body]).y(); }

/* The number of the hinge. */
uint32_t add_axle(Scene &scene, uint32_t carrier, uint32_t wheel)
{
  connect(scene, JointType::hinge, carrier, wheel, vector_of(scene.bodies[wheel].position));
  return uint32_t(scene.joints.size() - 1);
}

Coupling gear(uint32_t joint_a, uint32_t joint_b, int32_t teeth_a, int32_t teeth_b)
{
  Coupling coupling;
  coupling.joint_a = joint_a;
  coupling.joint_b = joint_b;
  coupling.teeth_a = teeth_a;
  coupling.teeth_b = teeth_b;
  return coupling;
}

/* About the axis x of the world. */
double spin_of(World &world, uint32_t body) { return double{world.bodies()[body].angular_velocity[0]}; }

/* The turns of bodies about x since the beginning, in rad; they turn by less than half a turn a step. */
class TurnCounter {
public:
  explicit TurnCounter(World &world) : world_(world), last_(angles()), sum_(last_.size()) {}
  void note()
  {
    const std::vector<double> now = angles();
    for (size_t i = 0; i < now.size(); ++i) sum_[i] += std::remainder(now[i] - last_[i], 2 * pi);
    last_ = now;
  }
  double of(uint32_t body) const { return sum_[body]; }

private:
  std::vector<double> angles() const
  {
    std::vector<double> angles;
    for (const PreciseBodyState &s : world_.precise_bodies()) {
      const auto &q = s.orientation;
      const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
      const Vector z = turn * Vector::UnitZ(); /* across the axle */
      angles.push_back(std::atan2(-z.y(), z.z()));
    }
    return angles;
  }
  World &world_;
  std::vector<double> last_, sum_;
};

double worst_error(World &world)
{
  const auto errors = coupling_errors(world.scene(), world.precise_bodies());
  return *std::max_element(errors.begin(), errors.end());
}

/* Two wheels on hinges to the world, of which the first has a motor. */
struct Pair {
  Scene scene = empty_scene({0, 0, 0});
  explicit Pair(int32_t teeth_a, int32_t teeth_b)
  {
    add_wheel(scene, 0.2, {0, 0, 0});
    add_wheel(scene, 0.3, {0, 0.5, 0}, 2.5);
    add_axle(scene, no_body, 0);
    add_axle(scene, no_body, 1);
    scene.couplings = {gear(0, 1, teeth_a, teeth_b)};
  }
  JointAxis &motor() { return scene.joints[0].rotations[0]; }
};

} // namespace

TEST_CASE("couplings: gears hold their ratio over a hundred turns, and no tooth is lost", "[physics]")
{
  const auto [a, b] = GENERATE(std::pair(20, 30), std::pair(17, -40), std::pair(31, 7), std::pair(-1, 2));
  Pair pair(a, b);
  pair.motor() = {.target_velocity = 12, .motor = true, .max_force = 20};
  World world(pair.scene, {}, {});
  TurnCounter turns(world);
  const int steps = int(105 * 2 * pi / 12 * 60); /* speeding up takes some */
  for (int k = 0; k < steps; ++k) {
    world.step();
    turns.note();
  }
  CHECK(turns.of(0) > 99 * 2 * pi);
  CHECK(std::abs(a * turns.of(0) + b * turns.of(1)) < 1e-4 * std::abs(a)); /* of teeth_a, rad */
  CHECK(std::abs(a * spin_of(world, 0) + b * spin_of(world, 1)) < 1e-4 * 12 * std::abs(a));
  CHECK(worst_error(world) < 1e-5);
}

TEST_CASE("couplings: a motor spins up meshed wheels with the inertia that theory gives", "[physics]")
{
  const auto [a, b] = GENERATE(std::pair(20, 30), std::pair(30, -10), std::pair(10, 40));
  Pair pair(a, b);
  const double torque = 0.05, n = -double(a) / b; /* turns of b for one of a */
  pair.motor() = {.target_velocity = 1000, .motor = true, .max_force = float(torque)};
  World world(pair.scene, {}, {});
  run(world, 120);
  const double first = moment_of_wheel(pair.scene, 0), second = moment_of_wheel(pair.scene, 1);
  const double spin = torque / (first + n * n * second) * 2;
  CHECK(spin_of(world, 0) == Approx(spin).epsilon(1e-3));
  CHECK(spin_of(world, 1) == Approx(n * spin).epsilon(1e-3));
  CHECK(world.statistics().kinetic_energy == Approx(torque * 0.5 * spin * 2).epsilon(2e-3)); /* work done */
}

TEST_CASE("couplings: a train of 20 gears has the product of its ratios", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  const uint32_t wheels = 20;
  std::vector<int32_t> teeth;
  for (uint32_t i = 0; i < wheels; ++i) {
    add_wheel(scene, 0.2, {0, 0.5 * i, 0});
    add_axle(scene, no_body, i);
    teeth.push_back(i % 3 == 0 ? 24 : i % 3 == 1 ? 18 : 21);
    if (i > 0) scene.couplings.push_back(gear(i - 1, i, teeth[i - 1], teeth[i]));
  }
  /* each tooth passes all meshes, so that the ratio of first and last is that of their teeth */
  scene.joints[0].rotations[0] = {.target_velocity = 3, .motor = true};
  World world(scene, {}, {});
  TurnCounter turns(world);
  for (int k = 0; k < 600; ++k) {
    world.step();
    turns.note();
  }
  CHECK(turns.of(0) > 25);
  double ratio = 1;
  for (uint32_t i = 1; i < wheels; ++i) ratio *= -double(teeth[i - 1]) / teeth[i];
  CHECK(turns.of(wheels - 1) == Approx(ratio * turns.of(0)).epsilon(1e-4));
  CHECK(worst_error(world) < 1e-4);
}

TEST_CASE("couplings: gears on a frame that floats change no momentum", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.8f, 0.3f), {0, 0, 0}).filter_mask = 0;
  add_wheel(scene, 0.2, {0.2, -0.25, 0}, 1);
  add_wheel(scene, 0.3, {0.2, 0.25, 0}, 2);
  for (const uint32_t wheel : {1u, 2u}) add_axle(scene, 0, wheel);
  scene.couplings = {gear(0, 1, 20, 30)};
  scene.joints[0].rotations[0] = {.target_velocity = 8, .motor = true, .max_force = 0.3f};
  for (Body &body : scene.bodies) body.linear_velocity = {0.3f, -0.2f, 0.1f};
  World world(scene, {}, GENERATE(Placement{"serial", {}, false}, in_double));
  const Momentum before = momentum_of(world);
  run(world, 300);
  const Momentum after = momentum_of(world);
  CHECK(std::abs(spin_of(world, 1)) > 1);
  CHECK((after.linear - before.linear).norm() < 1e-5 * after.linear_scale);
  CHECK((after.angular - before.angular).norm() < 1e-5 * after.angular_scale);
  CHECK(worst_error(world) < 1e-4);
}

TEST_CASE("couplings: rack and pinion on an incline gain speed as theory says", "[physics]")
{
  const double slope = pi / 6, radius = 0.2, mass = 3;
  Scene scene = empty_scene({0, -10, 0});
  const Vector along(0, -std::sin(slope), std::cos(slope));
  add_wheel(scene, radius, {0, 1, 0}, 2);
  Body &rack = add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.5f), {0, 2, 0});
  rack.mass = float(mass);
  rack.filter_mask = 0;
  add_axle(scene, no_body, 0);
  connect(scene, JointType::slider, no_body, 1, {0, 2, 0}, along);
  Coupling coupling;
  coupling.type = CouplingType::rack_and_pinion;
  coupling.joint_b = 1;
  coupling.teeth_a = 20;
  coupling.travel = float(2 * pi * radius);
  scene.couplings = {coupling};
  World world(scene, {}, {});
  run(world, 60);
  const double moment = moment_of_wheel(scene, 0);
  const double speed = mass * 10 * std::sin(slope) / (mass + moment / (radius * radius)); /* after 1 s */
  const auto states = world.bodies();
  CHECK(vector_of(states[1].linear_velocity).dot(along) == Approx(speed).epsilon(2e-3));
  CHECK(spin_of(world, 0) == Approx(speed / radius).epsilon(2e-3));
  CHECK(worst_error(world) < 1e-3);
}

TEST_CASE("couplings: a nut of a screw comes down its thread", "[physics]")
{
  const double travel = 0.3;
  Scene scene = empty_scene({0, -10, 0});
  add_wheel(scene, 0.2, {0, 0, 0}, 2);
  scene.bodies[0].orientation = {0, 0, 0, 1};
  connect(scene, JointType::cylindrical, no_body, 0, {0, 0, 0}, Vector::UnitY());
  Coupling coupling;
  coupling.type = CouplingType::rack_and_pinion;
  coupling.teeth_a = 1;
  coupling.travel = float(travel);
  scene.couplings = {coupling};
  World world(scene, {}, {});
  run(world, 60);
  const double per_metre = 2 * pi / travel, moment = moment_of_wheel(scene, 0);
  const double speed = -2 * 10 / (2 + moment * per_metre * per_metre);
  CHECK(double{world.bodies()[0].linear_velocity[1]} == Approx(speed).epsilon(2e-3));
  CHECK(double{world.bodies()[0].angular_velocity[1]} == Approx(speed * per_metre).epsilon(2e-3));
}

namespace {

/* Two weights on ropes from points above them, which run over pulleys without mass. */
Scene atwood(double first, double second, double ratio)
{
  Scene scene = empty_scene({0, -10, 0});
  for (const auto &[mass, z] : {std::pair(first, 0.0), std::pair(second, 1.0)}) {
    Body &body = add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {0, -5, z});
    body.mass = float(mass);
    body.filter_mask = 0;
    connect(scene, JointType::distance, no_body, uint32_t(scene.bodies.size() - 1), {0, 0, z});
    place_frame(scene, uint32_t(scene.bodies.size() - 1), {0, -5, z}, Eigen::Quaterniond::Identity(),
                scene.joints.back().position_b, scene.joints.back().orientation_b);
  }
  Coupling coupling;
  coupling.type = CouplingType::pulley;
  coupling.joint_b = 1;
  coupling.ratio = float(ratio);
  coupling.offset = float(5 + 5 * ratio);
  scene.couplings = {coupling};
  return scene;
}

} // namespace

TEST_CASE("couplings: weights on a pulley fall as Atwood's do, and in a block and tackle", "[physics]")
{
  const auto [first, second, ratio] = GENERATE(std::tuple(3.0, 2.0, 1.0), std::tuple(1.0, 3.0, 2.0),
                                               std::tuple(2.0, 3.0, 2.0), std::tuple(1.0, 9.0, 4.0));
  const Scene scene = atwood(first, second, ratio);
  World world(scene, {}, {});
  run(world, 45);
  /* With x1 + ratio x2 fixed, a1 = -ratio a2, and the tension T and ratio T act. */
  const double fall = 10 * (first - second / ratio) / (first + second / (ratio * ratio)); /* of the first */
  const auto states = world.bodies();
  CHECK(double{states[0].linear_velocity[1]} == Approx(-fall * 0.75).epsilon(2e-3).margin(1e-4));
  CHECK(double{states[1].linear_velocity[1]} == Approx(fall / ratio * 0.75).epsilon(2e-3).margin(1e-4));
  CHECK(worst_error(world) < 2e-3);
}

TEST_CASE("couplings: a rope that is slack lets both weights fall, and one that is not pulls", "[physics]")
{
  Scene scene = atwood(3, 2, 1);
  scene.couplings[0].offset += 2; /* taut once both have fallen by 1 m */
  World world(scene, {}, {});
  run(world, 24); /* 0.8 m */
  for (const BodyState &state : world.bodies()) CHECK(double{state.linear_velocity[1]} == Approx(-4).epsilon(1e-4));
  run(world, 36);
  CHECK(worst_error(world) < 5e-3);
  const auto states = world.bodies();
  CHECK(double{states[0].linear_velocity[1]} == Approx(-double{states[1].linear_velocity[1]}).epsilon(1e-2));
  scene.couplings[0].only_pulls = false;
  scene.couplings[0].offset -= 2;
  World held(scene, {}, {});
  held.add_impulse(held.id_of(0), {.impulse = {0, 6, 0}}); /* a rod that also pushes */
  run(held, 2);
  CHECK(double{held.bodies()[1].linear_velocity[1]} < -0.5);
}

TEST_CASE("couplings: a differential gives both wheels the mean that its cage has", "[physics]")
{
  /* cage 0, wheels 1 and 2, all about x; a planet on the cage is left out: 2 cage = left + right follows from two
   * gears on the cage, each between the planet's axle, across, and one wheel's axle in the cage */
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), {0, 0, 0}).filter_mask = 0;
  for (const double x : {-0.5, 0.5}) add_wheel(scene, 0.2, {x, 0, 0}, x < 0 ? 1 : 2);
  Body &planet = add_body(scene, BodyType::dynamic, cylinder_shape(0.1f, 0.02f), {0, 0.15, 0}); /* about y */
  planet.mass = 0.3f;
  planet.filter_mask = 0;
  connect(scene, JointType::hinge, no_body, 0, {0, 0, 0});
  for (const uint32_t wheel : {1u, 2u}) add_axle(scene, 0, wheel);
  connect(scene, JointType::hinge, 0, 3, {0, 0.15, 0}, Vector::UnitY());
  scene.couplings = {gear(1, 3, 16, 10), gear(2, 3, 16, -10)};
  scene.joints[0].rotations[0] = {.target_velocity = 5, .motor = true, .max_force = 0.4f};
  /* one wheel is braked by a hinge of its own to the world */
  connect(scene, JointType::hinge, no_body, 1, {-0.5, 0, 0});
  scene.joints.back().rotations[0].friction = 0.1f;
  World world(scene, {}, {});
  run(world, 60);
  const double cage = spin_of(world, 0), left = spin_of(world, 1), right = spin_of(world, 2);
  CHECK(cage > 1);
  CHECK(right - left > 0.5);
  CHECK(left + right == Approx(2 * cage).epsilon(1e-3));
  /* the load of the brake, 0.1 N m and as much again, over the stiffness of a joint at what turns with the planet; the
   * cage gives way to three joints, so that they are as stiff as 0.19 of the substep rate allows */
  const double w = 2 * pi * 0.19 * 240, light = moments_of(scene, scene.bodies[3]).y() * (1.6 * 1.6);
  CHECK(worst_error(world) == Approx(0.2 / (light * w * w)).epsilon(0.3));
}

TEST_CASE("couplings: a planetary gear turns its arm as Willis says", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  const int32_t sun_teeth = 20, planet_teeth = 15, ring_teeth = 50;
  add_body(scene, BodyType::dynamic, box_shape(0.05f, 0.4f, 0.05f), {0, 0, 0}).filter_mask = 0; /* arm */
  add_wheel(scene, 0.2, {0.1, 0, 0});                                                           /* sun */
  add_wheel(scene, 0.5, {0.3, 0, 0}, 3);                                                        /* ring */
  add_wheel(scene, 0.15, {0.1, 0.35, 0});                                                       /* planet */
  connect(scene, JointType::hinge, no_body, 0, {0, 0, 0});
  for (const uint32_t wheel : {1u, 2u, 3u}) add_axle(scene, 0, wheel); /* angles in the arm */
  scene.couplings = {gear(1, 3, sun_teeth, planet_teeth), gear(3, 2, planet_teeth, -ring_teeth)};
  connect(scene, JointType::hinge, no_body, 2, {0.3, 0, 0}); /* holds the ring */
  scene.joints.back().rotations[0].lower = scene.joints.back().rotations[0].upper = 0;
  connect(scene, JointType::hinge, no_body, 1, {0.1, 0, 0}); /* drives the sun */
  scene.joints.back().rotations[0] = {.target_velocity = 7, .motor = true};
  World world(scene, {}, {});
  run(world, 120);
  CHECK(spin_of(world, 1) == Approx(7).epsilon(1e-3));
  CHECK(spin_of(world, 0) == Approx(7.0 * sun_teeth / (sun_teeth + ring_teeth)).epsilon(1e-3));
  CHECK(std::abs(spin_of(world, 2)) < 1e-3);
}

TEST_CASE("couplings: a pendulum mimics another, as an integrator in double has them", "[physics]")
{
  /* Two pendulums about x with q_a + 2 q_b = 0, so one angle is left: with angles from the vertical,
   * (I_a + I_b / 4) q'' = -m_a g l_a sin q + m_b g l_b / 2 sin(-q / 2) */
  Scene scene = empty_scene({0, -10, 0});
  const double masses[] = {1, 2}, lengths[] = {1, 0.6}, start = 0.8;
  for (const uint32_t i : {0u, 1u}) {
    const double angle = i == 0 ? start : -start / 2;
    const Vector at(i, -lengths[i] * std::cos(angle), -lengths[i] * std::sin(angle));
    Body &body = add_body(scene, BodyType::dynamic, sphere_shape(0.1f), point_of(at));
    body.mass = float(masses[i]);
    body.filter_mask = 0;
    body.orientation = turn_about(Vector::UnitX(), angle);
    Joint joint;
    joint.type = JointType::hinge;
    joint.body_b = i;
    joint.position_a = {double(i), 0, 0};
    joint.position_b = {0, lengths[i], 0};
    scene.joints.push_back(joint);
  }
  Coupling coupling;
  coupling.type = CouplingType::mimic;
  coupling.joint_b = 1;
  coupling.ratio = 2;
  scene.couplings = {coupling};
  const auto inertia = [&](uint32_t i) {
    return moments_of(scene, scene.bodies[i]).x() + masses[i] * lengths[i] * lengths[i];
  };
  const double whole = inertia(0) + inertia(1) / 4;
  const auto acceleration = [&](double q) {
    return (-masses[0] * 10 * lengths[0] * std::sin(q) - masses[1] * 10 * lengths[1] / 2 * std::sin(q / 2)) / whole;
  };
  std::vector<double> errors;
  for (const double step : {1.0 / 120, 1.0 / 240, 1.0 / 480}) {
    World world(scene, stiff_settings(step), in_double);
    double q = start, v = 0;
    for (int k = 0; k < std::lround(1 / step); ++k) {
      world.step();
      const int parts = 20; /* velocity Verlet */
      for (int part = 0; part < parts; ++part) {
        const double h = step / parts, before = acceleration(q);
        q += h * v + 0.5 * h * h * before;
        v += 0.5 * h * (before + acceleration(q));
      }
    }
    const auto turn = world.precise_bodies()[0].orientation;
    errors.push_back(2 * std::atan2(turn[0], turn[3]) - q);
    CHECK(worst_error(world) < 0.15 * step);
  }
  CAPTURE(errors[0], errors[1], errors[2]);
  CHECK(std::abs(errors[0]) < 0.03);
  CHECK(falls_with_first_order(errors));
}

TEST_CASE("couplings: a mimic follows in each coordinate that a joint leaves free", "[physics]")
{
  struct Follower {
    JointType type;
    JointCoordinate coordinate;
    int axis; /* of the motion, turns from 3 */
  };
  const Follower follower = GENERATE(Follower{JointType::ball, JointCoordinate::rotation_x, 3},
                                     Follower{JointType::ball, JointCoordinate::rotation_y, 4},
                                     Follower{JointType::ball, JointCoordinate::rotation_z, 5},
                                     Follower{JointType::cone_twist, JointCoordinate::rotation_y, 4},
                                     Follower{JointType::plane, JointCoordinate::direction_y, 1},
                                     Follower{JointType::cylindrical, JointCoordinate::direction_x, 0},
                                     Follower{JointType::six_dof, JointCoordinate::direction_z, 2});
  Scene scene = empty_scene({0, 0, 0});
  for (const double x : {0.0, 5.0}) add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {x, 0, 0});
  connect(scene, follower.type, no_body, 0, {0, 0, 0});
  connect(scene, JointType::hinge, no_body, 1, {5, 0, 0});
  scene.joints[1].rotations[0] = {.target_position = 0.6f, .stiffness = 20, .damping = 5};
  Coupling coupling;
  coupling.type = CouplingType::mimic;
  coupling.joint_b = 1;
  coupling.coordinate_a = follower.coordinate;
  coupling.ratio = -1.5f;
  coupling.offset = 0.1f;
  scene.couplings = {coupling};
  World world(scene, {}, {"serial", {}, false});
  run(world, 300);
  const PreciseBodyState state = world.precise_bodies()[0];
  const auto &q = state.orientation;
  const int axis = follower.axis;
  const double value = axis < 3 ? state.position[size_t(axis)] : 2 * std::atan2(q[size_t(axis - 3)], q[3]);
  const auto &led = world.precise_bodies()[1].orientation;
  const double angle = 2 * std::atan2(led[0], led[3]);
  CHECK(angle == Approx(0.6).epsilon(0.02));
  CHECK(std::abs(value) == Approx(0.1 + 1.5 * angle).epsilon(1e-4)); /* a cone has no sign */
  CHECK(worst_error(world) < 1e-4);
}

TEST_CASE("couplings: a gear that is overloaded skips a tooth, and meshes again", "[physics]")
{
  Pair pair(20, 30);
  World world(pair.scene, {}, {});
  TurnCounter turns(world);
  world.add_impulse(world.id_of(0), {.angular_impulse = {100, 0, 0}}); /* against wheel 1, by far too hard */
  for (int k = 0; k < 10; ++k) {
    world.step();
    turns.note();
  }
  run(world, 120);
  CHECK(worst_error(world) < 1e-3);
  CHECK(20 * spin_of(world, 0) + 30 * spin_of(world, 1) == Approx(0).margin(0.05 * std::abs(20 * spin_of(world, 0))));
}

TEST_CASE("couplings: more than there are colours hold at one body", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  add_wheel(scene, 0.5, {0, 0, 0}, 20);
  add_axle(scene, no_body, 0);
  for (uint32_t i = 1; i <= 70; ++i) {
    add_wheel(scene, 0.1, {0, 1.0 * i, 0}, 0.2);
    add_axle(scene, no_body, i);
    scene.couplings.push_back(gear(0, i, 50, i % 2 ? 10 : 12));
  }
  scene.joints[0].rotations[0] = {.target_velocity = 2, .motor = true};
  World world(scene, {}, {});
  run(world, 240);
  for (uint32_t i = 1; i <= 70; ++i) CHECK(spin_of(world, i) == Approx(-2.0 * 50 / (i % 2 ? 10 : 12)).epsilon(1e-3));
  CHECK(worst_error(world) < 1e-3);
}
