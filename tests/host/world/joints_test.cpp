/* What a world with joints refuses, by name, and leaves as it was. */
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;
using Catch::Matchers::ContainsSubstring;

namespace {

/* Two joined bodies, one that a joint binds to the world, and one that is free. */
Scene two_joined_and_one_free()
{
  Scene scene = empty_scene();
  for (int i = 0; i < 4; ++i) add_body(scene, BodyType::dynamic, sphere_shape(0.4f), {double(i), 0, 0});
  connect(scene, JointType::ball, 0, 1, {0.5, 0, 0});
  connect(scene, JointType::fixed, no_body, 2, {2, 0, 0});
  return scene;
}

} // namespace

TEST_CASE("solvers without joints refuse them by name")
{
  const Scene scene = two_joined_and_one_free();
  for (const Solver solver : choices<Solver>()) {
    if (solver == Solver::soft_step) continue;
    CAPTURE(solver);
    CHECK_THROWS_WITH(World(scene, settings_for(solver), {"serial", {}}),
                      ContainsSubstring(std::string("the solver ") + name_of(solver) + " has no joints"));
  }
}

TEST_CASE("joined bodies are not destroyed and keep their types, and others may")
{
  World world(two_joined_and_one_free(), {}, {"serial", {}});
  for (const uint32_t body : {0u, 1u, 2u}) {
    const uint64_t before = world.state_hash();
    CHECK_THROWS_WITH(world.destroy_body(world.id_of(body)),
                      ContainsSubstring("body " + std::to_string(body)) && ContainsSubstring("joint"));
    CHECK_THROWS_WITH(world.set_type(world.id_of(body), BodyType::fixed), ContainsSubstring("its type cannot change"));
    CHECK_NOTHROW(world.set_type(world.id_of(body), BodyType::dynamic));
    CHECK(world.exists(world.id_of(body)));
    CHECK(world.state_hash() == before);
  }
  CHECK_NOTHROW(world.set_type(world.id_of(3), BodyType::kinematic));
  CHECK_NOTHROW(world.destroy_body(world.id_of(3)));
  CHECK_NOTHROW(world.step());
}

TEST_CASE("the frequency and the damping of joints are checked")
{
  const Scene scene = two_joined_and_one_free();
  Settings settings;
  settings.joint_hertz = -1;
  CHECK_THROWS_WITH(World(scene, settings), ContainsSubstring("joint stiffness"));
  settings.joint_hertz = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(World(scene, settings), ContainsSubstring("joint stiffness"));
  settings.joint_hertz = 60;
  settings.joint_damping_ratio = -0.5f;
  CHECK_THROWS_WITH(World(scene, settings), ContainsSubstring("joint damping ratio"));
}
