/* Bouncing: a ball dropped from height h returns to e^2 h, whatever the step and the moment of impact. */
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

const std::vector<float> restitutions{0.3f, 0.5f, 0.8f, 1.0f};
const std::vector<float> heights{0.5f, 1.0f, 2.03f, 4.1f, 7.77f};
constexpr float ball_radius = 0.25f;

/* One ball for each restitution and height, far enough apart never to meet. */
Scene drop_test()
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (float e : restitutions) {
    const uint32_t material = add_material(scene, 0.5f, e);
    for (float h : heights)
      add_body(scene, BodyType::dynamic, sphere_shape(ball_radius),
               {2.0f * float(scene.bodies.size()), ball_radius + h, 0})
          .material = material;
  }
  return scene;
}

/* The height a ball in free flight will reach or has reached. */
double flight_height(const BodyState &state)
{
  const double speed = state.linear_velocity[1];
  return state.position[1] - ball_radius + speed * speed / (2 * gravity);
}

/* Heights after the first bounce, 0 for balls that have not bounced. */
std::vector<double> rebound_heights(World &world, int steps)
{
  std::vector<double> rebound(world.scene().bodies.size(), 0.0);
  for (int i = 0; i < steps; ++i) {
    world.step();
    const std::vector<BodyState> states = world.bodies();
    for (size_t k = 1; k < states.size(); ++k)
      if (rebound[k] == 0 && states[k].linear_velocity[1] > 0) rebound[k] = flight_height(states[k]);
  }
  return rebound;
}

} // namespace

TEST_CASE("a ball bounces to e^2 of its height", "[physics]")
{
  const double step = GENERATE(1.0 / 30, 1.0 / 60, 1.0 / 97, 1.0 / 240);
  const uint32_t substeps = GENERATE(1, 4);
  World world(drop_test(), settings_with(step, substeps));
  const std::vector<double> rebound = rebound_heights(world, int(1.5 / step));
  double worst = 0;
  size_t body = 1;
  for (float e : restitutions)
    for (float h : heights) {
      const double expected = double(e) * e * h, error = std::abs(rebound[body++] - expected) / expected;
      CAPTURE(step, substeps, e, h, expected, error);
      worst = std::max(worst, error);
      CHECK(error < 0.001);
    }
  INFO("step " << step << " substeps " << substeps << ": worst relative error of the rebound height " << worst);
}

TEST_CASE("an impact below the restitution speed does not bounce", "[physics]")
{
  Scene scene = empty_scene();
  scene.materials[0].restitution = 0.8f;
  add_ground(scene);
  add_body(scene, BodyType::dynamic, sphere_shape(ball_radius), {0, ball_radius + 0.045f, 0}); /* 0.95 m/s */
  add_body(scene, BodyType::dynamic, sphere_shape(ball_radius), {2, ball_radius + 0.055f, 0}); /* 1.05 m/s */
  World world(scene);
  const std::vector<double> rebound = rebound_heights(world, 60);
  CHECK(std::abs(rebound[1]) < 0.001);
  CHECK(rebound[2] == Approx(0.64 * 0.055).epsilon(0.01));
}

TEST_CASE("a box that lands flat bounces to e^2 of its height and does not turn", "[physics]")
{
  Scene scene = empty_scene();
  scene.materials[0].restitution = 0.5f;
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(0.4f, ball_radius, 0.3f), {0, ball_radius + 2, 0});
  World world(scene);
  const std::vector<double> rebound = rebound_heights(world, 60);
  CHECK(rebound[1] == Approx(0.25 * 2).epsilon(0.01));
  CHECK(vector_of(world.bodies()[1].angular_velocity).norm() < 1e-4);
}

TEST_CASE("two balls exchange their velocities when e is 1", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].restitution = 1;
  add_body(scene, BodyType::dynamic, sphere_shape(ball_radius), {-2, 0, 0}).linear_velocity = {3, 0, 0};
  add_body(scene, BodyType::dynamic, sphere_shape(ball_radius), {0, 0, 0});
  World world(scene);
  run(world, 60);
  CHECK(std::abs(world.bodies()[0].linear_velocity[0]) < 1e-5);
  CHECK(world.bodies()[1].linear_velocity[0] == Approx(3).epsilon(1e-5));
}
