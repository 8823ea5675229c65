/* Joints of avbd: momentum and energy, singular starts, and how far chains open. What it shares with other solvers is
 * in solvers_joints_test.cpp. */
#include <tandem/metrics.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

double kinetic_and_potential_energy(World &world)
{
  double energy = world.statistics().kinetic_energy;
  for (size_t i = 0; i < world.scene().bodies.size(); ++i)
    energy += double(world.scene().bodies[i].mass) * gravity * world.precise_bodies()[i].position[1];
  return energy;
}

} // namespace

TEST_CASE("solvers with joints: avbd keeps more of the momentum with more iterations", "[physics]")
{
  const auto lost = [](uint32_t iterations, JointType type) {
    Settings settings = settings_for(Solver::avbd);
    settings.iterations = iterations;
    Random random(7);
    World world(tumbling_pair(random, type), settings, on_serial);
    const Momentum start = momentum_of(world);
    run(world, 200);
    const Momentum now = momentum_of(world);
    return std::max((now.linear - start.linear).norm() / start.linear_scale,
                    (now.angular - start.angular).norm() / start.angular_scale);
  };
  double few = 0, many = 0;
  for (const JointType type : all_joint_types) {
    few = std::max(few, lost(10, type));
    many = std::max(many, lost(80, type));
  }
  CHECK(many < 0.5 * few);
}

/* Euler's method with the impulses along where the joint was is Verlet's, which keeps the swing; where it will be, the
 * swing would lose half of its energy in six seconds. */
TEST_CASE("solvers with joints: a pendulum of avbd keeps its swing", "[physics]")
{
  Scene scene = empty_scene();
  const double angle = 0.6;
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {std::sin(angle), -std::cos(angle), 0});
  connect(scene, JointType::ball, no_body, 0, Vector::Zero());
  World world(scene, settings_for(Solver::avbd), on_serial);
  double highest = 0;
  for (int k = 0; k < 1200; ++k) {
    world.step();
    const Point p = world.precise_bodies()[0].position;
    if (k >= 1000) highest = std::max(highest, std::atan2(std::abs(p[0]), -p[1]));
  }
  CHECK(highest == Approx(angle).epsilon(0.01));
}

/* Limbs turn by a radian in a step after the impact, at 20 m/s. */
TEST_CASE("solvers with joints: people of avbd who fall from 20 m come to rest, with their joints closed", "[physics]")
{
  World world(load_scene("ragdolls:n=2,height=20"), settings_for(Solver::avbd), on_serial);
  run(world, 400);
  CHECK(world.statistics().kinetic_energy < 0.05);
  CHECK(open_joints(world).max_distance < 0.002);
}

/* Three bars on four hinges, a parallelogram: cranks at the origin and 2 m beside it, in line, at 5 rad/s. */
TEST_CASE("solvers with joints: a loop of avbd keeps its energy where its bars are in line", "[physics]")
{
  const double spin = 5;
  Scene scene = empty_scene({0, 0, 0});
  for (const double x : {0.0, 2.0}) {
    Body &crank = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f), {x + 0.5, 0, 0});
    crank.linear_velocity = {0, float(0.5 * spin), 0};
    crank.angular_velocity = {0, 0, float(spin)};
  }
  add_body(scene, BodyType::dynamic, box_shape(1, 0.05f, 0.05f), {2, 0, 0}).linear_velocity = {0, float(spin), 0};
  for (Body &body : scene.bodies) body.filter_mask = 0;
  connect(scene, JointType::hinge, no_body, 0, {0, 0, 0}, Vector::UnitZ());
  connect(scene, JointType::hinge, no_body, 1, {2, 0, 0}, Vector::UnitZ());
  connect(scene, JointType::hinge, 0, 2, {1, 0, 0}, Vector::UnitZ());
  connect(scene, JointType::hinge, 1, 2, {3, 0, 0}, Vector::UnitZ());
  World world(scene, settings_for(Solver::avbd), on_serial);
  const double start = world.statistics().kinetic_energy;
  run(world, 600);
  CHECK(world.statistics().kinetic_energy == Approx(start).epsilon(0.01));
}

/* 0.18 rad a step, which the frames have from where both bodies turn as one. */
TEST_CASE("solvers with joints: what spins freely on a joint of avbd does not gain energy", "[physics]")
{
  for (const JointType type : {JointType::ball, JointType::hinge, JointType::cylindrical, JointType::cone_twist}) {
    CAPTURE(name_of_type(type));
    const Vector spin(4, 6, 8), apart(1, 0.4, 0.2);
    Scene scene = empty_scene({0, 0, 0});
    for (const double k : {0.0, 1.0}) {
      Body &body = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.4f), point_of(k * apart));
      body.angular_velocity = vec3_of(spin);
      body.linear_velocity = vec3_of(k * spin.cross(apart));
      body.filter_mask = 0;
    }
    connect(scene, type, 0, 1, 0.5 * apart, {1, 1, 1});
    World world(scene, settings_for(Solver::avbd), on_serial);
    const double start = world.statistics().kinetic_energy;
    run(world, 400);
    CHECK(world.statistics().kinetic_energy < 1.2 * start); /* four times of it before penalties knew their load */
  }
}

