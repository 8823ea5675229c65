/* Joints that a program creates, changes, reads and destroys while a world runs, and joints that break, do what theory
 * says from the next step on. */
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* A box that a ball joint holds at its centre in the air. */
Scene held_box()
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.3f, 0.3f), {0, 5, 0});
  connect(scene, JointType::ball, no_body, 0, {0, 5, 0});
  return scene;
}

double speed_of_fall(World &world, uint32_t body) { return -double(world.bodies()[body].linear_velocity[1]); }

/* A bar of a metre that sticks out from the world along x, on a joint at its end. */
Scene cantilever(JointType type, float mass = 3)
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {0.5, 0, 0}).mass = mass;
  connect(scene, type, no_body, 0, Vector::Zero(), Vector::UnitZ());
  return scene;
}

std::string refusal(const std::function<void()> &call)
{
  try {
    call();
  } catch (const InputError &error) {
    return error.what();
  }
  return "nothing";
}

} // namespace

TEST_CASE("calls of joints: a body falls freely from the step on in which its joint is destroyed, and not before")
{
  World world(held_box(), {}, on_serial);
  run(world, 30);
  CHECK(speed_of_fall(world, 0) == Approx(0).margin(1e-3));
  const JointId joint = world.id_of_joint(0);
  world.destroy_joint(joint);
  CHECK_FALSE(world.exists(joint));
  const double before = speed_of_fall(world, 0);
  run(world, 30);
  CHECK(speed_of_fall(world, 0) - before == Approx(gravity * 0.5).epsilon(1e-5));
  CHECK_THAT(refusal([&] { world.destroy_joint(joint); }),
             Catch::Contains("joint 0 of generation 1 does not exist any more"));
  CHECK_THAT(refusal([&] { world.read_joint(joint); }), Catch::Contains("read_joints: joint 0 of generation 1"));
  CHECK_THAT(refusal([&] { world.id_of_joint(0); }), Catch::Contains("joint 0 does not exist"));

  Joint hold;
  hold.body_b = 0;
  hold.position_a = world.bodies()[0].position;
  const JointId again = world.create_joint(hold);
  CHECK(again == JointId{0, 2});
  run(world, 60);
  CHECK(speed_of_fall(world, 0) == Approx(0).margin(1e-3));
  CHECK(open_joints(world).max_distance < 5e-3);
}

TEST_CASE("calls of joints: the forces of a chain are the weights below, each of them also after joints were created")
{
  World world(hanging_boxes(5, 2), {}, on_serial);
  run(world, 240);
  const auto forces_are_weights = [&](int boxes) {
    const std::vector<JointId> ids = world.joint_ids();
    const std::vector<JointReading> readings = world.read_joints(ids);
    REQUIRE(readings.size() == size_t(boxes));
    for (int k = 0; k < boxes; ++k) {
      CAPTURE(k, boxes);
      CHECK(readings[size_t(k)].force[1] == Approx(2 * gravity * (boxes - k)).epsilon(2e-3));
      CHECK(std::abs(readings[size_t(k)].force[0]) < 1e-3);
      CHECK(readings[size_t(k)].torque[2] == Approx(0).margin(1e-6));
    }
  };
  forces_are_weights(5);
  Body more = world.scene().bodies[4];
  more.position = {world.bodies()[4].position[0], world.bodies()[4].position[1] - 1, 0};
  world.create_body(more);
  Joint joint = world.scene().joints[4];
  joint.body_a = 4;
  joint.body_b = 5;
  world.create_joint(joint);
  run(world, 240);
  forces_are_weights(6);
}

TEST_CASE("calls of joints: the torque of a fixed joint is that of the weight at its arm, and springs pull as they say")
{
  World fixed(cantilever(JointType::fixed), {}, on_serial);
  run(fixed, 120);
  const JointReading held = fixed.read_joint(fixed.id_of_joint(0));
  CHECK(held.force[1] == Approx(3 * gravity).epsilon(1e-3));
  CHECK(held.torque[2] == Approx(3 * gravity * 0.5).epsilon(5e-3));

  Scene scene = cantilever(JointType::hinge);
  scene.joints[0].rotations[0].stiffness = 200;
  scene.joints[0].rotations[0].damping = 30;
  World sprung(scene, {}, on_serial);
  run(sprung, 600);
  const JointReading spring = sprung.read_joint(sprung.id_of_joint(0));
  CHECK(spring.rotations[0] < -0.05);
  CHECK(spring.torque[2] == Approx(-200 * spring.rotations[0]).epsilon(1e-3));
  CHECK(spring.torque[2] == Approx(3 * gravity * 0.5 * std::cos(spring.rotations[0])).epsilon(1e-3));
  CHECK(std::abs(spring.rotation_speeds[0]) < 1e-4);
}

