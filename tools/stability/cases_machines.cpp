/* cases_machines.cpp - the group of cases of joints that drive, turn fast, or close loops: motors, gears, wheels, rods.
 */
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tandem/metrics.h>

#include "host/catalog/catalog.h"
#include "tools/stability/joints.h"

namespace tandem::stability {
namespace {

constexpr double a_degree = pi / 180;

/* Of a speed to which each substep adds the same. */
Bound speeding_up_by_rounding(const Trial &trial)
{
  const double substeps = double(trial.steps) * trial.settings.substeps;
  return Bound::from_rounding(substeps * 0x1p-23,
                              fmt::format("{:.0f} substeps, in each the spacing of floats", substeps));
}

/* A bar of a metre and 1 kg on a hinge about z at the origin. */
Scene bar_on_hinge(const Vec3 &gravity = {0, 0, 0})
{
  Scene scene = empty_scene(gravity);
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f), {0.5, 0, 0});
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  return scene;
}

Trial motor_limit_trial(float torque, double beyond, Length length)
{
  Trial trial = trial_of(bar_on_hinge(), steps_for(length, 300, 300));
  JointAxis &axis = trial.scene.joints[0].rotations[0];
  axis.motor = true;
  axis.max_force = torque;
  axis.target_velocity = 10;
  axis.lower = -1;
  axis.upper = 1;
  if (torque == JointAxis::unlimited) trial.documented_solver = name_of(Solver::direct);
  else trial.documented = with_stiff_joints(16);
  trial.checks.push_back(at_end(check("beyond the limit at the end", "rad", beyond, beyond_limit(0, 3, 1))));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", speed_from_rounding(trial), speed())));
  return trial;
}

/* --- gears: wheels about z, side by side ------------------------------------------------------------------------ */

uint32_t add_wheel(Scene &scene, double radius, double mass, const Vector &at)
{
  Body &body = add_body(scene, BodyType::dynamic, cylinder_shape(float(radius), 0.05f), point_of(at), float(mass));
  body.orientation = turn_about(Vector::UnitX(), pi / 2);
  body.filter_mask = 0;
  const auto wheel = uint32_t(scene.bodies.size() - 1);
  connect(scene, JointType::hinge, no_body, wheel, at, Vector::UnitZ());
  return wheel;
}

void add_mesh(Scene &scene, uint32_t joint_a, uint32_t joint_b, int32_t teeth_a, int32_t teeth_b)
{
  Coupling mesh;
  mesh.joint_a = joint_a;
  mesh.joint_b = joint_b;
  mesh.teeth_a = teeth_a;
  mesh.teeth_b = teeth_b;
  scene.couplings.push_back(mesh);
}

/* Motors of 10 and of 3 N m on wheels that brake with 4. */
Trial motor_friction_trial(Length length)
{
  Trial trial = trial_of(empty_scene({0, 0, 0}), steps_for(length, 60, 60));
  const double radius = 0.5, mass = 8, moment = 0.5 * mass * radius * radius;
  for (const auto &[torque, z] : {std::pair(10.0f, 0.0), std::pair(3.0f, 1.0)}) {
    add_wheel(trial.scene, radius, mass, {0, 0, z});
    trial.scene.joints.back().rotations[0] = {
        .target_velocity = 1000, .motor = true, .max_force = torque, .friction = 4};
  }
  const double acceleration = (10 - 4) / moment;
  trial.checks.push_back(
      at_end(check("error of the speed of the stronger", "", speeding_up_by_rounding(trial), [=](const Moment &now) {
        return std::abs(double(now.bodies[0].angular_velocity[2]) / (acceleration * now.time) - 1);
      })));
  trial.checks.back().from = 0.1;
  trial.checks.push_back(check("speed of the weaker", "rad/s", 0,
                               [](const Moment &now) { return std::abs(double(now.bodies[1].angular_velocity[2])); }));
  return trial;
}

