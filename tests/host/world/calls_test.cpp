/* The calls of a program to bodies: impulses, forces, velocities and poses, against closed forms. */
#include <algorithm>
#include <cmath>

#include <tandem/module.h>
#include <tandem/world.h>

#include "tests/catch.h"

using namespace tandem;

namespace {

/* A ball and a slab without gravity, far from each other. */
Scene free_bodies()
{
  Scene scene;
  scene.name = "free bodies";
  scene.gravity = {0, 0, 0};
  scene.shapes = {sphere_shape(0.5f), box_shape(1, 0.2f, 0.5f)};
  scene.bodies.resize(2);
  scene.bodies[0].mass = 2;
  scene.bodies[1].shape = 1;
  scene.bodies[1].mass = 3;
  scene.bodies[1].position = {100, 0, 0};
  return scene;
}

Vec3 cross(const Vec3 &a, const Vec3 &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

} // namespace

TEST_CASE("an impulse at a point changes both velocities by its laws", "[sanitizer]")
{
  World world(free_bodies(), {}, {"serial", {}});
  const BodyId slab = world.id_of(1);
  const Vec3 impulse{0.3f, -1.2f, 0.7f};
  const Point point{100.5, 0.1, -0.25};
  world.add_impulse(slab, {impulse, {}, point});
  const BodyState state = world.read_body(slab);
  const Vec3 inertia = inertia_of(world.scene().shapes[1], 3), moment = cross({0.5f, 0.1f, -0.25f}, impulse);
  for (size_t k = 0; k < 3; ++k) {
    CHECK(state.linear_velocity[k] == Approx(impulse[k] / 3).epsilon(1e-6));
    CHECK(state.angular_velocity[k] == Approx(moment[k] / inertia[k]).epsilon(1e-5));
  }
  world.add_impulse(slab, {{}, {0, 2, 0}});
  CHECK(world.read_body(slab).angular_velocity[1] == Approx(state.angular_velocity[1] + 2 / inertia[1]).epsilon(1e-6));
}

TEST_CASE("calls to one body take effect in their order", "[sanitizer]")
{
  World world(free_bodies(), {}, {"serial", {}});
  const BodyId ball = world.id_of(0);
  world.add_impulse(ball, {{2, 0, 0}});
  world.set_velocity(ball, {{0, 5, 0}, {0, 0, 1}});
  world.add_impulse(ball, {{0, 0, 4}});
  BodyState state = world.read_body(ball);
  CHECK(state.linear_velocity == Vec3{0, 5, 2});
  CHECK(state.angular_velocity == Vec3{0, 0, 1});
  state.position = {7, 8, 9};
  world.set_state(ball, state);
  CHECK(world.bodies()[0].position == Point{7, 8, 9});
  world.set_body(0, {}); /* the older call for one body keeps its place among the others */
  world.add_impulse(ball, {{2, 0, 0}});
  CHECK(world.read_body(ball).linear_velocity == Vec3{1, 0, 0});
}

TEST_CASE("a constant force moves a body on the parabola of its closed form, to rounding", "[sanitizer]")
{
  for (const Solver solver : choices<Solver>()) {
    CAPTURE(solver);
    Scene scene = free_bodies();
    scene.gravity = {0, -10, 0};
    World world(scene, settings_for(solver), {"serial", {}});
    const BodyId ball = world.id_of(0);
    constexpr int steps = 120;
    for (int k = 0; k < steps; ++k) {
      world.add_force(ball, {{3, 1, -2}});
      world.add_force(ball, {{3, 1, -2}}); /* they add up: acceleration 3, 1, -2 */
      world.step();
    }
    const double t = steps / 60.0;
    const BodyState state = world.read_body(ball);
    CHECK(state.position[0] == Approx(0.5 * 3 * t * t).epsilon(1e-5));
    CHECK(state.position[1] == Approx(0.5 * (1 - 10) * t * t).epsilon(1e-5));
    CHECK(state.position[2] == Approx(0.5 * -2 * t * t).epsilon(1e-5));
    CHECK(state.linear_velocity[0] == Approx(3 * t).epsilon(1e-5));
    world.step(); /* a force lasts for one step */
    CHECK(world.read_body(ball).linear_velocity[0] == state.linear_velocity[0]);
    CHECK(world.bodies()[1].position[0] == 100);
  }
}

TEST_CASE("a torque about a principal axis spins a body up at its closed form", "[sanitizer]")
{
  World world(free_bodies(), {}, {"serial", {}});
  const BodyId slab = world.id_of(1);
  const float inertia = inertia_of(world.scene().shapes[1], 3)[1];
  for (int k = 0; k < 60; ++k) {
    world.add_force(slab, {{}, {0, 0.5f, 0}});
    world.step();
  }
  CHECK(world.read_body(slab).angular_velocity[1] == Approx(0.5 / inertia).epsilon(1e-5));
  /* A force beside the centre has the moment of its arm. */
  World other(free_bodies(), {}, {"serial", {}});
  other.add_force(other.id_of(1), {{0, 0, 1}, {}, Point{101, 0, 0}});
  other.step();
  CHECK(other.bodies()[1].angular_velocity[1] == Approx(-1.0 / inertia / 60).epsilon(1e-4));
  CHECK(other.bodies()[1].linear_velocity[2] == Approx(1.0 / 3 / 60).epsilon(1e-5));
}

TEST_CASE("a force is held by friction up to the cone, and moves a box beyond it", "[sanitizer]")
{
  Scene scene;
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f)};
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0.5f;
  scene.bodies.resize(2);
  scene.bodies[0].type = BodyType::fixed;
  scene.bodies[1].shape = 1;
  scene.bodies[1].position = {0, 0.5, 0};
  for (const float pull : {4.5f, 5.5f}) {
    World world(scene, {}, {"serial", {}});
    for (int k = 0; k < 60; ++k) {
      world.add_force(world.id_of(1), {{pull, 0, 0}, {}, Point{world.bodies()[1].position[0], 0.01, 0}});
      world.step();
    }
    const double way = world.bodies()[1].position[0];
    if (pull < 5) CHECK(std::abs(way) < 1e-3);
    else CHECK(way == Approx(0.5 * 0.5).epsilon(0.05)); /* a = 5.5 - 5 */
  }
}