TEST_CASE("calls of joints: a reading has the angle and speed of a hinge, and the way and speed of a slider")
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {0, 0, 0}).angular_velocity = {0, 0, 0.5f};
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {0, 3, 0}).linear_velocity = {0, 0.25f, 0};
  connect(scene, JointType::slider, no_body, 1, {0, 3, 0}, Vector::UnitY());
  World world(scene, {}, on_serial);
  run(world, 60);
  const JointReading hinge = world.read_joint(world.id_of_joint(0)), slider = world.read_joint(world.id_of_joint(1));
  CHECK(hinge.rotations[0] == Approx(0.5).epsilon(1e-4));
  CHECK(hinge.rotation_speeds[0] == Approx(0.5).epsilon(1e-4));
  CHECK(slider.directions[0] == Approx(0.25).epsilon(1e-4));
  CHECK(slider.direction_speeds[0] == Approx(0.25).epsilon(1e-4));
}

TEST_CASE("calls of joints: a motor takes the speed that a call gives it, and another one later")
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.1f), {0, 0, 0});
  connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ());
  World world(scene, {}, on_serial);
  JointAxis motor;
  motor.motor = true;
  for (const float speed : {2.0f, -3.0f, 0.5f}) { /* the first one brings in an axis, the others change it */
    motor.target_velocity = speed;
    world.set_joint_axis(world.id_of_joint(0), 3, motor);
    run(world, 10);
    CHECK(double(world.bodies()[0].angular_velocity[2]) == Approx(speed).epsilon(1e-5));
    CHECK(world.scene().joints[0].rotations[0] == motor);
  }
  CHECK_THAT(refusal([&] { world.set_joint_axis(world.id_of_joint(0), 0, motor); }),
             Catch::Contains("directions[0] is not free in a joint of type hinge"));
  CHECK_THAT(refusal([&] { world.set_joint_axis(world.id_of_joint(0), 6, motor); }),
             Catch::Contains("axis 6 does not exist"));
}

TEST_CASE("calls of joints: a spring to a place in the world carries a body along as the place moves")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), {0, 0, 0});
  Joint hand;
  hand.type = JointType::six_dof;
  hand.body_b = 0;
  for (JointAxis &axis : hand.directions) axis.stiffness = 400, axis.damping = 40, axis.max_force = 1000;
  scene.joints.push_back(hand);
  World world(scene, {}, on_serial);
  const double sag = gravity / 400;
  for (int k = 1; k <= 120; ++k) {
    hand.position_a = {k / 60.0, 0, 0};
    world.set_joint(world.id_of_joint(0), hand);
    world.step();
  }
  const double lag = 40.0 / 400; /* of a place that moves at 1 m/s */
  const Point moving = world.bodies()[0].position;
  CHECK(moving[0] == Approx(2 - lag).margin(0.02));
  CHECK(moving[1] == Approx(-sag).margin(1e-3));
  run(world, 240);
  CHECK(world.bodies()[0].position[0] == Approx(2).margin(1e-4));
}

TEST_CASE("joints that break: a load just below the limit holds, and one just above it breaks the joint at once")
{
  for (const auto &[share, breaks] : {std::pair(1.05, false), std::pair(0.95, true)}) {
    CAPTURE(share);
    World hanging(hanging_boxes(3, 2), {}, on_serial), leaning(cantilever(JointType::fixed), {}, on_serial);
    run(hanging, 240); /* a load that comes at once pulls by more than its weight */
    run(leaning, 240);
    Joint link = hanging.scene().joints[1], root = leaning.scene().joints[0];
    link.break_force = float(share * 2 * 2 * gravity);
    root.break_torque = float(share * 3 * gravity * 0.5);
    hanging.set_joint(hanging.id_of_joint(1), link);
    leaning.set_joint(leaning.id_of_joint(0), root);
    std::vector<JointBreak> of_chain, of_bar;
    for (int k = 0; k < 120; ++k) {
      hanging.step();
      leaning.step();
      of_chain.insert(of_chain.end(), hanging.joint_breaks().begin(), hanging.joint_breaks().end());
      of_bar.insert(of_bar.end(), leaning.joint_breaks().begin(), leaning.joint_breaks().end());
    }
    REQUIRE(of_chain.size() == (breaks ? 1 : 0));
    REQUIRE(of_bar.size() == (breaks ? 1 : 0));
    CHECK(hanging.scene().joints[1].enabled == !breaks);
    if (!breaks) continue;
    CHECK(of_chain[0].joint == JointId{1, 1});
    CHECK(of_chain[0].force > link.break_force);
    CHECK(of_bar[0].torque > root.break_torque);
    CHECK(hanging.exists(JointId{1, 1})); /* it may be enabled again */
    CHECK(hanging.read_joint(JointId{1, 1}).force == std::array<double, 3>{0, 0, 0});
  }
}

TEST_CASE("joints that break: parts of a broken chain fall freely, and the others hang on")
{
  Scene scene = hanging_boxes(3, 2);
  scene.joints[1].break_force = 1;
  World world(scene, {}, on_serial);
  world.step();
  REQUIRE(world.joint_breaks().size() == 1);
  const double before = speed_of_fall(world, 1);
  run(world, 30);
  CHECK(world.joint_breaks().empty());
  CHECK(speed_of_fall(world, 1) - before == Approx(0.5 * gravity).epsilon(1e-3));
  CHECK(speed_of_fall(world, 2) == Approx(speed_of_fall(world, 1)).epsilon(1e-3)); /* still joined */
  CHECK(speed_of_fall(world, 0) == Approx(0).margin(1e-2));
}

