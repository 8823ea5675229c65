/* Friction: the cone on an incline, stopping distances, rolling. */
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* A flat box on a ramp of its own, both turned about z by `angle`. */
void add_incline(Scene &scene, uint32_t material, double angle, float z)
{
  const Quat tilt = turn_about({0, 0, 1}, angle);
  Body &ramp = add_body(scene, BodyType::fixed, box_shape(10, 0.5f, 0.6f), {0, 0, z});
  ramp.orientation = tilt;
  ramp.material = material;
  const Vector up(-std::sin(angle), std::cos(angle), 0);
  Body &box = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.15f, 0.5f), point_of(0.65 * up + Vector(0, 0, z)));
  box.orientation = tilt;
  box.material = material;
}

constexpr double finest = 0.25; /* degrees between inclines */
constexpr int to_each_side = 12;

} // namespace

/* Inclines from atan mu - 3 to + 3 degrees side by side; the first one whose box slides gives the angle. */
TEST_CASE("a box on an incline slips at atan mu", "[physics]")
{
  Scene scene = empty_scene();
  const std::vector<double> coefficients{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
  std::vector<double> angles;
  for (double mu : coefficients) {
    const uint32_t material = add_material(scene, float(mu));
    for (int i = -to_each_side; i <= to_each_side; ++i) {
      angles.push_back(std::atan(mu) + i * finest * radians);
      add_incline(scene, material, angles.back(), 2.0f * float(angles.size()));
    }
  }
  World world(scene);
  const std::vector<BodyState> start = world.bodies();
  run(world, 120);
  const std::vector<BodyState> now = world.bodies();
  double creep = 0;
  for (size_t k = 0, i = 0; k < coefficients.size(); ++k) {
    double slips_at = 90;
    for (int side = -to_each_side; side <= to_each_side; ++side, ++i) {
      const double slid = (vector_of(now[2 * i + 1].position) - vector_of(start[2 * i + 1].position)).norm();
      if (slid > 0.02) slips_at = std::min(slips_at, angles[i] / radians);
      if (side * finest <= -2) creep = std::max(creep, slid);
      const double expected = 0.5 * 4 * gravity * (std::sin(angles[i]) - coefficients[k] * std::cos(angles[i]));
      if (side * finest >= 2) CHECK(slid == Approx(expected).epsilon(0.05));
    }
    INFO("mu " << coefficients[k] << ": slips at " << slips_at << " degrees, theory "
               << std::atan(coefficients[k]) / radians);
    CHECK(std::abs(slips_at - std::atan(coefficients[k]) / radians) <= 2);
  }
  INFO("largest creep in 2 s, 2 degrees and more below the cone: " << creep << " m");
  CHECK(creep < 0.01);
}

TEST_CASE("a sliding box stops after v^2 / (2 mu g)", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene).material = add_material(scene, 0);
  scene.materials.back().friction_combine = Combine::maximum;
  struct Slide {
    double mu, speed;
  };
  const std::vector<Slide> slides{{0.2, 2}, {0.2, 5}, {0.5, 2}, {0.5, 5}, {0.9, 5}};
  for (const Slide &slide : slides) {
    const uint32_t material = add_material(scene, float(slide.mu));
    scene.materials[material].friction_combine = Combine::maximum;
    Body &box =
        add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.5f), {0, 0.1f, 3.0f * float(scene.bodies.size())});
    box.linear_velocity = {float(slide.speed), 0, 0};
    box.material = material;
  }
  World world(scene);
  run(world, 200);
  for (size_t i = 0; i < slides.size(); ++i) {
    const BodyState box = world.bodies()[i + 1];
    const double expected = slides[i].speed * slides[i].speed / (2 * slides[i].mu * gravity);
    INFO("mu " << slides[i].mu << ", " << slides[i].speed << " m/s: stops after " << box.position[0] << " m, theory "
               << expected);
    CHECK(box.position[0] == Approx(expected).epsilon(0.03));
    CHECK(vector_of(box.linear_velocity).norm() < 1e-3);
  }
}