/* A motor of 20 N m turns the first of 50 wheels. */
Trial train_trial(Length length)
{
  const uint32_t wheels = 50;
  const double torque = 20, moment = 0.5 * 0.2 * 0.2;
  const auto teeth_of = [](uint32_t wheel) { return wheel % 3 == 0 ? 24 : wheel % 3 == 1 ? 18 : 21; };
  Trial trial = trial_of(empty_scene({0, 0, 0}), steps_for(length, 1800, 1800));
  for (uint32_t i = 0; i < wheels; ++i) {
    add_wheel(trial.scene, 0.2, 1, {0.4 * i, 0, 0});
    if (i > 0) add_mesh(trial.scene, i - 1, i, teeth_of(i - 1), teeth_of(i));
  }
  JointAxis &axis = trial.scene.joints[0].rotations[0];
  axis.motor = true;
  axis.target_velocity = 5;
  axis.max_force = float(torque);
  const double ratio = -double(teeth_of(0)) / teeth_of(wheels - 1); /* each wheel turns the other way round */
  trial.checks.push_back(at_end(check(
      "turn that the last wheel lost", "rad",
      Bound::from_rounding(2 * pi * 0x1p-23 * (wheels - 1), "spacing of floats of a whole turn, at each of 49 meshes"),
      [first = turns_about(0, Vector::UnitZ()), last = turns_about(wheels - 1, Vector::UnitZ()),
       ratio](const Moment &now) { return std::abs(last(now) - ratio * first(now)); })));
  /* While the motor speeds the train up, a mesh bears its torque times the teeth so far, and gives by M (1 + r^2) / (J
   * w^2), with r the ratio of teeth of the two wheels. */
  double softest = 0;
  for (uint32_t i = 0; i + 1 < wheels; ++i) {
    const double of_mesh = double(teeth_of(i + 1)) / teeth_of(i), borne = torque * teeth_of(i) / teeth_of(0);
    softest = std::max(softest, borne * (1 + of_mesh * of_mesh) / moment * JointSoftness({}).stretch);
  }
  trial.checks.push_back(check("farthest out of mesh", "rad", softest, coupling_slack()));
  return trial;
}

/* Three gears of 10:1, a drum of 10 cm and a load of a ton on a slider: what the drum bears is 1,000 N m. */
Trial reduction_trial(Length length)
{
  const double drum = 0.1, load = 1000, mass = 25, radius = 0.4, speed = 10, moment = 0.5 * mass * radius * radius;
  Trial trial = trial_of(empty_scene(), steps_for(length, 600, 600));
  Scene &scene = trial.scene;
  for (uint32_t i = 0; i < 4; ++i) {
    add_wheel(scene, radius, mass, {double(i), 0, 0});
    if (i > 0) add_mesh(scene, i - 1, i, 20, 200);
  }
  scene.joints[0].rotations[0].motor = true; /* of a torque without bound */
  scene.joints[0].rotations[0].target_velocity = float(speed);
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {3 + drum, -2, 0}, float(load)).filter_mask = 0;
  connect(scene, JointType::slider, no_body, 4, {3 + drum, -2, 0}, -Vector::UnitY());
  Coupling rope;
  rope.type = CouplingType::rack_and_pinion;
  rope.joint_a = 3;
  rope.joint_b = 4;
  rope.teeth_a = 20;
  rope.travel = float(2 * pi * drum);
  scene.couplings.push_back(rope);
  /* The drum turns by -speed / 1000, and the load goes down along its slider by drum times that: it rises. Each mesh
   * gives by torque over J w^2 of what is geared, here as ways of the load, once for the start and once at rest. */
  const double way_of_drum = load * drum * standard_gravity * (1 / moment + 100 / moment) / 100 +
                             load * drum * standard_gravity * (1 / moment + drum * drum / load);
  const double gives = 2 * drum * way_of_drum * JointSoftness({}).stretch;
  trial.checks.push_back(check("load from where the motor brings it", "m", gives, [=](const Moment &now) {
    return std::abs(double(now.bodies[4].position[1]) + 2 - drum * speed / 1000 * now.time);
  }));
  trial.checks.push_back(check("farthest out of mesh", "rad", pi / 20, coupling_slack())); /* half a tooth */
  return trial;
}

/* Weights of a ton and of 1 kg on a rope over a pulley without mass. */
Trial pulley_trial(Length length)
{
  const double heavy = 1000, light = 1, start = 5;
  Trial trial = trial_of(empty_scene(), steps_for(length, 45, 45));
  for (const auto &[mass, z] : {std::pair(heavy, 0.0), std::pair(light, 3.0)}) {
    add_body(trial.scene, BodyType::dynamic, sphere_shape(0.1f), {0, -start, z}, float(mass)).filter_mask = 0;
    Joint &joint =
        connect(trial.scene, JointType::distance, no_body, uint32_t(trial.scene.bodies.size() - 1), {0, 0, z});
    joint.position_b = {0, 0, 0};
  }
  Coupling rope;
  rope.type = CouplingType::pulley;
  rope.joint_b = 1;
  rope.offset = float(2 * start);
  trial.scene.couplings.push_back(rope);
  const double fall = standard_gravity * (heavy - light) / (heavy + light);
  trial.checks.push_back(
      at_end(check("error of the speed", "", speeding_up_by_rounding(trial), [fall](const Moment &moment) {
        return std::abs(double(moment.bodies[0].linear_velocity[1]) / (-fall * moment.time) - 1);
      })));
  trial.checks.back().from = 0.1;
  /* The rope bears 2 g times the lighter weight, which is all that gives way. */
  trial.checks.push_back(
      check("rope longer by", "m", 2 * 2 * standard_gravity * JointSoftness({}).stretch, coupling_slack()));
  return trial;
}

