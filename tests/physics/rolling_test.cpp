/* Rolling and spinning friction against closed forms.
 *
 * A ball of radius R that rolls without slipping, with sliding force F and resisting torque c m g:
 *     m v' = -F,  (2/5) m R^2 w' = F R - c m g,  v' = R w'    so    v' = -(5/7) c g / R.
 * For a ball that spins on a point about the normal: (2/5) m R^2 w' = -c m g. */
#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr float radius = 0.5f;

uint32_t add_rolling_material(Scene &scene, float rolling, float spinning)
{
  const uint32_t material = add_material(scene, 0.8f);
  scene.materials[material].rolling_friction = rolling;
  scene.materials[material].spinning_friction = spinning;
  return material;
}

Scene balls_on_floor(float rolling, float spinning)
{
  Scene scene = empty_scene();
  scene.materials.clear();
  add_rolling_material(scene, rolling, spinning);
  add_ground(scene);
  return scene;
}

Body &add_ball(Scene &scene, float z)
{
  return add_body(scene, BodyType::dynamic, sphere_shape(radius), {0, radius, z});
}

const std::vector<Solver> solvers_with_rolling{Solver::soft_step, Solver::pgs, Solver::nncg};

} // namespace

TEST_CASE("a rolling ball slows down by 5/7 of its coefficient times g over its radius, and stops", "[physics]")
{
  for (const Solver solver : solvers_with_rolling) {
    CAPTURE(solver);
    Scene scene = balls_on_floor(0.02f, 0);
    const double deceleration = 5.0 / 7 * double(0.02f) * gravity / radius, speed = 1;
    for (double angle : {0.0, 30.0, 45.0}) { /* a disc: no direction rolls easier */
      Body &ball = add_ball(scene, 3.0f * float(scene.bodies.size()));
      const Vector along(std::cos(angle * radians), 0, std::sin(angle * radians));
      ball.linear_velocity = vec3_of(speed * along);
      ball.angular_velocity = vec3_of(Vector(0, 1, 0).cross(along) * speed / radius);
    }
    World world(scene, settings_for(solver));
    run(world, 120);
    for (size_t i = 1; i <= 3; ++i) {
      const Vector v = vector_of(world.bodies()[i].linear_velocity), w = vector_of(world.bodies()[i].angular_velocity);
      INFO("ball " << i << ": speed " << v.norm() << " after 2 s, theory " << speed - 2 * deceleration);
      CHECK(v.norm() == Approx(speed - 2 * deceleration).epsilon(0.01));
      CHECK((v - radius * w.cross(Vector(0, 1, 0))).norm() < 0.01 * v.norm());
    }
    run(world, 120); /* v / a = 3.5 s */
    const Vector stopped_at = vector_of(world.bodies()[1].position);
    CHECK(stopped_at.x() == Approx(speed * speed / (2 * deceleration)).epsilon(0.02));
    run(world, 60);
    CHECK((vector_of(world.bodies()[1].position) - stopped_at).norm() < 1e-3);
  }
}

TEST_CASE("a ball stays on a slope below atan of coefficient over radius, and rolls down a steeper one", "[physics]")
{
  for (const Solver solver : solvers_with_rolling) {
    CAPTURE(solver);
    const float coefficient = 0.05f;
    Scene scene = balls_on_floor(coefficient, 0);
    scene.bodies.clear();
    const double critical = std::atan(coefficient / radius), angles[] = {0.8 * critical, 1.5 * critical};
    for (double angle : angles) {
      const float z = 3.0f * float(scene.bodies.size());
      Body &ramp = add_body(scene, BodyType::fixed, box_shape(20, 0.5f, 1), {0, 0, z});
      ramp.orientation = turn_about({0, 0, 1}, angle);
      add_body(scene, BodyType::dynamic, sphere_shape(radius),
               point_of((0.5 + radius) * Vector(-std::sin(angle), std::cos(angle), 0) + Vector(0, 0, z)));
    }
    World world(scene, settings_for(solver));
    const std::vector<BodyState> start = world.bodies();
    run(world, 120);
    const auto moved = [&](size_t i) {
      return (vector_of(world.bodies()[i].position) - vector_of(start[i].position)).norm();
    };
    const double expected =
        0.5 * 4 * 5.0 / 7 * gravity * (std::sin(angles[1]) - coefficient / radius * std::cos(angles[1]));
    INFO("below the angle it moved " << moved(1) << " m, above " << moved(3) << " m, theory " << expected);
    CHECK(moved(1) < 0.01);
    CHECK(moved(3) == Approx(expected).epsilon(0.03));
  }
}