TEST_CASE("a kinematic body reaches its pose, and pushes what stands in its way", "[sanitizer]")
{
  Scene scene;
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f)};
  scene.bodies.resize(3);
  scene.bodies[0].type = BodyType::fixed;
  for (const size_t k : {1u, 2u}) scene.bodies[k].shape = 1;
  scene.bodies[1].type = BodyType::kinematic;
  scene.bodies[1].position = {-1.2, 0.5, 0};
  scene.bodies[2].position = {0, 0.5, 0};
  World world(scene, {}, {"serial", {}});
  const float half = std::sqrt(0.5f);
  Pose target{{-1.2, 0.5, 0}, {0, 0, 0, 1}};
  for (int k = 0; k < 60; ++k) {
    target.position[0] += 0.02;
    world.move_to(world.id_of(1), target);
    world.step();
    REQUIRE(world.bodies()[1].position[0] == Approx(target.position[0]).margin(1e-6));
  }
  CHECK(world.bodies()[2].position[0] == Approx(target.position[0] + 1).margin(0.02));
  world.move_to(world.id_of(1), {{0, 5, 0}, {0, half, 0, half}});
  world.step();
  const BodyState state = world.bodies()[1];
  CHECK(state.position[1] == Approx(5).epsilon(1e-6));
  CHECK(state.orientation[1] * state.orientation[1] == Approx(0.5).epsilon(1e-5));
  CHECK(state.orientation[3] * state.orientation[1] == Approx(0.5).epsilon(1e-5));
}

TEST_CASE("fixed bodies ignore pushes, and a scene without forces has no stage of forces", "[sanitizer]")
{
  Scene scene = free_bodies();
  scene.bodies[0].type = BodyType::fixed;
  World world(scene, {}, {"serial", {}});
  const auto launches_forces = [&] {
    const std::vector<Kernel> kernels = world.kernels();
    return std::find(kernels.begin(), kernels.end(), kernel_named("apply_forces")) != kernels.end();
  };
  CHECK_FALSE(launches_forces());
  CHECK(world.buffer_bytes(buffer_named("body_force")) == 0);
  const BodyId stone = world.id_of(0);
  world.add_impulse(stone, {{1, 2, 3}, {4, 5, 6}});
  world.set_velocity(stone, {{1, 2, 3}, {4, 5, 6}});
  world.add_force(stone, {{1, 2, 3}, {4, 5, 6}});
  CHECK(launches_forces());
  world.step();
  CHECK(world.read_body(stone).position == Point{0, 0, 0});
  CHECK(world.read_body(stone).linear_velocity == Vec3{0, 0, 0});
}