/* --- what turns fast -------------------------------------------------------------------------------------------- */

/* Two bodies, half a metre to each side of the origin, that turn about it at 100 rad/s. */
Scene spinning_pair(const Shape &shape)
{
  const double spin = 100;
  Scene scene = empty_scene({0, 0, 0});
  for (const double x : {-0.5, 0.5}) {
    Body &body = add_body(scene, BodyType::dynamic, shape, {x, 0, 0});
    body.linear_velocity = {0, float(spin * x), 0};
    body.angular_velocity = {0, 0, float(spin)};
  }
  let_pass(scene);
  return scene;
}

void add_spin_checks(Trial &trial)
{
  trial.checks.push_back(check("drift of angular momentum", "", 1e-5, angular_momentum_drift()));
  trial.checks.push_back(check("drift of energy", "", 0.01, kinetic_energy_drift()));
}

Trial locked_trial(Length length)
{
  Trial trial = trial_of(spinning_pair(box_shape(0.5f, 0.2f, 0.1f)), steps_for(length, 300, 300));
  Joint &joint = connect(trial.scene, JointType::six_dof, 0, 1, Vector::Zero());
  joint.held_directions = joint.held_rotations = {true, true, true};
  trial.documented = with_stiff_joints(64);
  trial.checks.push_back(check("joint open by", "m", 0.005, joint_opening()));
  trial.checks.push_back(check("joint turned by", "rad",
                               Bound::from_rounding(8 * 0x1p-23, "spacing of the eight floats of two orientations"),
                               joint_angle()));
  add_spin_checks(trial);
  return trial;
}

Trial rod_trial(Length length)
{
  Trial trial = trial_of(spinning_pair(sphere_shape(0.1f)), steps_for(length, 300, 300));
  Joint rod;
  rod.type = JointType::distance;
  rod.body_a = 0;
  rod.body_b = 1;
  rod.directions[0].lower = rod.directions[0].upper = 1;
  trial.scene.joints.push_back(rod);
  trial.documented = with_stiff_joints(64);
  trial.checks.push_back(check("error of the rod's length", "m", 0.005, [](const Moment &moment) {
    const std::vector<PreciseBodyState> states = moment.world.precise_bodies();
    return std::abs((Vector(states[1].position.data()) - Vector(states[0].position.data())).norm() - 1);
  }));
  add_spin_checks(trial);
  return trial;
}

/* --- a vehicle: a chassis of 1,200 kg on four wheels with springs, which rolls at 100 m/s ----------------------- */

struct Vehicle {
  static constexpr double radius = 0.35, height = 0.55, speed = 100, mass = 1200, stiffness = 4e4;
};

void add_vehicle_wheel(Scene &scene, const Vector &at)
{
  /* x of the frame is up, y along the axle: x, y, z turned on to y, z, x. */
  const Quat turn = turn_about({1, 1, 1}, 2 * pi / 3);
  Body &wheel = add_body(scene, BodyType::dynamic, cylinder_shape(float(Vehicle::radius), 0.1f), point_of(at), 20);
  wheel.orientation = turn;
  wheel.linear_velocity = {float(Vehicle::speed), 0, 0};
  wheel.angular_velocity = {0, 0, float(-Vehicle::speed / Vehicle::radius)};
  const auto index = uint32_t(scene.bodies.size() - 1);
  Joint &joint = connect(scene, JointType::wheel, 1, index, at, eigen_of(turn));
  const double load = Vehicle::mass / 4 * standard_gravity;
  joint.directions[0] = {.lower = -0.2f,
                         .upper = 0.2f,
                         .target_position = float(-load / Vehicle::stiffness),
                         .stiffness = float(Vehicle::stiffness),
                         .damping = 4000};
  joint.rotations[0].lower = joint.rotations[0].upper = 0; /* not steered */
}

