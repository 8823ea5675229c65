/* Seams and ledges: boxes rest in one another by the slop, and must slide over ledges that are no higher. */
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr float half = 0.3f; /* of the box that slides */
constexpr int tiles_to_each_side = 7;

/* A floor of tiles of 1 m, their tops at 0 or up to `uneven` above it, under a box without friction at its middle. */
Scene tiled_floor(double uneven)
{
  Scene scene = empty_scene();
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
  add_body(scene, BodyType::dynamic, box_shape(half, half, half), {0, half, 0});
  Random random(3);
  for (int x = -tiles_to_each_side; x <= tiles_to_each_side; ++x)
    for (int z = -tiles_to_each_side; z <= tiles_to_each_side; ++z)
      add_body(scene, BodyType::fixed, box_shape(0.5f, 0.25f, 0.5f),
               {float(x), -0.25f + float(random.uniform(0, uneven)), float(z)});
  return scene;
}

struct Slide {
  double slowest = INFINITY, highest = -INFINITY, aside = 0; /* m/s; m; m */
  double displacement = 0;
};

/* Heading and yaw of the box: rad about y, from x. */
Slide slide(Scene scene, double heading, double yaw, double speed, int steps)
{
  const Vector along(std::cos(heading), 0, -std::sin(heading)), across(std::sin(heading), 0, std::cos(heading));
  scene.bodies[0].orientation = turn_about({0, 1, 0}, yaw);
  scene.bodies[0].linear_velocity = vec3_of(speed * along);
  World world(scene);
  Slide result;
  for (int i = 0; i < steps; ++i) {
    world.step();
    const BodyState box = world.bodies()[0];
    result.slowest = std::min(result.slowest, vector_of(box.linear_velocity).dot(along));
    result.highest = std::max(result.highest, box.position[1] - double(half));
    result.aside = std::max(result.aside, std::abs(vector_of(box.position).dot(across)));
    result.displacement = vector_of(box.position).dot(along);
  }
  return result;
}

} // namespace

TEST_CASE("a box without friction slides over the seams of a floor, in every direction", "[physics]")
{
  const double heading = GENERATE(0.0, 90.0, 180.0, 270.0, 30.0, 45.0) * radians, yaw = GENERATE(0.0, 30.0) * radians;
  CAPTURE(heading, yaw);
  const Slide result = slide(tiled_floor(0), heading, yaw, 5, 72);
  CHECK(result.slowest > 4.99);
  CHECK(result.highest < 1e-4);
  CHECK(result.aside < 1e-3);
}

TEST_CASE("a box without friction slides over tiles that differ by a millimetre", "[physics]")
{
  const double heading = GENERATE(0.0, 90.0, 180.0, 270.0, 30.0) * radians, yaw = GENERATE(0.0, 30.0) * radians;
  const double speed = GENERATE(0.5, 5.0);
  CAPTURE(heading, yaw, speed);
  const Slide result = slide(tiled_floor(0.001), heading, yaw, speed, speed < 1 ? 360 : 72);
  CHECK(result.slowest > 0.98 * speed);
  CHECK(result.highest < 0.002);
  CHECK(result.aside < 0.05);
}

TEST_CASE("a box slides over a seam however slowly", "[physics]")
{
  const Slide result =
      slide(tiled_floor(0), 0, 0, 0.05, 600); /* half a metre: its front goes over a seam in the middle of the way */
  CHECK(result.slowest > 0.0495);
  CHECK(result.displacement == Approx(0.5).margin(0.005));
}

TEST_CASE("a step of three centimetres stops a box", "[physics]")
{
  const double heading = GENERATE(0.0, 180.0) * radians,
               speed = GENERATE(0.2, 1.0, 2.0); /* faster ones tip over its edge */
  CAPTURE(heading, speed);
  Scene scene = tiled_floor(0);
  for (Body &body : scene.bodies)
    if (body.type == BodyType::fixed && std::abs(body.position[0]) > 1.5f) body.position[1] += 0.03f;
  const Slide result = slide(scene, heading, 0, speed, speed < 1 ? 600 : 120);
  CHECK(result.slowest < 0.1 * speed);
  CHECK(result.displacement < 1.5 - half + 0.01);
  CHECK(result.highest < 0.001 + speed * speed / (2 * gravity)); /* it may tip, and fall back */
}

TEST_CASE("boxes beside one another and on one another stand, with edges that meet", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z)
        add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {float(x), 0.5f + float(y), float(z)});
  World world(scene);
  run(world, 300);
  for (size_t i = 1; i < scene.bodies.size(); ++i)
    CHECK((vector_of(world.bodies()[i].position) - vector_of(scene.bodies[i].position)).norm() < 0.01);
}

TEST_CASE("a box that lies on a ledge of two centimetres stays there", "[physics]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.5f), {0, 0.1f, 0});
  for (float side : {-1.0f, 1.0f})
    add_body(scene, BodyType::fixed, box_shape(0.5f, 0.5f, 0.5f), {side * 0.98f, -0.5f, 0});
  World world(scene);
  run(world, 300);
  CHECK(world.bodies()[0].position[1] > 0.09f);
}