TEST_CASE("a spinning ball loses 5/2 of its coefficient times g over its radius squared, and stops", "[physics]")
{
  for (const Solver solver : solvers_with_rolling) {
    CAPTURE(solver);
    Scene scene = balls_on_floor(0, 0.01f);
    add_ball(scene, 0).angular_velocity = {0, 2, 0};
    add_ball(scene, 3).angular_velocity = {0, -2, 0};
    World world(scene, settings_for(solver));
    const double deceleration = 2.5 * double(0.01f) * gravity / (double(radius) * radius);
    run(world, 60);
    CHECK(world.bodies()[1].angular_velocity[1] == Approx(2 - deceleration).epsilon(0.01));
    CHECK(world.bodies()[2].angular_velocity[1] == Approx(deceleration - 2).epsilon(0.01));
    run(world, 80);
    for (size_t i : {1, 2}) CHECK(vector_of(world.bodies()[i].angular_velocity).norm() < 1e-3);
  }
}

TEST_CASE("without spinning friction a ball spins on, and without rolling friction it rolls on", "[physics]")
{
  for (const Solver solver : solvers_with_rolling) {
    CAPTURE(solver);
    Scene scene = balls_on_floor(0.02f, 0);
    add_ball(scene, 0).angular_velocity = {0, 2, 0};
    World spinning(scene, settings_for(solver));
    run(spinning, 120);
    CHECK(spinning.bodies()[1].angular_velocity[1] == Approx(2).epsilon(1e-4));

    Scene other = balls_on_floor(0, 0.01f);
    Body &ball = add_ball(other, 0);
    ball.linear_velocity = {1, 0, 0};
    ball.angular_velocity = {0, 0, -1 / radius};
    World rolling(other, settings_for(solver));
    run(rolling, 120);
    CHECK(rolling.bodies()[1].linear_velocity[0] == Approx(1).epsilon(1e-3));
  }
}

TEST_CASE("rolling friction combines as friction does", "[physics]")
{
  Scene scene = balls_on_floor(0.01f, 0);
  const uint32_t rough = add_rolling_material(scene, 0.04f, 0);
  const auto roll = [&](Combine rule) {
    scene.materials[rough].friction_combine = rule;
    Scene one = scene;
    Body &ball = add_ball(one, 0);
    ball.material = rough;
    ball.linear_velocity = {2, 0, 0};
    ball.angular_velocity = {0, 0, -2 / radius};
    World world(one);
    run(world, 60);
    return (2 - world.bodies()[1].linear_velocity[0]) / (5.0 / 7 * gravity / radius);
  };
  CHECK(roll(Combine::geometric_mean) == Approx(0.02).epsilon(0.02));
  CHECK(roll(Combine::maximum) == Approx(0.04).epsilon(0.02));
  CHECK(roll(Combine::average) == Approx(0.025).epsilon(0.02));
}

TEST_CASE("a scene without rolling friction has neither its kernels nor its buffers", "[physics]")
{
  const auto rolls = [](World &world) {
    const std::vector<Kernel> kernels = world.kernels();
    return std::count_if(kernels.begin(), kernels.end(), [](Kernel kernel) {
      return std::string(row_of(kernel).name).find("rolling") != std::string::npos;
    });
  };
  World plain(balls_on_floor(0, 0)), rolling(balls_on_floor(0.1f, 0));
  CHECK(rolls(plain) == 0);
  CHECK(plain.memory().bytes(Buffer::constraint_rolling) + plain.memory().bytes(Buffer::cached_rolling_impulse) == 0);
  CHECK(rolls(rolling) > 0);
  CHECK(rolling.memory().bytes(Buffer::constraint_rolling) > 0);
}
