/* Capsules by tests of their own: they roll as closed forms say, rest beside each other at any small angle, and gain no
 * energy from a plane that they hit while they turn. */
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

TEST_CASE("capsules: one that rolls on a half-space keeps its speed and its height")
{
  Scene scene;
  add_ground(scene);
  add_dynamic_body(scene, capsule_shape(0.25f, 0.5f), {0, 0.25, 0}, turn_about({1, 0, 0}, pi / 2));
  scene.bodies[1].linear_velocity = {1, 0, 0};
  scene.bodies[1].angular_velocity = {0, 0, -4};
  World world(scene, {}, {"serial", {}, false});
  for (int step = 0; step < 120; ++step) world.step();
  const BodyState state = world.bodies()[1];
  CHECK(state.position[0] == Approx(2).epsilon(0.001));
  CHECK(state.position[1] == Approx(0.25).margin(0.006)); /* the slop */
  CHECK(std::abs(state.position[2]) < 1e-4);
  CHECK(state.linear_velocity[0] == Approx(1).epsilon(0.001));
}

/* The normal between two long axes that are nearly parallel must not come from rounding. */
TEST_CASE("capsules: two that lie side by side, nearly parallel, stay at rest", "[physics]")
{
  for (const double angle : {0.0, 1e-5, 1e-4, 0.0005, 0.0012, 0.0015, 0.0019, 0.0025, 0.01, 0.03}) {
    Scene scene;
    add_ground(scene);
    add_dynamic_body(scene, capsule_shape(0.1f, 0.5f), {0, 0.1, 0}, turn_about({1, 0, 0}, pi / 2));
    const Eigen::Quaterniond turn = Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector::UnitY())) *
                                    Eigen::Quaterniond(Eigen::AngleAxisd(pi / 2, Vector::UnitX()));
    add_dynamic_body(scene, capsule_shape(0.1f, 0.5f), {0.204 + 0.5 * angle, 0.1, 0},
                     {float(turn.x()), float(turn.y()), float(turn.z()), float(turn.w())});
    World world(scene, {}, {"serial", {}, false});
    double fastest = 0;
    for (int step = 0; step < 60; ++step) {
      world.step();
      for (const BodyState &state : world.bodies())
        fastest = std::max(fastest, vector_of(state.linear_velocity).norm());
    }
    CAPTURE(angle);
    CHECK(fastest < 1e-4);
  }
}

TEST_CASE("capsules: thrown at a half-space while they turn fast they gain no energy", "[physics]")
{
  Random random(7);
  Scene scene;
  add_ground(scene);
  const Shape shape = capsule_shape(0.1f, 0.5f);
  for (int k = 0; k < 800; ++k) {
    Body &body =
        add_dynamic_body(scene, shape, {20.0 * (k % 40), random.uniform(0.61, 0.9), 20.0 * (k / 40)}, any_turn(random));
    body.mass = 1;
    body.linear_velocity = {float(random.uniform(-5, 5)), -20, 0};
    body.angular_velocity = vec3_of(direction(random) * 200);
  }
  const Vec3 moments = inertia_of(shape, 1);
  const auto energy_of = [&](const BodyState &state) {
    const Vector spin = axes_of(state.orientation).transpose() * vector_of(state.angular_velocity),
                 momentum = spin.cwiseProduct(Vector(moments[0], moments[1], moments[2]));
    return 0.5 * vector_of(state.linear_velocity).squaredNorm() + 0.5 * spin.dot(momentum) +
           gravity * state.position[1];
  };
  World world(scene, {}, {"tbb", {}, false});
  const std::vector<BodyState> before = world.bodies();
  double most = 0, least = 1;
  for (int step = 0; step < 6; ++step) {
    world.step();
    const std::vector<BodyState> after = world.bodies();
    for (size_t k = 1; k < before.size(); ++k) {
      most = std::max(most, energy_of(after[k]) / energy_of(before[k]));
      least = std::min(least, energy_of(after[k]) / energy_of(before[k]));
    }
  }
  CHECK(most < 1.02);
  CHECK(least < 0.5); /* they did hit it */
}

TEST_CASE("capsules: on a box they lie still, along it, across it and over its edge", "[physics]")
{
  for (const double around : {0.0, 0.3, pi / 4, pi / 2})
    for (const double shift : {0.0, 0.55, 0.95}) {
      Scene scene;
      Body &table = add_dynamic_body(scene, box_shape(1, 0.25f, 0.7f), {0, 0, 0});
      table.type = BodyType::fixed;
      const Eigen::Quaterniond turn = Eigen::Quaterniond(Eigen::AngleAxisd(around, Vector::UnitY())) *
                                      Eigen::Quaterniond(Eigen::AngleAxisd(pi / 2, Vector::UnitZ()));
      const Vector axis = turn * Vector::UnitY(), at = shift * (axis.cwiseAbs().x() > 0.5 ? axis : Vector(1, 0, 0));
      if (std::abs(at.z()) > 0.6) continue;
      add_dynamic_body(scene, capsule_shape(0.1f, 0.5f), {at.x(), 0.35, at.z()},
                       {float(turn.x()), float(turn.y()), float(turn.z()), float(turn.w())});
      World world(scene, {}, {"serial", {}, false});
      double fastest = 0;
      for (int step = 0; step < 120; ++step) {
        world.step();
        if (step >= 30) fastest = std::max(fastest, vector_of(world.bodies()[1].linear_velocity).norm());
      }
      CAPTURE(around, shift);
      CHECK(fastest < 1e-4);
      CHECK(world.bodies()[1].position[1] == Approx(0.35).margin(0.006)); /* the slop */
    }
}

TEST_CASE("capsules: thrown at a thin box while they turn few pass it, and none gains energy", "[physics]")
{
  Random random(9);
  Scene scene;
  scene.gravity = {0, 0, 0};
  Body &sheet = add_dynamic_body(scene, box_shape(500, 0.01f, 500), {0, 0, 0});
  sheet.type = BodyType::fixed;
  const Shape shape = capsule_shape(0.1f, 0.3f);
  for (int k = 0; k < 400; ++k) {
    Body &body = add_dynamic_body(scene, shape, {20.0 * (k % 20) - 200, random.uniform(0.5, 3), 20.0 * (k / 20) - 200},
                                  any_turn(random));
    body.linear_velocity = {float(random.uniform(-5, 5)),
                            float(-std::exp(random.uniform(std::log(5.0), std::log(300.0)))), 0};
    body.mass = 1;
    body.angular_velocity = vec3_of(direction(random) * random.uniform(0, 100));
  }
  World world(scene, {}, {"tbb", {}, false});
  const auto energy_of = [&](const BodyState &state) {
    const Vec3 moments = inertia_of(shape, 1);
    const Vector spin = axes_of(state.orientation).transpose() * vector_of(state.angular_velocity);
    return 0.5 * vector_of(state.linear_velocity).squaredNorm() +
           0.5 * spin.dot(spin.cwiseProduct(Vector(moments[0], moments[1], moments[2])));
  };
  const std::vector<BodyState> before = world.bodies();
  for (int step = 0; step < 60; ++step) world.step();
  const std::vector<BodyState> after = world.bodies();
  size_t passed = 0, struck = 0;
  double most = 0;
  for (size_t k = 1; k < before.size(); ++k) {
    passed += after[k].position[1] < 0;
    struck += after[k].linear_velocity[1] > -1;
    most = std::max(most, energy_of(after[k]) / energy_of(before[k]));
  }
  CHECK(100 * passed < before.size());
  CHECK(passed + struck == before.size() - 1);
  CHECK(most < 1.01);
}