Trial vehicle_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 600, 600));
  add_ground(trial.scene);
  Body &chassis =
      add_body(trial.scene, BodyType::dynamic, box_shape(2, 0.3f, 0.6f), {0, Vehicle::height, 0}, float(Vehicle::mass));
  chassis.linear_velocity = {float(Vehicle::speed), 0, 0};
  for (const double x : {-1.3, 1.3})
    for (const double z : {-0.8, 0.8}) add_vehicle_wheel(trial.scene, {x, Vehicle::radius, z});
  trial.documented = with_stiff_joints(16);
  trial.checks.push_back(check("farthest off the line", "m", 0.1,
                               [](const Moment &moment) { return std::abs(double(moment.bodies[1].position[2])); }));
  trial.checks.push_back(check("loss of speed", "", 1e-4, [](const Moment &moment) {
    return std::abs(1 - double(moment.bodies[1].linear_velocity[0]) / Vehicle::speed);
  }));
  trial.checks.push_back(check("chassis up or down by", "m", 0.005, [](const Moment &moment) {
    return std::abs(double(moment.bodies[1].position[1]) - Vehicle::height);
  }));
  trial.checks.push_back(check("farthest open joint", "m", 0.005 * Vehicle::radius, joint_opening()));
  return trial;
}

/* --- limits and loops ------------------------------------------------------------------------------------------- */

/* 1e4 N press the end of a bar against the limit of its cone. */
Trial cone_trial_at_limit(Length length)
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f), {0.5, 0, 0});
  Joint &joint = connect(scene, JointType::cone_twist, no_body, 0, Vector::Zero());
  joint.rotations[0].lower = -0.1f;
  joint.rotations[0].upper = 0.1f;
  joint.rotations[1].upper = 0.5f;
  Trial trial = trial_of(std::move(scene), steps_for(length, 300, 300));
  trial.disturb = [](World &world, uint64_t) {
    const BodyState bar = world.bodies()[0];
    const Vector end = vector_of(bar.position) + axes_of(bar.orientation) * Vector(0.5, 0, 0);
    world.add_force(world.id_of(0), {.force = {0, -1e4f, 0}, .point = point_of(end)});
  };
  trial.documented = with_stiff_joints(32);
  trial.checks.push_back(at_end(check("beyond the limit", "rad", a_degree, beyond_limit(0, 4, 0.5))));
  trial.checks.push_back(at_end(check("joint open by", "m", 0.01, joint_opening())));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", speed_from_rounding(trial), speed())));
  return trial;
}

/* Two cranks of a metre on hinges to the world, `apart` from each other, and a bar that joins their ends: a
 * parallelogram, whose cranks turn at `spin`. */
Scene parallelogram(double angle, double apart, double spin, const Vec3 &gravity)
{
  Scene scene = empty_scene(gravity);
  const Vector arm(std::cos(angle), std::sin(angle), 0), other(apart, 0, 0), across = Vector::UnitZ();
  const Vector speed = spin * across.cross(arm);
  for (const Vector &at : {Vector(Vector::Zero()), other}) {
    Body &crank = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f), point_of(at + 0.5 * arm));
    crank.orientation = turn_about(across, angle);
    crank.linear_velocity = vec3_of(0.5 * speed);
    crank.angular_velocity = {0, 0, float(spin)};
  }
  add_body(scene, BodyType::dynamic, box_shape(float(0.5 * apart), 0.05f, 0.05f), point_of(arm + 0.5 * other))
      .linear_velocity = vec3_of(speed);
  let_pass(scene);
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), across);
  connect(scene, JointType::hinge, no_body, 1, other, across);
  connect(scene, JointType::hinge, 0, 2, arm, across);
  connect(scene, JointType::hinge, 1, 2, arm + other, across);
  return scene;
}

Trial loop_trial(Length length)
{
  Trial trial = trial_of(parallelogram(pi / 2, 2, -1, {0, -10, 0}), steps_for(length, 600, 600));
  trial.checks.push_back(check("tilt of the bar", "rad", 0.1 * a_degree, [](const Moment &moment) {
    return angle_between({0, 0, 0, 1}, moment.world.precise_bodies()[2].orientation);
  }));
  trial.checks.push_back(check("farthest open joint", "m", 0.005, joint_opening()));
  const double scale = 2 * standard_gravity * 2; /* two cranks by 1 m, the bar by 2 */
  trial.checks.push_back(check("gain of energy", "", 0.01, relative_energy_gain(trial.scene, scale)));
  return trial;
}

/* Cranks and bar in one line, where the loop may go on as a parallelogram or crossed: rows of its joints depend on one
 * another there. */
Trial straight_trial(Length length)
{
  Trial trial = trial_of(parallelogram(0, 2, 5, {0, 0, 0}), steps_for(length, 600, 600));
  trial.checks.push_back(check("farthest open joint", "m", 0.005, joint_opening()));
  trial.checks.push_back(check("drift of energy", "", 0.01, kinetic_energy_drift()));
  return trial;
}