/* Ten bars end to end, fixed to one another and to the world. */
TEST_CASE("solvers with joints: a beam of avbd holds its own weight", "[physics]")
{
  Scene scene = empty_scene();
  for (uint32_t k = 0; k < 10; ++k) {
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.15f), {k + 0.5, 0, 0}).filter_mask = 0;
    scene.bodies.back().mass = 1;
    connect(scene, JointType::fixed, k == 0 ? no_body : k - 1, k, {double(k), 0, 0});
  }
  World world(scene, settings_for(Solver::avbd), on_serial);
  double widest = 0;
  for (int k = 0; k < 400; ++k) {
    world.step();
    widest = std::max(widest, open_joints(world).max_distance);
  }
  CHECK(widest < 0.01);
  CHECK(std::abs(kinetic_and_potential_energy(world)) <
        0.02 * 10 * gravity * 5); /* of what it has to give as it falls */
}

namespace {

/* A bar of 1 kg that turns, with a hundred times its mass on the same joint at its end; the most energy that both have
 * in 60 steps, J, of which they begin with less than 1. */
double most_energy_of(Joint joint, uint32_t iterations)
{
  joint.position_b = {-0.5, 0, 0};
  Scene scene = empty_scene();
  for (uint32_t k = 0; k < 2; ++k) {
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.15f), {0.5 + k, 0, 0});
    body.mass = k == 0 ? 1 : 100;
    if (k == 0) body.angular_velocity = {1, 2, 3};
    body.filter_mask = 0;
    joint.body_a = k == 0 ? no_body : 0;
    joint.body_b = k;
    joint.position_a = {k == 0 ? 0 : 0.5, 0, 0};
    scene.joints.push_back(joint);
  }
  Settings settings = settings_for(Solver::avbd);
  settings.iterations = iterations;
  World world(scene, settings, on_serial);
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    world.step();
    most = std::max(most, kinetic_and_potential_energy(world));
  }
  return most;
}

} // namespace

/* The axis of a cone is anywhere at 0. */
TEST_CASE("solvers with joints: a cone of avbd whose angle must stay 0 gives no energy", "[physics]")
{
  Joint joint;
  joint.type = JointType::cone_twist;
  joint.rotations[0].lower = joint.rotations[0].upper = joint.rotations[1].upper = 0;
  CHECK(most_energy_of(joint, 10) < 200); /* of some 2,000 J of the load as it falls */
  CHECK(most_energy_of(joint, 50) < 200);
}

/* What snaps taut gives no more than the load as it falls by the lengths of both; it should give nothing. */
TEST_CASE("solvers with joints: rods of avbd whose ends begin in one place do not throw what they hold", "[physics]")
{
  Joint joint;
  joint.type = JointType::distance;
  joint.directions[0].lower = joint.directions[0].upper = 1;
  CHECK(most_energy_of(joint, 10) < 2 * 100 * gravity);
  CHECK(most_energy_of(joint, 50) < 2 * 100 * gravity);
}

/* Eight metres and 3 rad: gaps close with 10 m/s, and so do angles with 10 rad/s. */
TEST_CASE("solvers with joints: frames of avbd that begin far apart come together without a blow", "[physics]")
{
  for (const JointType type :
       {JointType::ball, JointType::fixed, JointType::hinge, JointType::slider, JointType::universal}) {
    CAPTURE(name_of_type(type));
    Scene scene = empty_scene({0, 0, 0});
    for (int k = 0; k < 2; ++k)
      add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.4f), {0, 0, 0}).filter_mask = 0;
    connect(scene, type, 0, 1, {0.5, 0.2, 0.1}, {1, 1, 1});
    scene.bodies[1].position = {6, -7, 4};
    scene.bodies[1].orientation = turn_about(Vector(1, -2, 2).normalized(), 3);
    World world(scene, settings_for(Solver::avbd), on_serial);
    double highest = 0;
    for (int k = 0; k < 300; ++k) {
      world.step();
      highest = std::max(highest, fastest(world));
    }
    CHECK(highest < 12);
    CHECK(open_joints(world).max_distance < 0.05);
  }
}

/* A thousand times a link: 9,904 N at the top. */
TEST_CASE("solvers with joints: avbd holds a ton on a chain of links of a kilogram", "[physics]")
{
  for (const JointType type : {JointType::ball, JointType::hinge, JointType::fixed}) {
    CAPTURE(name_of_type(type));
    Scene scene = hanging_boxes(8, 1, type);
    add_body(scene, BodyType::dynamic, sphere_shape(0.4f), {0, -8.5, 0}).mass = 1000;
    connect(scene, type, 7, 8, {0, -7.5, 0});
    World world(scene, settings_for(Solver::avbd), on_serial), soft(scene, settings_for(Solver::soft_step), on_serial);
    run(world, 600);
    run(soft, 600);
    double widest = 0, force = 0;
    for (int k = 0; k < 60; ++k) {
      world.step();
      widest = std::max(widest, open_joints(world).max_distance);
      force += double(world.read_joint(world.id_of_joint(0)).force[1]) / 60;
    }
    CHECK(widest < 3e-3);
    CHECK(open_joints(soft).max_distance > 20 * widest);
    CHECK(force == Approx(1008 * gravity).epsilon(0.02));
  }
}

TEST_CASE("solvers with joints: a chain of avbd opens less with more iterations", "[physics]")
{
  const auto open_after = [](uint32_t iterations) {
    Settings settings = settings_for(Solver::avbd);
    settings.iterations = iterations;
    World world(hanging_boxes(12, 2), settings, on_serial);
    run(world, 5);
    return open_joints(world).max_distance;
  };
  const double few = open_after(5), some = open_after(20), many = open_after(80);
  CHECK(some < 0.5 * few);
  CHECK(many < 0.5 * some);
}
