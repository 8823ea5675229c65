/* Bodies with infinite or very large moments of inertia: their four points share one effective mass, and separate
 * together. */
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

TEST_CASE("a body whose moments are infinite about two axes turns about the third alone", "[physics]")
{
  for (const Solver solver : choices<Solver>()) {
    Scene scene = empty_scene();
    add_ground(scene);
    Body &tilted = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 1.5, 0});
    tilted.orientation = turn_about({0, 0, 1}, 0.3);
    tilted.linear_velocity = {1, 0, 0};
    Body &struck = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {4, 0.5, 0});
    scene.bodies[1].inertia = struck.inertia = {0, 0.2f, 0};
    add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {2.5, 0.5, 0.4}).linear_velocity = {4, 0, 0};
    World world(scene, settings_for(solver));
    run(world, 120);
    const Matrix stands = axes_of(world.bodies()[1].orientation), turned = axes_of(world.bodies()[2].orientation);
    CAPTURE(solver, stands, turned);
    CHECK((stands - axes_of(scene.bodies[1].orientation)).norm() < 1e-4); /* on its edge, which would tip over */
    CHECK((turned.col(1) - Vector(0, 1, 0)).norm() < 1e-4);
    CHECK(std::atan2(turned(0, 2), turned(2, 2)) > 0.02);
  }
}

/* The warm start of the substep after the impact brings the impact's impulse again, which the points must give back
 * wholly. */
TEST_CASE("without restitution a body that falls flat stays down, however hard it is to turn", "[physics]")
{
  for (const float half_height : {0.1f, 0.5f, 1.5f, 3.0f})
    for (const bool turns : {true, false})
      for (double height = 0.5; height < 6; height += 0.73) {
        Scene scene = empty_scene();
        add_ground(scene);
        Body &body =
            add_body(scene, BodyType::dynamic, box_shape(0.5f, half_height, 0.5f), {0, half_height + height, 0});
        body.infinite_inertia = !turns;
        World world(scene);
        double impact = 0, rebound = 0;
        for (int k = 0; k < 90; ++k) {
          world.step();
          const double speed = world.bodies()[1].linear_velocity[1];
          impact = std::max(impact, -speed);
          rebound = std::max(rebound, speed);
        }
        CAPTURE(half_height, turns, height, impact, rebound);
        CHECK(impact > 0.9 * std::sqrt(2 * gravity * height));
        CHECK(rebound < 0.01 * impact);
      }
}
