/* Continuous collision: fast bodies stop at thin ones, and the motion of bodies that miss does not change. */
#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

std::vector<Shape> bullets(Random &random, float size)
{
  return {sphere_shape(size),
          box_shape(size, 0.6f * size, 0.3f * size),
          capsule_shape(0.4f * size, size),
          Shape{ShapeType::capsule, {0.5f * size, size, 0.2f * size}},
          cylinder_shape(0.5f * size, size),
          cone_shape(0.7f * size, size),
          random_hull_shape(random, 12, size)};
}

/* A wall of 1 to 10 mm across the Y-Z plane and a solid that flies at it, up to 80 degrees to its normal. */
Scene shot(Random &random, size_t kind, double speed, bool continuous)
{
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].restitution = random.below(2) ? 0.0f : 0.5f;
  const double thickness = random.uniform(0.001, 0.01);
  add_body(scene, BodyType::fixed, box_shape(float(thickness / 2), 100, 100), {0, 0, 0});
  const double angle = random.uniform(0, 80) * radians, turn = random.uniform(0, 2 * pi);
  const Vector velocity =
      speed * Vector(std::cos(angle), std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn));
  const double away = random.uniform(0.1, std::max(0.2, speed / 60));
  const Shape shape = bullets(random, float(random.uniform(0.005, 0.05)))[kind];
  Body &body = add_dynamic_body(scene, shape, velocity * (-away / velocity.x()), random.orientation(), 0.1f);
  body.linear_velocity = vec3_of(velocity);
  body.angular_velocity = vec3_of(random.uniform(0, 200) * direction(random));
  body.continuous = continuous;
  return scene;
}

/* The farthest that the middle of the body comes while it is before or behind the wall and not past its rim. */
double farthest_x(World &world, int steps)
{
  double farthest = -1e9;
  for (int i = 0; i < steps; ++i) {
    world.step();
    const Point at = world.bodies()[1].position;
    if (std::abs(at[1]) < 90 && std::abs(at[2]) < 90) farthest = std::max(farthest, at[0]);
  }
  return farthest;
}

uint32_t passed(double speed, bool continuous, int shots)
{
  Random random(uint64_t(speed) + 3);
  uint32_t through = 0;
  for (size_t kind = 0; kind < 7; ++kind)
    for (int k = 0; k < shots; ++k) {
      World world(shot(random, kind, speed, continuous), {}, {"serial", {}});
      through += farthest_x(world, 15) > 0;
    }
  return through;
}

} // namespace

TEST_CASE("nothing passes a thin wall, whatever its speed, angle and spin", "[physics]")
{
  const double speed = GENERATE(10.0, 100.0, 1000.0, 10000.0);
  CAPTURE(speed);
  CHECK(passed(speed, true, 30) == 0);
  CHECK(passed(speed, false, 10) > 0); /* without, some do: the shots are hard enough */
}

TEST_CASE("bullets stay in a room of thin walls, also where one turns them into the next", "[physics]")
{
  const double speed = GENERATE(10.0, 300.0, 10000.0);
  Random random(11);
  uint32_t outside = 0, seen = 0;
  for (int room = 0; room < 20; ++room) {
    Scene scene = empty_scene();
    const double thickness = random.uniform(0.001, 0.01);
    std::vector<Vector> walls = {Vector::UnitX(),  -Vector::UnitX(), Vector::UnitY(),
                                 -Vector::UnitY(), Vector::UnitZ(),  -Vector::UnitZ()};
    for (int k = 0; k < 4; ++k) walls.push_back(direction(random));
    for (const Vector &normal : walls) {
      Body &wall = add_body(scene, BodyType::fixed, box_shape(3, float(thickness / 2), 3),
                            point_of(normal * (1 + thickness / 2)));
      wall.orientation = turn_of_y_to(normal);
    }
    for (const Shape &shape : bullets(random, float(random.uniform(0.01, 0.08)))) {
      Body &body = add_dynamic_body(scene, shape, 0.5 * direction(random), random.orientation(), 0.1f);
      body.linear_velocity = vec3_of(speed * direction(random));
      body.angular_velocity = vec3_of(random.uniform(0, 200) * direction(random));
      body.continuous = true;
      body.filter_group = 2; /* walls alone */
      body.filter_mask = 1;
    }
    World world(scene, {}, {"serial", {}});
    run(world, 40);
    const std::vector<BodyState> states = world.bodies();
    for (size_t i = walls.size(); i < states.size(); ++i) {
      ++seen;
      for (const Vector &normal : walls) outside += normal.dot(vector_of(states[i].position)) > 1;
    }
  }
  CAPTURE(speed);
  CHECK(outside == 0);
  CHECK(seen == 140);
}

