/* Round and flat shapes on the ground against closed forms: they roll, stand, tip over, slide and rock as theory
 * predicts. */
#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

/* I / (m r^2) about the axis: 1/2 for a cylinder, 2/5 for a ball; the capsule is both, by volume. */
TEST_CASE("round shapes roll down a ramp at g sin a / (1 + I / m r^2), straight and without slipping", "[physics]")
{
  const double degrees = GENERATE(3.0, 10.0, 20.0), angle = degrees * radians, radius = 0.3, seconds = 2;
  World world(load_scene(fmt::format("rolling:angle={}", degrees)));
  const double cylinder = 0.8, balls = 4.0 / 3 * radius; /* volumes of the capsule's parts over pi r^2 */
  const double shares[] = {0.4, 0.5, 0.5, (0.5 * cylinder + 0.4 * balls) / (cylinder + balls)};
  const Vector down(std::cos(angle), -std::sin(angle), 0), up(std::sin(angle), std::cos(angle), 0);
  const std::vector<BodyState> start = world.bodies();
  run(world, 120);
  const std::vector<BodyState> states = world.bodies();
  for (size_t i = 1; i <= 4; ++i) {
    const Body &body = world.scene().bodies[i];
    const Vector v = vector_of(states[i].linear_velocity), w = vector_of(states[i].angular_velocity);
    const Vector moved = vector_of(states[i].position) - vector_of(start[i].position);
    const double expected = gravity * std::sin(angle) / (1 + shares[i - 1]), slip = (v - radius * w.cross(up)).norm();
    CAPTURE(body.name, degrees, expected, v.dot(down) / seconds, slip, moved.z(), moved.dot(up));
    CHECK(v.dot(down) == Approx(expected * seconds).epsilon(0.005));
    CHECK(moved.dot(down) == Approx(0.5 * expected * seconds * seconds).epsilon(0.01));
    CHECK(slip < 0.005 * v.norm());
    CHECK(std::abs(moved.z()) < 0.001);
    CHECK(std::abs(moved.dot(up)) < 0.005);
    if (i > 1) CHECK(std::abs(axis_of(body, states[i]).z()) > 1 - 1e-6);
  }
}

TEST_CASE("cylinders, discs, cones and tapered cylinders stand on their ends", "[physics]")
{
  const std::vector<Shape> shapes = {cylinder_shape(0.3f, 0.5f),
                                     cylinder_shape(0.5f, 0.05f),
                                     cylinder_shape(0.1f, 0.5f),
                                     cone_shape(0.4f, 0.35f),
                                     Shape{ShapeType::cylinder, {0.4f, 0.3f, 0.2f}},
                                     Shape{ShapeType::cylinder, {0.2f, 0.3f, 0.4f}}};
  Scene scene = empty_scene();
  add_ground(scene);
  for (const Shape &shape : shapes)
    add_dynamic_body(scene, shape, {2.0 * double(scene.bodies.size()), shape.size[1], 0},
                     turn_about({0, 1, 0}, double(scene.bodies.size())));
  World world(scene);
  const std::vector<BodyState> start = world.bodies();
  run(world, 600);
  for (size_t i = 1; i < scene.bodies.size(); ++i) {
    const BodyState state = world.bodies()[i];
    const Vector moved = vector_of(state.position) - vector_of(start[i].position),
                 axis = axis_of(scene.bodies[i], state);
    const double tilt = std::hypot(axis.x(), axis.z());
    CAPTURE(i, tilt, moved.x(), moved.y(), moved.z());
    CHECK(tilt < 1e-3);
    CHECK(std::hypot(moved.x(), moved.z()) < 0.001);
    CHECK(std::abs(moved.y()) < 0.005);
  }
}

namespace {

/* On its lower rim, leaning by `lean` toward `azimuth`. */
Body &add_leaning(Scene &scene, const Shape &shape, double lean, double azimuth, double x)
{
  const Vector sideways(std::cos(azimuth), 0, std::sin(azimuth));
  const double height = shape.size[0] * std::sin(lean) + shape.size[1] * std::cos(lean);
  return add_dynamic_body(scene, shape, {x, height, 0}, turn_about(Vector(0, 1, 0).cross(sideways), lean));
}

} // namespace

