/* Kinematic bodies carry and push other bodies; filters let bodies pass each other. */
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

TEST_CASE("a kinematic platform carries a box and is not slowed by it", "[physics][sanitizer]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::kinematic, box_shape(3, 0.25f, 3), {0, 0, 0}).linear_velocity = {1, 0, 0.5f};
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.75f, 0}).mass = 1000;
  World world(scene);
  run(world, 120);
  const std::vector<BodyState> now = world.bodies();
  CHECK((vector_of(now[0].position) - Vector(2, 0, 1)).norm() < 1e-4);
  CHECK((vector_of(now[1].linear_velocity) - Vector(1, 0, 0.5)).norm() < 1e-3);
  /* It slipped until friction had given it the platform's speed: v^2 / (2 mu g) behind. */
  const double behind = (1 + 0.25) / (2 * 0.6 * gravity);
  const Vector relative = vector_of(now[1].position) - vector_of(now[0].position);
  CHECK(std::hypot(relative.x(), relative.z()) == Approx(behind).epsilon(0.1));
}

TEST_CASE("a kinematic box pushes what is in its way", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::kinematic, box_shape(0.5f, 0.5f, 0.5f), {-2, 0, 0}).linear_velocity = {2, 0, 0};
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0, 0}).mass = 50;
  World world(scene);
  run(world, 120);
  const std::vector<BodyState> now = world.bodies();
  CHECK(now[0].position[0] == Approx(2).margin(1e-4));
  CHECK(now[1].linear_velocity[0] == Approx(2).epsilon(1e-4));
  CHECK(now[1].position[0] == Approx(3).margin(0.006));
}

TEST_CASE("a turning kinematic platform turns what stands on it", "[physics]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::kinematic, box_shape(3, 0.25f, 3), {0, 0, 0}).angular_velocity = {0, 1, 0};
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.75f, 0});
  World world(scene);
  run(world, 120);
  CHECK(world.bodies()[1].angular_velocity[1] == Approx(1).epsilon(0.01));
  const Vector turned = axes_of(world.bodies()[0].orientation).col(0);
  CHECK(std::atan2(-turned.z(), turned.x()) == Approx(2).epsilon(1e-4));
}

TEST_CASE("bodies collide only when both accept the other's group", "[physics]")
{
  struct Case {
    uint32_t group, mask;
    bool stands;
  };
  const std::vector<Case> cases{
      {1, 0xffffffffu, true}, {2, 0xffffffffu, false}, {1, 2, false}, {1, 4, true}, {3, 6, true}, {2, 1, false}};
  Scene scene = empty_scene();
  Body &platform = add_body(scene, BodyType::fixed, box_shape(30, 0.5f, 2), {0, -0.5f, 0});
  platform.filter_group = 4;
  platform.filter_mask = 1;
  for (const Case &each : cases) {
    Body &ball =
        add_body(scene, BodyType::dynamic, sphere_shape(0.25f), {-10 + 2.0f * float(scene.bodies.size()), 0.3f, 0});
    ball.filter_group = each.group;
    ball.filter_mask = each.mask;
  }
  World world(scene);
  run(world, 60);
  for (size_t i = 0; i < cases.size(); ++i) {
    CAPTURE(cases[i].group, cases[i].mask);
    CHECK((world.bodies()[i + 1].position[1] > 0.2f) == cases[i].stands);
  }
}