TEST_CASE("static friction holds what dynamic friction would not", "[physics]")
{
  Scene scene = empty_scene();
  const uint32_t material = add_material(scene, 0.8f);
  scene.materials[material].dynamic_friction = 0.3f;
  add_incline(scene, material, std::atan(0.6), 0);
  add_incline(scene, material, std::atan(0.6), 5);
  scene.bodies[3].linear_velocity = {-1, float(-0.6), 0};
  World world(scene);
  const std::vector<BodyState> start = world.bodies();
  run(world, 60);
  const auto slid = [&](size_t i) {
    return (vector_of(world.bodies()[i].position) - vector_of(start[i].position)).norm();
  };
  CHECK(slid(1) < 0.005);
  const double angle = std::atan(0.6), speed = std::hypot(1, 0.6);
  CHECK(slid(3) == Approx(speed + 0.5 * gravity * (std::sin(angle) - 0.3 * std::cos(angle))).epsilon(0.05));
}

TEST_CASE("a sliding ball ends up rolling at 5/7 of its speed", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  const double speed = GENERATE(1.0, 7.0);
  const float radius = GENERATE(0.2f, 1.0f);
  add_body(scene, BodyType::dynamic, sphere_shape(radius), {0, radius, 0}).linear_velocity = {float(speed), 0, 0};
  World world(scene);
  const double sliding_ends = 2 * speed / (7 * 0.6 * gravity);
  run(world, int(std::ceil(sliding_ends * 60)) + 2);
  const double rolling = world.bodies()[1].linear_velocity[0];
  run(world, 600);
  const BodyState ball = world.bodies()[1];
  INFO("rolling ball: " << rolling / speed << " after slipping, " << ball.linear_velocity[0] / speed
                        << " 10 s later, theory " << 5.0 / 7);
  CHECK(rolling == Approx(5.0 / 7 * speed).epsilon(0.001));
  CHECK(ball.linear_velocity[0] == Approx(5.0 / 7 * speed).epsilon(0.002));
  CHECK(-ball.angular_velocity[2] * radius == Approx(ball.linear_velocity[0]).epsilon(0.001));
}

/* Sliding boxes on platforms of another material: the deceleration gives the coefficient in effect. */
TEST_CASE("materials combine by the rule that stands first, and geometric mean yields", "[physics]")
{
  const std::vector<Combine> rules{Combine::average, Combine::minimum, Combine::maximum, Combine::multiply,
                                   Combine::geometric_mean};
  const double mu[2] = {0.2, 0.8}, bounce[2] = {0.25, 0.75};
  const auto combine = [](Combine a, Combine b, const double(&v)[2]) {
    switch (std::min(a, b)) {
    case Combine::average: return 0.5 * (v[0] + v[1]);
    case Combine::minimum: return v[0];
    case Combine::maximum: return v[1];
    case Combine::multiply: return v[0] * v[1];
    default: return std::sqrt(v[0] * v[1]);
    }
  };
  Scene scene = empty_scene();
  std::vector<double> friction, restitution;
  for (Combine a : rules)
    for (Combine b : rules) {
      const float z = 4.0f * float(friction.size());
      Body &platform = add_body(scene, BodyType::fixed, box_shape(20, 0.5f, 1), {0, -0.5f, z});
      platform.material = add_material(scene, float(mu[0]), float(bounce[0]));
      Body &box = add_body(scene, BodyType::dynamic, box_shape(0.4f, 0.1f, 0.4f), {0, 0.1f, z});
      box.material = add_material(scene, float(mu[1]), float(bounce[1]));
      box.linear_velocity = {6, 0, 0};
      Body &ball = add_body(scene, BodyType::dynamic, sphere_shape(0.25f), {-5, 1.25f, z});
      ball.material = box.material;
      for (int k = 1; k <= 2; ++k) {
        Material &material = scene.materials[scene.materials.size() - size_t(k)];
        material.friction_combine = material.restitution_combine = k == 2 ? a : b;
      }
      friction.push_back(combine(a, b, mu));
      restitution.push_back(combine(a, b, bounce));
    }
  World world(scene);
  run(world, 32); /* the balls, dropped from 1 m, hit after 27 */
  const std::vector<BodyState> now = world.bodies();
  for (size_t i = 0; i < friction.size(); ++i) {
    CAPTURE(i / 5, i % 5);
    const double t = 32.0 / 60, lost = 6 - now[3 * i + 1].linear_velocity[0];
    CHECK(lost / (gravity * t) == Approx(friction[i]).epsilon(0.02));
    const BodyState &ball = now[3 * i + 2];
    const double height = ball.position[1] - 0.25 + ball.linear_velocity[1] * ball.linear_velocity[1] / (2 * gravity);
    CHECK(height == Approx(restitution[i] * restitution[i]).epsilon(0.02));
  }
}
