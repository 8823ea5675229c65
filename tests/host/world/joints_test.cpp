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

/* Joints take their share of errors from masses, so a world that goes on must not go on with those of its beginning. */
TEST_CASE("a joined body whose mass changes has the bits that it has in a world made of the snapshot")
{
  Scene scene = empty_scene({0, 0, 0});
  for (int i = 0; i < 6; ++i) add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {double(i), 0, 0});
  for (uint32_t i = 1; i < 6; ++i) {
    connect(scene, JointType::fixed, 0, i, {0.3 * i, 0.1 * i, 0});
    scene.bodies[i].linear_velocity = {0, 0.2f * float(i), 0.1f};
  }
  World world(scene, {}, {"serial", {}, false});
  for (const BodyProperties &change : {BodyProperties{.mass = 0.05f}, BodyProperties{.mass = 20.0f},
                                       BodyProperties{.inertia = Vec3{0.001f, 0.001f, 0.001f}}}) {
    world.step();
    world.set_properties(world.id_of(0), change);
    World other(world.save(), {"serial", {}, false});
    for (int k = 0; k < 5; ++k) {
      world.step();
      other.step();
      REQUIRE(world.state_hash() == other.state_hash());
    }
  }
}