TEST_CASE("built-in scenes of thin walls hold", "[physics]")
{
  const std::string spec = GENERATE(
      as<std::string>{}, "thin-wall:n=60,speed=10", "thin-wall:n=60", "thin-wall:n=60,speed=10000,thickness=0.001",
      "bullet-stack", "bullet-stack:speed=10000,thickness=0.001", "bullet-stack:speed=100,rows=1,height=1");
  const Scene scene = load_scene(spec);
  World world(scene);
  uint32_t through = 0, turned = 0;
  for (int step = 0; step < 30; ++step) {
    world.step();
    const std::vector<BodyState> states = world.bodies();
    for (size_t i = 0; i < states.size(); ++i) { /* one that slides off the sheet's rim, 200 m away, may go behind it */
      const Point &at = states[i].position;
      through += scene.bodies[i].continuous && at[0] > 0 && std::max(std::abs(at[1]), std::abs(at[2])) < 190;
    }
  }
  const std::vector<BodyState> states = world.bodies();
  REQUIRE(all_finite(states));
  for (size_t i = 0; i < states.size(); ++i) {
    if (!scene.bodies[i].continuous) continue;
    turned += states[i].linear_velocity[0] < 0.5f * scene.bodies[i].linear_velocity[0];
  }
  CAPTURE(spec, turned);
  CHECK(through == 0);
  CHECK(turned == (spec.rfind("thin-wall", 0) == 0 ? 60u : 1u)); /* all have met something */
}

TEST_CASE("a bullet that passes a millimetre beside an edge keeps its velocity to the bit", "[physics]")
{
  const float speed = GENERATE(20.0f, 300.0f, 10000.0f);
  const bool continuous = GENERATE(true, false);
  const Shape shapes[] = {sphere_shape(0.01f), box_shape(0.01f, 0.01f, 0.01f), cylinder_shape(0.01f, 0.01f)};
  uint32_t changed = 0, cases = 0;
  for (const Shape &shape : shapes)
    for (int start = 1; start <= 12; ++start) {
      Scene scene = empty_scene({0, 0, 0});
      add_body(scene, BodyType::fixed, box_shape(0.002f, 0.5f, 0.5f), {0, -0.5, 0}); /* its upper edge at y = 0 */
      Body &body = add_body(scene, BodyType::dynamic, shape, {-0.013 * start, 0.011, 0});
      body.linear_velocity = {speed, 0, 0};
      body.continuous = continuous;
      World world(scene, {}, {"serial", {}});
      run(world, 8);
      const Vec3 expected{speed, 0, 0}, found = world.bodies()[1].linear_velocity,
                                        spin = world.bodies()[1].angular_velocity;
      changed += found != expected || spin != Vec3{0, 0, 0};
      ++cases;
    }
  CAPTURE(speed, continuous, cases);
  CHECK(changed == 0);
}

TEST_CASE("a bullet stops at a wall where it meets it, and slides on without friction", "[physics]")
{
  const float speed = GENERATE(30.0f, 1000.0f, 10000.0f);
  const float e = GENERATE(0.0f, 1.0f);
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = 0;
  scene.materials[0].restitution = e;
  add_body(scene, BodyType::fixed, box_shape(0.001f, 400, 1), {0, 0, 0});
  Body &body = add_body(scene, BodyType::dynamic, sphere_shape(0.02f), {-0.2, 0, 0});
  body.linear_velocity = {0.6f * speed, 0.8f * speed, 0};
  body.continuous = true;
  World world(scene);
  world.step();
  const BodyState state = world.bodies()[1];
  const double displacement = double{speed} / 60;
  CAPTURE(speed, e);
  CHECK(state.position[0] == Approx(-0.021).margin(2e-6 * displacement + 1e-5));
  CHECK(state.position[1] == Approx(0.8 * displacement).epsilon(1e-5));
  CHECK(state.linear_velocity[0] == Approx(-double{e} * 0.6 * double{speed}).margin(2e-5 * double{speed}));
  CHECK(state.linear_velocity[1] == Approx(0.8 * double{speed}).epsilon(1e-6));
  CHECK(vector_of(state.angular_velocity).norm() < 1e-3);
}

TEST_CASE("a bullet and a free target share their momentum", "[physics]")
{
  const double speed = GENERATE(50.0, 1000.0, 10000.0);
  Random random(5);
  double linear = 0, hits = 0;
  for (int k = 0; k < 28; ++k) {
    Scene scene = empty_scene({0, 0, 0});
    scene.materials[0].restitution = k % 2 ? 0.0f : 0.5f;
    const Vector away = direction(random), aside = 0.05 * direction(random);
    add_dynamic_body(scene, box_shape(0.2f, 0.3f, 0.25f), {0, 0, 0}, random.orientation(), 3);
    Body &bullet = add_dynamic_body(scene, bullets(random, 0.02f)[size_t(k) % 7],
                                    away * random.uniform(0.5, speed / 60 + 0.5) + aside, random.orientation(), 0.1f);
    bullet.linear_velocity = vec3_of(-speed * away);
    bullet.continuous = true;
    World world(scene, {}, {"serial", {}});
    const Momentum start = momentum_of(world);
    for (int i = 0; i < 8; ++i) {
      world.step();
      linear = std::max(linear, (momentum_of(world).linear - start.linear).norm() / start.linear_scale);
    }
    hits += vector_of(world.bodies()[0].linear_velocity).norm() > 0.001 * speed;
  }
  CAPTURE(speed, linear, hits);
  CHECK(linear < 1e-5);
  CHECK(hits == 28);
}

TEST_CASE("a half-space is never continuous", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene).continuous = true;
  CHECK_THROWS_WITH(World(scene), Catch::Matchers::ContainsSubstring("half_space") &&
                                      Catch::Matchers::ContainsSubstring("continuous"));
}