/* It tips where its centre of mass stands above the rim: tan(lean) = radius / height of the centre above the base. */
TEST_CASE("a solid on its rim falls back below its tipping angle, and over above it", "[physics]")
{
  struct Case {
    const char *name;
    Shape shape;
    double center, lying; /* of mass, above the base; height of the axis's unit vector once it lies on its side */
  };
  const double apex = std::atan(0.4 / 0.7);
  const Case cases[] = {{"cylinder", cylinder_shape(0.3f, 0.5f), 0.5, 0},
                        {"slender", cylinder_shape(0.1f, 0.5f), 0.5, 0},
                        {"cone", cone_shape(0.4f, 0.35f), 0.175, -std::sin(apex)}};
  for (const Case &one : cases)
    for (double azimuth : {0.0, 0.7}) {
      const double critical = std::atan(one.shape.size[0] / one.center), margin = 2 * radians;
      Scene scene = empty_scene();
      add_ground(scene);
      add_leaning(scene, one.shape, critical - margin, azimuth, 0);
      add_leaning(scene, one.shape, critical + margin, azimuth, 5);
      World world(scene);
      run(world, 600); /* the slender one rocks for seven seconds, as a box of its size does */
      const double below = axis_of(scene.bodies[1], world.bodies()[1]).y(),
                   above = axis_of(scene.bodies[2], world.bodies()[2]).y();
      CAPTURE(one.name, azimuth, critical / radians, below, above);
      CHECK(below > std::cos(0.2 * radians));
      CHECK(vector_of(world.bodies()[1].angular_velocity).norm() < 1e-3);
      CHECK(above == Approx(one.lying).margin(0.01));
    }
}

TEST_CASE("capsules rest on their sides", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  const Shape tapered{ShapeType::capsule, {0.3f, 0.4f, 0.2f}};
  for (double azimuth : {0.0, 0.5, 1.57}) {
    const Quat about = turn_about({0, 1, 0}, azimuth);
    const Eigen::Quaterniond turn(about[3], about[0], about[1], about[2]);
    const auto lay = [&](const Shape &shape, double height, double slope) {
      const Eigen::Quaterniond q = turn * Eigen::AngleAxisd(pi / 2 + slope, Vector(0, 0, 1));
      add_dynamic_body(scene, shape, {3.0 * double(scene.bodies.size()), height, 0},
                       {float(q.x()), float(q.y()), float(q.z()), float(q.w())});
    };
    lay(capsule_shape(0.25f, 0.5f), 0.25, 0);
    lay(tapered, 0.25, std::asin(0.1 / 0.8)); /* both of its balls touch */
  }
  World world(scene);
  const std::vector<BodyState> start = world.bodies();
  run(world, 600);
  for (size_t i = 1; i < scene.bodies.size(); ++i) {
    const Vector moved = vector_of(world.bodies()[i].position) - vector_of(start[i].position);
    const double turned = axis_of(scene.bodies[i], world.bodies()[i]).dot(axis_of(scene.bodies[i], start[i]));
    CAPTURE(i, moved.x(), moved.y(), moved.z(), turned);
    CHECK(moved.norm() < 0.005);
    CHECK(turned > std::cos(0.5 * radians));
  }
}

TEST_CASE("a coin tossed flat lands flat and stops", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  const float thin = 0.01f;
  for (double spin : {0.0, 6.0}) {
    Body &coin = add_dynamic_body(scene, cylinder_shape(0.1f, thin), {2.0 * double(scene.bodies.size()), 0.4, 0});
    coin.linear_velocity = {0.5f, 1, 0};
    coin.angular_velocity = {0, float(spin), 0};
  }
  World world(scene);
  run(world, 240);
  for (size_t i : {1, 2}) {
    const BodyState state = world.bodies()[i];
    CAPTURE(i, axis_of(scene.bodies[i], state).y(), state.position[1]);
    CHECK(axis_of(scene.bodies[i], state).y() > std::cos(0.2 * radians));
    CHECK(state.position[1] == Approx(thin).margin(0.001));
    CHECK(vector_of(state.linear_velocity).norm() < 1e-3);
    CHECK(vector_of(state.angular_velocity).norm() < 1e-3);
  }
}

TEST_CASE("a hull that is a box falls, rests and slides as the box does", "[physics]")
{
  const double friction = 0.4, speed = 3, distance = speed * speed / (2 * friction * gravity);
  Scene scene = empty_scene();
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = float(friction);
  add_ground(scene);
  const Shape shapes[] = {box_shape(0.4f, 0.3f, 0.5f), hull_of_box(0.4f, 0.3f, 0.5f)};
  for (const Shape &shape : shapes) add_dynamic_body(scene, shape, {0, 1.3, 3.0 * double(scene.bodies.size())});
  for (const Shape &shape : shapes)
    add_dynamic_body(scene, shape, {0, 0.3, 3.0 * double(scene.bodies.size())}).linear_velocity = {float(speed), 0, 0};
  World world(scene);
  double apart = 0;
  for (int step = 0; step < 120; ++step) {
    world.step();
    const std::vector<BodyState> states = world.bodies();
    apart = std::max(apart, std::abs(states[1].position[1] - states[2].position[1]));
  }
  const std::vector<BodyState> states = world.bodies();
  CAPTURE(apart, states[1].position[1], states[2].position[1], states[3].position[0], states[4].position[0]);
  CHECK(apart < 1e-4);
  CHECK(states[2].position[1] == Approx(0.3).margin(0.005));
  CHECK(vector_of(states[2].linear_velocity).norm() < 1e-3);
  CHECK(states[3].position[0] == Approx(distance).epsilon(0.01));
  CHECK(states[4].position[0] == Approx(distance).epsilon(0.01));
}

