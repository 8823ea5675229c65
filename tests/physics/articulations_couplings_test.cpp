/* Couplings of two joints of one articulation against closed forms and dense matrices in double precision: gears,
 * mimics, ropes. */
#include <tandem/articulations.h>
#include <tandem/load_scene.h>
#include <tandem/metrics.h>

#include "host/base/random.h"
#include "tests/catch.h"
#include "tests/physics/articulate.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Coupling mimic_of(uint32_t joint_a, uint32_t joint_b, double ratio, double offset = 0)
{
  Coupling mimic;
  mimic.type = CouplingType::mimic;
  mimic.joint_a = joint_a;
  mimic.joint_b = joint_b;
  mimic.ratio = float(ratio);
  mimic.offset = float(offset);
  return mimic;
}

/* The coordinate and the speed of a hinge or slider. */
std::pair<double, double> coordinate_of_joint(World &world, uint32_t joint)
{
  const JointReading reading = world.read_joint(world.id_of_joint(joint));
  const bool slides = world.scene().joints[joint].type == JointType::slider;
  return slides ? std::pair(double{reading.directions[0]}, double{reading.direction_speeds[0]})
                : std::pair(double{reading.rotations[0]}, double{reading.rotation_speeds[0]});
}

double worst_of_couplings(World &world)
{
  const auto errors = coupling_errors(world.scene(), world.precise_bodies());
  return *std::max_element(errors.begin(), errors.end());
}

const JointAxis &axis_of_joint(const Scene &scene, uint32_t joint)
{
  const Joint &one = scene.joints[joint];
  return one.type == JointType::slider ? one.directions[0] : one.rotations[0];
}

/* Boxes without collisions, joined at random by hinges and sliders, with a force each. */
Scene random_tree(Random &random, uint32_t links, bool is_free)
{
  Scene scene = empty_scene();
  for (uint32_t k = 0; k < links; ++k) {
    const uint32_t parent = k == 0 ? no_body : random.below(k);
    const Vector from = k == 0 ? Vector::Zero() : vector_of(scene.bodies[parent].position), way = direction(random);
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.2f, 0.1f), point_of(from + way));
    body.orientation = any_turn(random);
    body.mass = float(random.uniform(0.5, 3));
    body.filter_mask = 0;
    if (k == 0 && is_free) continue;
    Joint &joint = connect(scene, random.below(2) == 0 ? JointType::hinge : JointType::slider, parent, k,
                           from + 0.5 * way, direction(random));
    (joint.type == JointType::slider ? joint.directions : joint.rotations)[0].force = float(random.uniform(-9, 9));
  }
  articulate(scene, is_free ? 0 : no_body);
  return scene;
}

/* a = M^-1 (f + J^T x) with J a = 0, of one row J. */
Eigen::VectorXd accelerations_with_coupling(const ArticulationTree &tree, const Scene &scene)
{
  const auto size = Eigen::Index(tree.velocities());
  const ArticulationState state = tree.state();
  std::vector<double> forces(size_t(size), 0.0);
  for (const ArticulationLink &link : tree.links())
    if (link.velocities == 1) forces[link.first_velocity] = double{axis_of_joint(scene, link.joint).force};
  const std::vector<double> free = tree.forward_dynamics(state, forces), mass = tree.mass_matrix(state);
  const Eigen::MatrixXd m = Eigen::Map<const Eigen::MatrixXd>(mass.data(), size, size);
  const Coupling &coupling = scene.couplings[0];
  Eigen::VectorXd row = Eigen::VectorXd::Zero(size);
  for (const ArticulationLink &link : tree.links()) {
    if (link.joint == coupling.joint_a) row[link.first_velocity] += 1;
    if (link.joint == coupling.joint_b) row[link.first_velocity] += double{coupling.ratio};
  }
  const Eigen::VectorXd pushed = m.ldlt().solve(row), a = Eigen::Map<const Eigen::VectorXd>(free.data(), size);
  return a - pushed * (row.dot(a) / row.dot(pushed));
}

