/* Worlds go back to states before bodies came, and joints follow: what is written of joints afterwards is of the bodies
 * that there are. */
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Balls on joints in a row, room for more bodies, and one shape for those that come. */
Scene row_of_joined_balls()
{
  Scene scene = empty_scene({0, 0, 0});
  add_ground(scene);
  for (uint32_t i = 0; i < 6; ++i) {
    add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {double(i), 2, 0});
    if (i > 0) connect(scene, JointType::ball, i, i + 1, {i - 0.5, 2, 0});
  }
  return scene;
}

Body loose_ball(const Point &position)
{
  Body body;
  body.shape = 1;
  body.position = position;
  return body;
}

void shift_frame(World &world, uint32_t joint, double along)
{
  const JointId id = world.id_of_joint(joint);
  Joint changed = world.scene().joints[joint];
  changed.position_a[1] += along;
  world.set_joint(id, changed);
}

} // namespace

/* The graph of joints was made while there were more bodies than are left. Where others sleep than before, the list of
 * their places is the one of then, which ends with them. */
TEST_CASE("a world that goes back before bodies that came with changed joints goes on as one that never had them",
          "[address]")
{
  for (const bool sleeping : {true, false})
    for (const char *backend : {"serial", "tbb:threads=2"}) {
      CAPTURE(backend, sleeping);
      Settings settings;
      settings.sleeping = sleeping;
      settings.sleep_time = 0.1f;
      World world(row_of_joined_balls(), settings, {backend, {}, false}),
          other(row_of_joined_balls(), settings, {"serial", {}, false});
      for (World *one : {&world, &other}) {
        one->create_body(loose_ball({9, 5, 0}));
        run(*one, 20);
        REQUIRE((one->statistics().asleep > 0) == sleeping);
      }
      world.keep_states(4);
      world.create_bodies(std::vector<Body>(20, loose_ball({20, 5, 0})));
      shift_frame(world, 2, 0.05);
      REQUIRE(world.states_kept() == 1);
      world.go_back(0);
      REQUIRE(world.body_count() == 8);
      REQUIRE(world.scene().joints[2].position_a == other.scene().joints[2].position_a);
      for (World *one : {&world, &other}) {
        one->set_mass(one->id_of(2), 3);
        one->step();
        shift_frame(*one, 1, 0.02);
        one->step();
        one->create_body(loose_ball({12, 5, 0}));
        one->set_mass(one->id_of(7), 2);
        one->set_mass(one->id_of(8), 2);
        one->destroy_joint(one->id_of_joint(3));
        one->step();
      }
      REQUIRE(world.state_hash() == other.state_hash());
      for (int k = 0; k < 20; ++k) {
        world.step();
        other.step();
        REQUIRE(world.state_hash() == other.state_hash());
      }
    }
}