TEST_CASE("joints that break: the two bodies collide from then on")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::fixed, box_shape(0.5f, 0.5f, 0.5f), {0, 0.5, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 1.45, 0}).mass = 10;
  connect(scene, JointType::ball, 1, 2, {0, 1.0, 0});
  for (JointAxis &axis : scene.joints[0].rotations) axis.stiffness = 1000, axis.damping = 100;
  World joined(scene, {}, on_serial);
  run(joined, 30);
  CHECK(joined.statistics().manifolds == 0);
  scene.joints[0].break_force = 50;
  World world(scene, {}, on_serial);
  run(world, 60);
  CHECK_FALSE(world.scene().joints[0].enabled);
  CHECK(world.statistics().manifolds == 1);
  CHECK(world.bodies()[2].position[1] == Approx(1.5).margin(0.02)); /* it lies on the other one */
}

TEST_CASE("joints that break: momentum stays while they do")
{
  Scene scene = empty_scene({0, 0, 0});
  Random random(7);
  for (int k = 0; k < 12; ++k) {
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.2f, 0.2f), {1.0 * k, 0, 0});
    body.linear_velocity = vec3_of(3 * direction(random));
    body.angular_velocity = vec3_of(direction(random));
    if (k > 0)
      connect(scene, k % 2 ? JointType::ball : JointType::hinge, uint32_t(k - 1), uint32_t(k), {k - 0.5, 0, 0})
          .break_force = float(20 * k);
  }
  World world(scene, {}, on_serial);
  const Conserved before = conserved_quantities(world.scene(), world.precise_bodies());
  size_t breaks = 0;
  for (int k = 0; k < 120; ++k) {
    world.step();
    breaks += world.joint_breaks().size();
  }
  CHECK(breaks >= 3);
  CHECK(breaks <= 10);
  const Conserved after = conserved_quantities(world.scene(), world.precise_bodies());
  for (size_t k = 0; k < 3; ++k) CHECK(after.momentum[k] == Approx(before.momentum[k]).margin(1e-4));
}

TEST_CASE("calls of joints: a destroyed body takes its joints along, and a type changes while a dynamic body is left")
{
  World world(hanging_boxes(4, 1), {}, on_serial);
  run(world, 10);
  world.destroy_body(world.id_of(1));
  CHECK(world.joint_ids() == std::vector<JointId>{{0, 1}, {3, 1}});
  run(world, 30);
  CHECK(speed_of_fall(world, 2) > 4);
  CHECK(speed_of_fall(world, 0) == Approx(0).margin(1e-2));

  World fixed(hanging_boxes(3, 1), {}, on_serial);
  run(fixed, 10);
  fixed.set_type(fixed.id_of(1), BodyType::kinematic);
  run(fixed, 120);
  CHECK(open_joints(fixed).max_distance < 0.02);
  CHECK_THAT(refusal([&] { fixed.set_type(fixed.id_of(2), BodyType::fixed); }),
             Catch::Contains("joint 2 would have no dynamic body"));
  fixed.set_type(fixed.id_of(1), BodyType::dynamic);
  run(fixed, 120);
  CHECK(open_joints(fixed).max_distance < 0.02);
  CHECK(speed_of_fall(fixed, 2) == Approx(0).margin(0.05));
}

TEST_CASE("calls of joints: bad ones are refused in one line and change nothing")
{
  World world(hanging_boxes(2, 1), {}, on_serial);
  run(world, 5);
  const uint64_t before = world.state_hash();
  Joint joint;
  joint.body_b = 7;
  CHECK_THAT(refusal([&] { world.create_joint(joint); }), Catch::Contains("body_b 7 does not exist"));
  joint.body_b = 1;
  joint.break_force = 0;
  CHECK_THAT(refusal([&] { world.create_joint(joint); }), Catch::Contains("break_force is 0; more than 0 is needed"));
  joint.break_force = std::numeric_limits<float>::quiet_NaN();
  CHECK_THAT(refusal([&] { world.create_joint(joint); }), Catch::Contains("break_force is nan"));
  joint = {};
  joint.enabled = false;
  CHECK_THAT(refusal([&] { world.create_joint(joint); }), Catch::Contains("it has no body"));
  CHECK_THAT(refusal([&] {
               world.destroy_joints(std::vector<JointId>{{0, 1}, {0, 1}});
             }),
             Catch::Contains("joint 0 is given twice"));
  CHECK_THAT(refusal([&] {
               world.set_joints(std::vector<JointId>{{0, 1}}, {});
             }),
             Catch::Contains("1 handles and 0 joints"));
  world.destroy_body(world.id_of(1));
  joint.enabled = true;
  joint.body_b = 1;
  CHECK_THAT(refusal([&] { world.create_joint(joint); }), Catch::Contains("body 1 does not exist any more"));
  World same(hanging_boxes(2, 1), {}, on_serial);
  run(same, 5);
  CHECK(same.state_hash() == before);
}