/* A carrier with two wheels about x whose axles are 0.5 m apart; ratio: of the teeth of the second to the first. */
Scene wheels_on_carrier(bool is_free, double ratio)
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.5f, 0.2f), {0, 0, 0}).mass = 4;
  for (const double y : {-0.25, 0.25}) {
    add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0.3, y, 0}).mass = y < 0 ? 2 : 3;
    connect(scene, JointType::hinge, 0, uint32_t(scene.bodies.size() - 1), {0.3, y, 0}, Vector::UnitX());
  }
  for (Body &body : scene.bodies) body.filter_mask = 0;
  if (!is_free) connect(scene, JointType::fixed, no_body, 0, {0, 0, 0});
  articulate(scene, is_free ? 0 : no_body);
  Coupling &gear = scene.couplings.emplace_back();
  gear.joint_b = 1;
  gear.teeth_a = ratio < 1 ? 20 : 10;
  gear.teeth_b = int(std::lround(ratio * gear.teeth_a));
  return scene;
}

} // namespace

TEST_CASE("a coupled tree accelerates as dense matrices say, wherever its joints are", "[articulations]")
{
  Random random(11);
  for (int round = 0; round < 20; ++round) {
    const uint32_t links = 2 + random.below(7);
    Scene scene = random_tree(random, links, round % 2 == 0 && links > 2);
    const auto joints = uint32_t(scene.joints.size()), a = random.below(joints),
               b = (a + 1 + random.below(joints - 1)) % joints;
    scene.couplings = {mimic_of(a, b, random.uniform(0.3, 3) * (random.below(2) == 0 ? -1 : 1))};
    CAPTURE(round, links, a, b);
    const ArticulationTree tree(scene, scene.articulations[0], "test");
    const Eigen::VectorXd expected = accelerations_with_coupling(tree, scene);
    Settings settings;
    settings.substeps = 1;
    settings.step = 1e-4f;
    World world(scene, settings, {"serial", {}});
    world.step();
    double scale = 0;
    for (const ArticulationLink &link : tree.links())
      if (link.velocities == 1) scale = std::max(scale, std::abs(expected[link.first_velocity]));
    for (const ArticulationLink &link : tree.links()) {
      if (link.velocities != 1) continue;
      const double speed = coordinate_of_joint(world, link.joint).second;
      CHECK(std::abs(speed / 1e-4 - expected[link.first_velocity]) < 2e-3 * scale);
    }
  }
}

TEST_CASE("a motor turns both wheels of a coupled tree with the moment of inertia that both have", "[articulations]")
{
  const double ratio = GENERATE(-2.0, 0.5, 1.0);
  Scene scene = wheels_on_carrier(false, ratio);
  scene.joints[0].rotations[0].force = 0.2f;
  World world(scene, {}, {"serial", {}});
  const double one = 0.4 * 2 * 0.04, other = 0.4 * 3 * 0.04;         /* 2/5 m r^2 */
  const double acceleration = 0.2 / (one + other / (ratio * ratio)); /* the other turns by -1 / ratio */
  for (int step = 1; step <= 120; ++step) {
    world.step();
    const double a = coordinate_of_joint(world, 0).second, b = coordinate_of_joint(world, 1).second;
    REQUIRE(std::abs(a - acceleration * step / 60) < 1e-5 * acceleration * step / 60);
    REQUIRE(std::abs(a + ratio * b) < 1e-5 * std::abs(a));
    REQUIRE(worst_of_couplings(world) < 1e-4);
  }
}

