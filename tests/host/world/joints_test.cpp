/* What a world with joints refuses, by name, and leaves as it was. */
#include <tandem/worlds.h>

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

TEST_CASE("every solver takes joints, and those without couplings refuse them by name")
{
  Scene scene = two_joined_and_one_free();
  for (const Solver solver : choices<Solver>()) {
    CAPTURE(solver);
    CHECK_NOTHROW(World(scene, settings_for(solver), {"serial", {}}).step());
  }
  for (Joint &joint : scene.joints) joint.type = JointType::hinge;
  scene.couplings.resize(1);
  scene.couplings[0].joint_b = 1;
  scene.couplings[0].teeth_a = scene.couplings[0].teeth_b = 20;
  for (const Solver solver : choices<Solver>()) {
    CAPTURE(solver);
    if (solves_couplings(solver)) {
      CHECK_NOTHROW(World(scene, settings_for(solver), {"serial", {}}).step());
      continue;
    }
    CHECK_THROWS_WITH(World(scene, settings_for(solver), {"serial", {}}),
                      ContainsSubstring(std::string("the solver ") + name_of(solver) +
                                        " has no couplings, of which the scene has 1; soft-step, pgs, nncg, xpbd, "
                                        "jacobi, direct have them"));
  }
}

TEST_CASE("joined bodies of a batch keep their types, and what is refused is named by the numbers of its world")
{
  const Scene free = [] {
    Scene scene = two_joined_and_one_free();
    scene.joints.erase(scene.joints.begin());
    return scene;
  }();
  Worlds batch(std::vector<Scene>{two_joined_and_one_free(), free, two_joined_and_one_free()}, {}, {"serial", {}});
  const auto set = [&](uint32_t world, uint32_t body, const BodyProperties &properties) {
    batch.set_properties(std::vector<WorldBody>{{world, body}}, std::vector<BodyProperties>{properties});
  };
  const uint64_t before = batch.state_hash(2);
  CHECK_THROWS_WITH(set(2, 1, {.type = BodyType::fixed}),
                    "set_properties: world 2: body 1: its type cannot change in a batch, because joint 0 holds it");
  CHECK_THROWS_WITH(set(1, 2, {.type = BodyType::kinematic}),
                    "set_properties: world 1: body 2: its type cannot change in a batch, because joint 0 holds it");
  CHECK_THROWS_WITH(set(2, 2, {.type = BodyType::kinematic}),
                    ContainsSubstring("world 2: body 2") && ContainsSubstring("joint 1 holds it"));
  CHECK_THROWS_WITH(set(1, 3, {.mass = -1.0f}), ContainsSubstring("set_properties: world 1: body 3: mass is -1"));
  CHECK_NOTHROW(set(2, 1, {.type = BodyType::dynamic}));
  CHECK_NOTHROW(set(1, 1, {.type = BodyType::fixed}));
  CHECK(batch.state_hash(2) == before);
}

TEST_CASE("axes of joints of a batch that are refused are named by the numbers of their world")
{
  Scene scene = two_joined_and_one_free();
  scene.joints[0].rotations[0].friction = 1;
  Worlds batch(std::vector<Scene>(3, scene), {}, {"serial", {}});
  const auto set = [&](uint32_t world, uint32_t joint, const JointAxis &axis) {
    batch.set_joint_axes(std::vector<WorldJoint>{{world, joint}}, std::vector<JointAxisChange>{{3, axis}});
  };
  CHECK_THROWS_WITH(set(2, 0, {.friction = -1}), ContainsSubstring("set_joint_axes: world 2: joint 0: rotations[0]"));
  CHECK_THROWS_WITH(set(1, 0, {}), ContainsSubstring("set_joint_axes: world 1: joint 0: an axis would come or go"));
  CHECK_THROWS_WITH(set(1, 0, {.lower = -1, .upper = 1, .restitution = 0.5f}),
                    ContainsSubstring("world 1: joint 0: an axis would come or go, or begin to bounce"));
  CHECK_NOTHROW(set(1, 0, {.friction = 2}));
}

TEST_CASE("a cone of a batch that is limited gets friction and loses it, as that of a world alone does")
{
  Scene scene = two_joined_and_one_free();
  scene.joints[0].type = JointType::cone_twist;
  scene.joints[0].rotations[1].upper = 0.5f;
  scene.bodies[1].angular_velocity = {0.3f, 0.5f, 0.7f};
  Worlds batch(std::vector<Scene>(2, scene), {}, {"serial", {}});
  World alone(scene, {}, {"serial", {}});
  const auto bodies_of_batch = [&] {
    const std::vector<BodyState> all = batch.bodies();
    return std::vector<BodyState>(all.begin() + ptrdiff_t(scene.bodies.size()), all.end());
  };
  for (const float friction : {0.0f, 2.0f, 0.0f}) {
    const JointAxisChange change{4, {.upper = 0.5f, .friction = friction}};
    batch.set_joint_axes(std::vector<WorldJoint>{{1, 0}}, std::span(&change, 1));
    alone.set_joint_axis(alone.id_of_joint(0), 4, change.to);
    for (int step = 0; step < 5; ++step) {
      batch.step();
      alone.step();
    }
    CAPTURE(friction);
    const std::vector<BodyState> of_batch = bodies_of_batch(), of_world = alone.bodies();
    for (size_t body = 0; body < of_world.size(); ++body) {
      CHECK(of_batch[body].position == of_world[body].position);
      CHECK(of_batch[body].angular_velocity == of_world[body].angular_velocity);
    }
  }
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
