/* Joints that only the solver direct holds. What it shares with other solvers is in solvers_joints_test.cpp. */
#include <tandem/metrics.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

TEST_CASE("solvers with joints: direct holds what soft joints let go", "[physics]")
{
  Scene scene = hanging_boxes(8, 2);
  add_body(scene, BodyType::dynamic, sphere_shape(0.4f), {0, -8.5, 0}).mass = 2000; /* 1,000 times a link */
  connect(scene, JointType::ball, 7, 8, {0, -7.5, 0});
  World soft(scene, settings_for(Solver::soft_step), on_serial), direct(scene, settings_for(Solver::direct), on_serial);
  run(soft, 240);
  run(direct, 240);
  /* each link's joints give way by a ten-thousandth of the speed that a substep of the load gives it */
  const double h = 1.0 / 240, load = 2016 * gravity;
  CHECK(open_joints(direct).max_distance <
        1e-4 * load / 2 * 4 * h * h / Softness(settings_for(Solver::direct)).rate / h);
  CHECK(open_joints(soft).max_distance > 20 * open_joints(direct).max_distance);
}

TEST_CASE("solvers with joints: what direct solves", "[physics]")
{
  Scene free = hanging_boxes(60, 2);
  for (Joint &joint : free.joints) joint.type = JointType::six_dof; /* holds nothing */
  World loose(free, settings_for(Solver::direct), on_serial);
  loose.step();
  CHECK(loose.statistics().direct_islands == 0);
  CHECK(loose.statistics().direct_left == 0);
  World people(load_scene("ragdolls:n=3,height=0"), settings_for(Solver::direct), on_serial);
  people.step();
  CHECK(people.statistics().direct_islands == 3);
  CHECK(people.statistics().direct_left == 0);
}

/* What a motor cannot move stops it: the ground, a limit of another joint, its own largest speed. */
TEST_CASE("solvers with joints: direct has motors that are weaker than what holds", "[physics]")
{
  const auto bar_on_motor = [](double height, float speed) {
    Scene scene = empty_scene();
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f), {0.5, height, 0});
    connect(scene, JointType::hinge, no_body, 0, {0, height, 0}, Vector::UnitZ());
    scene.joints[0].rotations[0] = {.target_velocity = speed, .motor = true};
    return scene;
  };
  const auto after = [](const Scene &scene) {
    auto world = std::make_unique<World>(scene, settings_for(Solver::direct), on_serial);
    run(*world, 300);
    return world;
  };
  for (const float most : {JointAxis::unlimited, 1e9f, 1e4f}) {
    CAPTURE(most);
    Scene on_ground = bar_on_motor(0.5, -2);
    add_ground(on_ground);
    on_ground.joints[0].rotations[0].max_force = most;
    const auto pressed = after(on_ground);
    /* its far lower edge is on the ground: 0.5 = sin a + 0.05 cos a */
    const auto q = pressed->precise_bodies()[0].orientation;
    CHECK(2 * std::atan2(q[2], q[3]) == Approx(-0.474).margin(0.02));
    CHECK(open_joints(*pressed).max_distance < 0.01);
    Scene limited = bar_on_motor(5, 10);
    connect(limited, JointType::hinge, no_body, 0, {0, 5, 0}, Vector::UnitZ());
    limited.joints[0].rotations[0].max_force = most;
    limited.joints[1].rotations[0] = {.lower = -0.5f, .upper = 0.5f};
    const auto stopped = after(limited);
    const auto turned = stopped->precise_bodies()[0].orientation;
    CHECK(2 * std::atan2(turned[2], turned[3]) == Approx(0.5).margin(0.01));
    CHECK(std::abs(stopped->precise_bodies()[0].angular_velocity[2]) < 0.2);
  }
  Scene slow = bar_on_motor(5, 10);
  slow.gravity = {0, 0, 0};
  slow.joints[0].rotations[0].max_speed = 5;
  const auto spinning = after(slow);
  CHECK(spinning->precise_bodies()[0].angular_velocity[2] == Approx(5).epsilon(1e-4));
  World soft(slow, settings_for(Solver::soft_step), on_serial); /* has a torque that its speed limit takes back */
  run(soft, 300);
  CHECK(std::abs(spinning->read_joint(spinning->id_of_joint(0)).torque[2]) <
        1.01 * std::abs(soft.read_joint(soft.id_of_joint(0)).torque[2]));
}

TEST_CASE("solvers with joints: direct holds thin rods", "[physics]")
{
  for (const float half_width : {0.01f, 0.001f, 0.0005f}) {
    CAPTURE(half_width);
    Scene scene = empty_scene();
    add_body(scene, BodyType::dynamic, box_shape(1, half_width, half_width), {1, 0, 0});
    connect(scene, JointType::fixed, no_body, 0, Vector::Zero());
    add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {2, 0, 0}).mass = 10;
    connect(scene, JointType::fixed, 0, 1, {2, 0, 0});
    World world(scene, settings_for(Solver::direct), on_serial);
    run(world, 120);
    CHECK(std::abs(world.precise_bodies()[1].position[1]) < 1e-4);
  }
}