TEST_CASE("couplings change neither momentum nor its moment in a free tree", "[articulations]")
{
  Scene scene = wheels_on_carrier(true, -1.5);
  scene.joints[0].rotations[0] = {.target_velocity = 20, .motor = true, .max_force = 1};
  for (Body &body : scene.bodies) body.linear_velocity = {1, 2, 3};
  World world(scene, {}, {"serial", {}});
  const auto moments = [&] {
    Vector linear = Vector::Zero(), angular = Vector::Zero();
    for (size_t k = 0; k < 3; ++k) {
      const BodyState body = world.bodies()[k];
      const Vector v = vector_of(body.linear_velocity), at = vector_of(world.precise_bodies()[k].position);
      linear += double{scene.bodies[k].mass} * v;
      angular += double{scene.bodies[k].mass} * at.cross(v);
      const Eigen::Matrix3d axes = eigen_of(body.orientation).toRotationMatrix();
      angular +=
          axes * moments_of(scene, scene.bodies[k]).asDiagonal() * axes.transpose() * vector_of(body.angular_velocity);
    }
    return std::pair(linear, angular);
  };
  const auto [linear, angular] = moments();
  run(world, 300);
  const auto [linear_now, angular_now] = moments();
  CHECK(std::abs(coordinate_of_joint(world, 0).second) > 5); /* the motor has turned them */
  CHECK(worst_of_couplings(world) < 1e-3);
  CHECK((linear_now - linear).norm() < 1e-5 * linear.norm());
  CHECK((angular_now - angular).norm() < 1e-3); /* of 0.4 in a wheel, 20 m from the origin */
}

/* Two fingers slide along x, away from each other, and one of them carries a load. */
TEST_CASE("fingers of a tree that mimic each other share a load of one of them", "[articulations]")
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.1f, 0.1f), {0, 0, 0}).mass = 5;
  connect(scene, JointType::fixed, no_body, 0, {0, 0, 0});
  for (const double side : {-1, 1}) {
    Body &finger = add_body(scene, BodyType::dynamic, box_shape(0.02f, 0.1f, 0.02f), {0.1 * side, 0.2, 0});
    finger.mass = 0.1f;
    finger.filter_mask = 0;
    Joint &joint = connect(scene, JointType::slider, 0, uint32_t(scene.bodies.size() - 1), {0.1 * side, 0.2, 0},
                           side * Vector::UnitX());
    joint.directions[0] = {.target_position = 0.03f, .stiffness = 2000, .damping = 20};
  }
  articulate(scene);
  scene.couplings = {mimic_of(1, 2, -1)};
  scene.joints[2].directions[0].force = -40; /* N: both springs hold it, 1 cm each */
  World world(scene, {}, {"serial", {}});
  run(world, 240);
  const double a = coordinate_of_joint(world, 1).first, b = coordinate_of_joint(world, 2).first;
  CHECK(std::abs(a - 0.02) < 1e-4);
  CHECK(std::abs(b - 0.02) < 1e-4);
  CHECK(std::abs(a - b) < 2e-5);
}

/* Atwood's machine as a tree: two weights on rails, by a rope over a pulley. */
TEST_CASE("a rope between two sliders of a tree pulls, and does not push", "[articulations]")
{
  Scene scene = empty_scene();
  for (const double mass : {1.0, 3.0}) {
    add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {mass, 0, 0}).mass = float(mass);
    scene.bodies.back().filter_mask = 0;
  }
  connect(scene, JointType::slider, no_body, 0, {1, 0, 0}, -Vector::UnitY());
  connect(scene, JointType::slider, 0, 1, {3, 0, 0}, -Vector::UnitY());
  articulate(scene);
  Coupling &rope = scene.couplings.emplace_back();
  rope.type = CouplingType::pulley;
  rope.joint_b = 1;
  rope.offset = 0.5f;
  World world(scene, {}, {"serial", {}});
  double longest = 0;
  for (int step = 0; step < 240; ++step) {
    world.step();
    longest = std::max(longest, coordinate_of_joint(world, 0).first + coordinate_of_joint(world, 1).first);
  }
  /* The rope holds the second weight, which moves by q_a + q_b, so the first one falls freely along it. */
  CHECK(longest < 0.5 + 5e-5);
  CHECK(coordinate_of_joint(world, 0).first == Approx(0.5 * gravity * 16).epsilon(0.005));
  CHECK(coordinate_of_joint(world, 1).first == Approx(0.5 - 0.5 * gravity * 16).epsilon(0.005));
}