TEST_CASE("stacks of five cylinders and of five cubes that are hulls stand", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int level = 0; level < 5; ++level)
    add_dynamic_body(scene, cylinder_shape(0.4f, 0.3f), {0, 0.3 + 0.6 * level, 0}, turn_about({0, 1, 0}, level));
  for (int level = 0; level < 5; ++level) add_dynamic_body(scene, hull_of_box(0.5f, 0.5f, 0.5f), {3, 0.5 + level, 0});
  World world(scene);
  const std::vector<BodyState> start = world.bodies();
  double deepest = 0;
  for (int i = 0; i < 10; ++i) {
    run(world, 100);
    deepest = std::max(deepest, world.statistics().max_penetration);
  }
  for (size_t i = 1; i < scene.bodies.size(); ++i) {
    const Vector moved = vector_of(world.bodies()[i].position) - vector_of(start[i].position);
    CAPTURE(i, moved.x(), moved.y(), moved.z());
    CHECK(std::hypot(moved.x(), moved.z()) < 0.001);
    CHECK(std::abs(moved.y()) < 0.015);
  }
  CAPTURE(deepest);
  CHECK(deepest < 0.005);
}

namespace {

/* A ball whose centre of mass lies `low` below its middle, leaning by `lean`. */
Scene weeble(double radius, double low, double lean)
{
  Scene scene = empty_scene();
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 2;
  add_ground(scene);
  Body &body = add_body(scene, BodyType::dynamic, sphere_shape(float(radius)),
                        {low * std::sin(lean), radius - low * std::cos(lean), 0});
  body.orientation = turn_about({0, 0, 1}, lean);
  body.shape_position = {0, float(low), 0};
  return scene;
}

} // namespace

/* Rolling without slipping by a small angle t: (I + m (R - d)^2) t'' = -m g d t, I about the centre of mass.
 *
 * Contacts are found once a step, so of n substeps h the weight turns the ball about a point that is (n - 1) h / 2 old
 * on average. A torque that lags by so much lets the swing grow by exp(w^2 (n - 1) h / 4 t); with one substep it
 * neither grows nor dies. */
TEST_CASE("a ball with a low centre of mass rocks with the period of theory", "[physics]")
{
  const double radius = 0.5, low = GENERATE(0.1, 0.2, 0.3), lean = 4 * radians;
  const uint32_t substeps = GENERATE(1, 4);
  const double substep = 1.0 / 240, step_size = substep * substeps;
  const Scene scene = weeble(radius, low, lean);
  const double moment = moments_of(scene, scene.bodies[1]).z() / double(scene.bodies[1].mass);
  const double rate = std::sqrt(gravity * low / (moment + (radius - low) * (radius - low))), period = 2 * pi / rate;
  World world(scene, settings_with(step_size, substeps));
  std::vector<double> crossings;
  double before = lean, farthest = 0;
  for (int step = 1; crossings.size() < 8 && step < 8000; ++step) {
    world.step();
    const double now = -axis_of(scene.bodies[1], world.bodies()[1]).x();
    if ((now < 0) != (before < 0)) crossings.push_back((step - 1 + before / (before - now)) * step_size);
    if (crossings.size() == 7) farthest = std::max(farthest, std::abs(now));
    before = now;
  }
  REQUIRE(crossings.size() == 8);
  const double measured = (crossings[7] - crossings[1]) / 3;
  const double growth = std::exp(rate * rate * (substeps - 1) * substep / 4 * 3.5 * period);
  CAPTURE(low, substeps, period, measured, farthest / lean, growth);
  CHECK(measured == Approx(period).epsilon(0.005));
  CHECK(farthest > 0.98 * lean);
  CHECK(farthest < 1.01 * growth * lean);
}

/* The spin alone is damped at c, the rolling ball by the share of the spin in its energy: c I / (I + m (R - d)^2) / 2 =
 * 0.26 c. */
TEST_CASE("a damped ball with a low centre of mass returns upright", "[physics]")
{
  for (double degrees : {60.0, -120.0, 170.0}) {
    Scene scene = weeble(0.5, 0.2, degrees * radians);
    scene.bodies[1].angular_damping = 1;
    World world(scene);
    run(world, 2400);
    CAPTURE(degrees);
    CHECK(axis_of(scene.bodies[1], world.bodies()[1]).y() > std::cos(0.5 * radians));
    CHECK(vector_of(world.bodies()[1].linear_velocity).norm() < 0.01);
  }
}
