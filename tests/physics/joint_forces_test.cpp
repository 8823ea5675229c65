/* The force of a joint's axis against closed forms, in maximal and in reduced coordinates: what an actuator exerts. */
#include <tandem/articulations.h>

#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* A cube of 1 m that a joint along or about y holds to the world, without gravity. */
struct Actuated {
  Scene scene = empty_scene({0, 0, 0});
  Actuated(JointType type, const JointAxis &axis, bool reduced, float armature = 0)
  {
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0, 0}).mass = 3;
    Joint &joint = connect(scene, type, no_body, 0, Vector::Zero(), Vector::UnitY());
    (type == JointType::slider ? joint.directions : joint.rotations)[0] = axis;
    if (reduced) make_articulations(scene, "test", std::vector<float>{armature});
    REQUIRE(scene.articulations.size() == (reduced ? 1 : 0));
  }
  double inertia() const { return scene.joints[0].type == JointType::slider ? 3.0 : 0.5; } /* m a^2 / 6 */
  double speed(World &world) const
  {
    const BodyState body = world.bodies()[0];
    return double(scene.joints[0].type == JointType::slider ? body.linear_velocity[1] : body.angular_velocity[1]);
  }
  double coordinate(World &world) const
  {
    const JointId joint = world.id_of_joint(0);
    const JointReading reading = world.read_joints({&joint, 1})[0];
    return scene.joints[0].type == JointType::slider ? reading.directions[0] : reading.rotations[0];
  }
};

JointType either_type() { return GENERATE(JointType::hinge, JointType::slider); }

} // namespace

TEST_CASE("the force of an axis accelerates what it moves, and an armature adds to its inertia", "[physics]")
{
  const bool reduced = GENERATE(false, true);
  const float force = GENERATE(2.5f, -0.003f, 4000.0f), armature = reduced ? 0.7f : 0.0f;
  const Actuated one(either_type(), {.force = force}, reduced, armature);
  World world(one.scene);
  run(world, 30);
  const double expected = double(force) / (one.inertia() + double(armature)) * 0.5;
  CHECK(std::abs(one.speed(world) - expected) < 1e-5 * std::abs(expected));
}

TEST_CASE("the force of an axis stretches its spring, and its damper limits the speed", "[physics]")
{
  const bool reduced = GENERATE(false, true);
  const JointType type = either_type();
  const Actuated held(type, {.target_position = 0.1f, .stiffness = 50, .damping = 20, .force = 10}, reduced);
  World world(held.scene);
  run(world, 600);
  CHECK(std::abs(held.coordinate(world) - (0.1 + 10.0 / 50)) < 1e-5);
  const Actuated weak(type, {.target_position = 0.1f, .stiffness = 50, .force = 10}, reduced); /* no damper */
  World swinging(weak.scene);
  double least = 1, most = 0;
  for (int step = 0; step < 300; ++step) {
    swinging.step();
    least = std::min(least, weak.coordinate(swinging));
    most = std::max(most, weak.coordinate(swinging));
  }
  CHECK(std::abs(0.5 * (least + most) - 0.3) < 0.02); /* it swings about the same place, from 0, less and less */
  const Actuated braked(type, {.damping = 20, .force = 10}, reduced);
  World turning(braked.scene);
  run(turning, 300);
  CHECK(std::abs(braked.speed(turning) - 10.0 / 20) < 1e-5);
}

TEST_CASE("the largest force of an axis bounds its force, and friction resists it", "[physics]")
{
  const bool reduced = GENERATE(false, true);
  const JointType type = either_type();
  const Actuated bounded(type, {.force = 30, .max_force = 6}, reduced);
  World world(bounded.scene);
  run(world, 30);
  CHECK(std::abs(bounded.speed(world) - 6 / bounded.inertia() * 0.5) < 1e-4 * 6 / bounded.inertia());
  const Actuated stuck(type, {.force = 5, .friction = 5.1f}, reduced),
      slipping(type, {.force = 5, .friction = 2}, reduced);
  World still(stuck.scene), moving(slipping.scene);
  run(still, 120);
  CHECK(std::abs(stuck.coordinate(still)) < 1e-4);
  run(moving, 30);
  CHECK(std::abs(slipping.speed(moving) - 3 / slipping.inertia() * 0.5) < 1e-3 * 3 / slipping.inertia());
}

TEST_CASE("the force of an axis changes while the world runs, and the torque of a free pair changes no momentum",
          "[physics]")
{
  const bool reduced = GENERATE(false, true);
  Scene scene = empty_scene({0, 0, 0});
  for (int k = 0; k < 2; ++k)
    add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.3f, 0.4f), {0, 0, 0}).mass = float(1 + k);
  connect(scene, JointType::hinge, 0, 1, Vector::Zero(), Vector::UnitY()).rotations[0].force = 1;
  if (reduced) make_articulations(scene, "test");
  World world(scene);
  run(world, 20);
  const Momentum moving = momentum_of(world);
  CHECK(moving.linear.norm() < 1e-5);
  CHECK(moving.angular.norm() < 1e-5);
  const JointId joint = world.id_of_joint(0);
  const double speed = world.read_joints({&joint, 1})[0].rotation_speeds[0];
  CHECK(speed > 1);
  const JointAxisChange back{3, {.force = -1}};
  world.set_joint_axes({&joint, 1}, {&back, 1});
  run(world, 20);
  CHECK(std::abs(world.read_joints({&joint, 1})[0].rotation_speeds[0]) < 1e-4 * speed);
  const JointAxisChange motor{3, {.motor = true, .force = 1}};
  CHECK_THROWS_AS(world.set_joint_axes({&joint, 1}, {&motor, 1}), InputError);
}