TEST_CASE("couplings of a tree that contradict each other pull without exploding", "[articulations]")
{
  Scene scene = wheels_on_carrier(true, 1);
  scene.couplings = {mimic_of(0, 1, -1, 0.5), mimic_of(0, 1, -1, -0.5), mimic_of(1, 0, -3, 1)};
  World world(scene, {}, {"serial", {}});
  for (int step = 0; step < 600; ++step) world.step();
  CHECK(world.quarantined().empty());
  for (const uint32_t joint : {0u, 1u}) CHECK(std::abs(coordinate_of_joint(world, joint).second) < 30);
}

/* Sliders on a rail that all follow the first, which is light and is pushed. */
TEST_CASE("many joints that follow a light one accelerate by the mass of all", "[articulations]")
{
  const uint32_t followers = GENERATE(4u, 8u, 12u);
  const float driver = GENERATE(0.2f, 1.0f);
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(1, 0.1f, 0.1f), {0, 0, 0}).mass = 5;
  connect(scene, JointType::fixed, no_body, 0, {0, 0, 0});
  for (uint32_t k = 0; k <= followers; ++k) {
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {0.3 * k, 1, 0});
    body.mass = k == 0 ? driver : 1.0f;
    body.filter_mask = 0;
    connect(scene, JointType::slider, 0, uint32_t(scene.bodies.size() - 1), {0.3 * k, 1, 0}, Vector::UnitX());
    if (k > 0) scene.couplings.push_back(mimic_of(k + 1, 1, -1));
  }
  articulate(scene);
  scene.joints[1].directions[0].force = 1;
  World world(scene, {}, {"serial", {}});
  run(world, 600);
  const double expected = 10.0 / (double{driver} + followers);
  for (uint32_t joint = 1; joint <= followers + 1; ++joint)
    CHECK(coordinate_of_joint(world, joint).second == Approx(expected).epsilon(0.02));
  CHECK(worst_of_couplings(world) < 0.01);
}

/* A finger of equal links whose joints each follow the one before, against a stop and its weight. */
TEST_CASE("a finger whose joints follow each other comes to rest", "[articulations]")
{
  for (const uint32_t links : {3u, 4u, 6u}) {
    Scene scene = empty_scene();
    for (uint32_t k = 0; k < links; ++k) {
      add_body(scene, BodyType::dynamic, box_shape(0.05f, 0.01f, 0.01f), {0.05 + 0.1 * k, 0, 0}).mass = 0.1f;
      scene.bodies.back().filter_mask = 0;
      Joint &joint = connect(scene, JointType::hinge, k == 0 ? no_body : k - 1, k, {0.1 * k, 0, 0}, Vector::UnitZ());
      joint.rotations[0].damping = 0.01f;
      if (k > 0) scene.couplings.push_back(mimic_of(k, k - 1, -1));
    }
    scene.joints[0].rotations[0].lower = -0.5f;
    scene.joints[0].rotations[0].upper = 0.5f;
    articulate(scene);
    World world(scene, {}, {"serial", {}});
    run(world, 600);
    CAPTURE(links);
    double fastest = 0;
    for (uint32_t joint = 0; joint < links; ++joint)
      fastest = std::max(fastest, std::abs(coordinate_of_joint(world, joint).second));
    CHECK(fastest < 0.5);
    CHECK(worst_of_couplings(world) < (links <= 4 ? 0.006 : 0.08));
    CHECK(coordinate_of_joint(world, 0).first == Approx(-0.5).margin(0.05));
  }
}

TEST_CASE("a gripper of a robot's file closes both of its fingers in reduced coordinates", "[articulations]")
{
  const Scene scene =
      load_scene(TANDEM_SOURCE_DIR "/tests/scenes/arm.urdf", OutsideFiles::refused, Coordinates::reduced);
  REQUIRE(scene.couplings.size() == 1);
  REQUIRE(scene.articulations.size() == 1);
  World world(scene, {}, {"serial", {}});
  double worst = 0;
  for (int step = 0; step < 300; ++step) {
    world.step();
    worst = std::max(worst, worst_of_couplings(world));
  }
  CHECK(worst < 1e-4);
}
