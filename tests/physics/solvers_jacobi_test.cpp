/* The solver jacobi: the tests of every solver, and convergence to the solution with more iterations. */
#include "host/catalog/catalog.h"
#include "host/pipeline/solvers/solvers.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Settings jacobi(uint32_t iterations = 0)
{
  Settings settings = settings_for(Solver::jacobi);
  if (iterations > 0) settings.iterations = iterations;
  return settings;
}

/* Boxes on slopes a little below and above the angle of friction, side by side. */
Scene inclines(const std::vector<double> &coefficients, double beside_the_cone)
{
  Scene scene = empty_scene();
  for (double mu : coefficients)
    for (int side : {-1, 1}) {
      const double angle = std::atan(mu) + side * beside_the_cone;
      const uint32_t material = add_material(scene, float(mu));
      const float z = 2.0f * float(scene.bodies.size());
      Body &ramp = add_body(scene, BodyType::fixed, box_shape(10, 0.5f, 0.6f), {0, 0, z});
      ramp.orientation = turn_about({0, 0, 1}, angle);
      ramp.material = material;
      const Vector place = 0.65 * Vector(-std::sin(angle), std::cos(angle), 0) + Vector(0, 0, z);
      Body &box = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.15f, 0.5f), point_of(place));
      box.orientation = turn_about({0, 0, 1}, angle);
      box.material = material;
    }
  return scene;
}

} // namespace

TEST_CASE("jacobi: a stack of ten stands still", "[physics]")
{
  World world(load_scene("box-stack:n=10"), jacobi());
  const std::vector<BodyState> start = world.bodies();
  run(world, 300);
  const std::vector<BodyState> now = world.bodies();
  for (size_t i = 0; i < now.size(); ++i)
    CHECK((vector_of(now[i].position) - vector_of(start[i].position)).norm() < 0.01);
  CHECK(world.statistics().max_penetration < 0.005);
  CHECK(world.statistics().kinetic_energy < 1e-6);
}

TEST_CASE("jacobi: a falling block of boxes stays bounded", "[physics]")
{
  World world(load_scene("box-grid:nx=4,ny=8,nz=4"), jacobi());
  const auto highest = [&] {
    double height = 0;
    for (const BodyState &state : world.bodies()) height = std::max(height, state.position[1]);
    return height;
  };
  const float start = highest();
  double deepest = 0;
  for (int i = 0; i < 30; ++i) {
    run(world, 20);
    deepest = std::max(deepest, world.statistics().max_penetration);
    CHECK(highest() < start + 0.1f); /* a box that tips lifts its centre a little */
  }
  const Statistics statistics = world.statistics();
  INFO("penetration " << deepest << ", mean " << statistics.mean_penetration << ", energy at last "
                      << statistics.kinetic_energy);
  CHECK(all_finite(world.bodies()));
  CHECK(deepest < 0.02);
  CHECK(statistics.mean_penetration < 0.001);
  CHECK(statistics.kinetic_energy < 0.1);
}

TEST_CASE("jacobi: free fall is exact", "[physics]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {0, 100, 0}).linear_velocity = {1, 2, 0};
  World world(scene, jacobi());
  run(world, 60);
  const BodyState state = world.bodies()[0];
  CHECK(state.position[0] == Approx(1).epsilon(1e-5));
  CHECK(state.position[1] == Approx(100 + 2 - 0.5 * gravity).epsilon(1e-5));
  CHECK(state.linear_velocity[1] == Approx(2 - gravity).epsilon(1e-5));
}

TEST_CASE("jacobi: a box slides past the angle of friction and accelerates as it should", "[physics]")
{
  const std::vector<double> coefficients = {0.1, 0.3, 0.6, 1.0};
  const double beside = 2 * radians;
  World world(inclines(coefficients, beside), jacobi());
  run(world, 60);
  const std::vector<BodyState> states = world.bodies();
  for (size_t k = 0; k < coefficients.size(); ++k) {
    const double mu = coefficients[k], angle = std::atan(mu) + beside;
    const double held = vector_of(states[4 * k + 1].linear_velocity).norm(),
                 sliding = vector_of(states[4 * k + 3].linear_velocity).norm();
    CAPTURE(mu, held, sliding);
    CHECK(held < 1e-3);
    CHECK(sliding == Approx(gravity * (std::sin(angle) - mu * std::cos(angle))).epsilon(0.03));
  }
}

TEST_CASE("jacobi: balls return to e squared of their height", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  const std::vector<float> coefficients = {0.3f, 0.5f, 0.8f, 1.0f};
  for (float e : coefficients) {
    const uint32_t material = add_material(scene, 0.5f, e);
    Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.25f), {2.0f * float(scene.bodies.size()), 2.25f, 0});
    ball.material = material;
  }
  World world(scene, jacobi());
  std::vector<double> highest(coefficients.size(), 0);
  std::vector<bool> bounced(coefficients.size(), false);
  for (int i = 0; i < 110; ++i) { /* the second impact of the slowest comes later */
    world.step();
    const std::vector<BodyState> states = world.bodies();
    for (size_t k = 0; k < coefficients.size(); ++k) {
      const BodyState &state = states[k + 1];
      if (state.linear_velocity[1] > 0) bounced[k] = true;
      if (bounced[k]) highest[k] = std::max(highest[k], double(state.position[1]) - 0.25);
    }
  }
  for (size_t k = 0; k < coefficients.size(); ++k) {
    CAPTURE(coefficients[k]);
    CHECK(highest[k] == Approx(2 * coefficients[k] * coefficients[k]).epsilon(0.03));
  }
}

/* A column that is let go without impulses of a last step: after the step it should stand. */
TEST_CASE("jacobi: more iterations leave less of the error", "[physics]")
{
  const Scene scene = load_scene("box-stack:n=6");
  double last = 10;
  for (uint32_t iterations : {1u, 4u, 16u, 64u}) {
    World world(scene, jacobi(iterations));
    world.step();
    const double error = fastest(world);
    CAPTURE(iterations, error, last);
    CHECK(error < last);
    last = error;
  }
  CHECK(last < 1e-6);
}