/* A person whose joints are all held in place by springs of 1e6 N m/rad, dropped on its feet. */
Trial pose_trial(Length length)
{
  Trial trial = trial_of(load_scene("ragdolls:n=1"), steps_for(length, 600, 600));
  for (Joint &joint : trial.scene.joints) {
    joint.type = JointType::six_dof;
    joint.held_directions = {true, true, true};
    for (JointAxis &axis : joint.rotations) axis = {.stiffness = 1e6f, .damping = 1e3f};
  }
  trial.documented = Settings{};
  trial.documented->iterations = 8;
  trial.checks.push_back(check("farthest from the pose", "rad", a_degree, [](const Moment &moment) {
    double worst = 0;
    for (uint32_t i = 0; i < moment.scene().joints.size(); ++i)
      for (const double angle : moment.world.read_joint(moment.world.id_of_joint(i)).rotations)
        if (std::abs(angle) > worst || std::isnan(angle)) worst = std::abs(angle);
    return worst;
  }));
  trial.checks.push_back(check("farthest open joint", "m", 0.05, joint_opening()));
  trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
  return trial;
}

} // namespace

void add_machine_cases(std::vector<Case> &cases)
{
  const char *group = "machines";
  cases.push_back({"motor-against-limit", group,
                   "a motor of a torque without bound drives a bar at 10 rad/s against a limit",
                   "it ends no more than a tenth of a degree beyond the limit, at rest",
                   [](Length length) { return motor_limit_trial(JointAxis::unlimited, 0.1 * a_degree, length); }});
  cases.push_back({"motor-1e3-against-limit", group, "a motor of 1,000 N m drives a bar of 1 kg against a limit",
                   "it ends no more than a degree beyond the limit, at rest",
                   [](Length length) { return motor_limit_trial(1000, a_degree, length); }});
  cases.push_back({"motor-against-friction", group, "motors of 10 and of 3 N m on wheels that are braked with 4 N m",
                   "one speeds up as (10 - 4) t / J, but for rounding, and the other does not move",
                   motor_friction_trial});
  cases.push_back({"gear-train-50", group, "a motor of 20 N m turns the first of 50 wheels that mesh, for 30 s",
                   "the last one turns by the ratio of their teeth, within the rounding of angles; meshes give no more "
                   "than their softness has it",
                   train_trial});
  cases.push_back({"gear-reduction-1000", group, "three gears of 10:1 and a drum lift a ton at 1 mm/s",
                   "the load is where the motor brings it, but for twice what the meshes give under it; no tooth skips",
                   reduction_trial});
  cases.push_back({"pulley-1000", group, "weights of a ton and of 1 kg on one rope over a pulley",
                   "they fall as Atwood's, but for rounding; the rope gives twice what its softness has it at most",
                   pulley_trial});
  cases.push_back(
      {"locked-spin-100", group, "two bars that a joint of six held axes makes one turn at 100 rad/s",
       "the joint opens by half a percent of a bar at most and turns by rounding alone; angular momentum is "
       "conserved, and energy within a hundredth",
       locked_trial});
  cases.push_back(
      {"rod-spin-100", group, "two balls at the ends of a rod of 1 m turn at 100 rad/s",
       "the rod's length is right within half a percent; angular momentum is conserved, and energy within a "
       "hundredth",
       rod_trial});
  cases.push_back({"vehicle-100", group, "a vehicle of four sprung wheels rolls at 100 m/s for 1 km",
                   "it stays within 10 cm of the line, loses 0.01% of its speed at most, neither bounces nor sinks by "
                   "more than the slop of 5 mm, and opens its joints by half a percent of a wheel at most",
                   vehicle_trial});
  cases.push_back({"cone-limit-1e4", group, "1e4 N at the end of a bar of 1 kg press it against the limit of its cone",
                   "it rests within a degree of the limit, its joint closed within a hundredth of its length",
                   cone_trial_at_limit});
  cases.push_back({"loop-of-four", group, "a parallelogram of four hinges swings through",
                   "the bar stays level within a tenth of a degree, joints open by half a percent of a crank at most; "
                   "energy never grows by a hundredth",
                   loop_trial});
  cases.push_back({"loop-in-line", group,
                   "a parallelogram of four hinges turns through the position where all its bars are in line",
                   "joints open by half a percent of a crank at most, and energy is conserved within a hundredth",
                   straight_trial});
  cases.push_back(
      {"pose-1e6", group, "a person of 14 parts, each held in its pose by 1e6 N m/rad, falls on its feet",
       "each joint keeps its pose within a degree and is open by 5 cm at most, the radius of a limb; energy never "
       "grows",
       pose_trial});
}

} // namespace tandem::stability
