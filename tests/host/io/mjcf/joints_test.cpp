/* joints_test.cpp - joints, actuators and equalities of MJCF: limits, springs and drives by hand, and groups of joints
 * of one body that are driven to angles whose rotation Eigen computes in double. */
#include <numbers>

#include <tandem/world.h>

#include "tests/host/io/robot_text.h"

using namespace tandem;
using namespace tandem::robot_text;

namespace {

/* A box on joints to the world. */
std::string on_joints(const std::string &joints)
{
  return R"(<worldbody><body name="arm" pos="1 2 3" euler="10 20 30">)" + joints +
         R"(<geom type="box" size="0.1 0.2 0.3" pos="0.1 0 0.2"/></body></worldbody>)";
}

std::string actuators(const std::string &inside) { return "<actuator>" + inside + "</actuator>"; }

JointAxis axis_of(const std::string &joint, const std::string &actuator = "")
{
  const Scene scene = mjcf(on_joints("<joint name=\"j\" " + joint + "/>") + actuators(actuator));
  const Joint &only = scene.joints.at(0);
  return only.type == JointType::slider ? only.directions[0] : only.rotations[0];
}

/* Where the body ends if strong drives pull its joints to these angles, without gravity. */
Body driven(const std::vector<std::pair<std::string, double>> &hinges)
{
  std::string joints, drives;
  for (size_t k = 0; k < hinges.size(); ++k) {
    const std::string name = "h" + std::to_string(k);
    joints += "<joint name=\"" + name + "\" pos=\"0.3 0 0\" axis=\"" + hinges[k].first + "\"/>";
    /* the control of an actuator is 0, so the reference says how far the joint is from it */
    joints.insert(joints.size() - 2, " ref=\"" + std::to_string(-hinges[k].second / degree) + "\"");
    drives += "<position joint=\"" + name + "\" kp=\"1e5\" kv=\"1e4\"/>";
  }
  const Scene scene = mjcf(R"(<option gravity="0 0 0"/>)" + on_joints(joints) + actuators(drives));
  World world(scene, {}, {"serial", {}});
  for (int k = 0; k < 240; ++k) world.step();
  Body body = scene.bodies.at(0);
  const BodyState state = world.bodies()[0];
  body.position = state.position;
  body.orientation = state.orientation;
  return body;
}

/* The same in double: about the axes one after the other, through the place that all of them go through. */
void check_driven(const std::vector<std::pair<std::string, double>> &hinges, const std::vector<Vector3d> &axes)
{
  const Quaterniond placed =
      Quaterniond(AngleAxisd(10 * degree, Vector3d::UnitX()) * AngleAxisd(20 * degree, Vector3d::UnitY()) *
                  AngleAxisd(30 * degree, Vector3d::UnitZ()));
  Quaterniond turned = placed;
  for (size_t k = 0; k < hinges.size(); ++k) turned = turned * AngleAxisd(hinges[k].second, axes[k].normalized());
  const Vector3d anchor = Vector3d(1, 2, 3) + placed * Vector3d(0.3, 0, 0);
  const Vector3d center = anchor + turned * Vector3d(-0.2, 0, 0.2);
  const Body body = driven(hinges);
  const Quaterniond actual = turn_of(body.orientation) * turn_of(body.shape_orientation);
  CAPTURE(actual.coeffs().transpose(), turned.coeffs().transpose(), center.transpose());
  CHECK(actual.angularDistance(turned) < 1e-3);
  CHECK((vector_of_point(body.position) - center).norm() < 1e-3);
}

} // namespace

TEST_CASE("mjcf: a hinge has its limits in degrees, its spring, losses and bound of force")
{
  const JointAxis axis =
      axis_of(R"(range="-90 45" ref="15" stiffness="3" springref="30" damping="0.5" frictionloss="0.2"
                                    actuatorfrcrange="-4 6")");
  CHECK(axis.lower == Approx(-105 * degree));
  CHECK(axis.upper == Approx(30 * degree));
  CHECK(axis.stiffness == 3.0f);
  CHECK(axis.target_position == Approx(15 * degree));
  CHECK(axis.damping == 0.5f);
  CHECK(axis.friction == 0.2f);
  CHECK(axis.max_force == 6.0f);
  const JointAxis slide = axis_of(R"(type="slide" range="-2 1" ref="0.5" stiffness="3" springref="1")");
  CHECK(slide.lower == -2.5f);
  CHECK(slide.upper == 0.5f);
  CHECK(slide.target_position == 0.5f);
  CHECK(axis_of(R"(range="-90 45" limited="false")").upper == JointAxis::unlimited);
}

TEST_CASE("mjcf: actuators drive as springs and dampers, together with those of the joint")
{
  const JointAxis both = axis_of(R"(stiffness="3" springref="40" damping="1")",
                                 R"(<position joint="j" kp="1" kv="2" gear="3" ctrlrange="1 2" forcerange="-5 4"/>)");
  CHECK(both.stiffness == 12.0f);
  CHECK(both.target_position == Approx((3 * 40 * degree + 9 * (1.0 / 3)) / 12)); /* the mean, by stiffness */
  CHECK(both.damping == 19.0f);
  CHECK(both.max_force == 15.0f);
  const JointAxis driven = axis_of(R"(damping="1")", R"(<velocity joint="j" kv="4" ctrlrange="2 3"/>)");
  CHECK(driven.damping == 5.0f);
  CHECK(driven.target_velocity == Approx(4 * 2 / 5.0));
  CHECK(driven.stiffness == 0.0f);
  const JointAxis motor = axis_of("", R"(<motor joint="j" gear="40" ctrlrange="-1 0.5"/>)");
  JointAxis still; /* until a program sets its control */
  still.damping = motor.damping;
  CHECK(motor == still);
  CHECK(motor.damping == Approx(1e-11f * 40));
  const auto damping_with = [&](const char *joint, const char *drive) { return axis_of(joint, drive).damping; };
  CHECK(damping_with(R"(damping="0.25")", R"(<motor joint="j" gear="40"/>)") == 0.25f);
  CHECK(damping_with(R"(damping="1e-13")", R"(<motor joint="j" gear="40"/>)") == Approx(4e-7f));
  CHECK(damping_with("", R"(<motor joint="j"/>)") == Approx(1e-8f));
  CHECK(damping_with("", R"(<motor joint="j" ctrlrange="-1e10 1e10"/>)") == Approx(1e-6f));
  CHECK(damping_with("", R"(<motor joint="j" ctrlrange="-0.1 0.1"/>)") == Approx(1e-11f));
}

TEST_CASE("mjcf: two hinges turn as one after the other, whichever way their axes point")
{
  for (const auto &[first, second] : {std::pair(0.7, -0.4), std::pair(-1.1, 0.9)}) {
    check_driven({{"0 0 1", first}, {"0 1 0", second}}, {{0, 0, 1}, {0, 1, 0}});
    check_driven({{"-1 0 0", first}, {"0 0 -2", second}}, {{-1, 0, 0}, {0, 0, -1}});
    check_driven({{"2 1 1", first}, {"0 -1 1", second}}, {{2, 1, 1}, {0, -1, 1}});
  }
}

TEST_CASE("mjcf: three hinges turn as each of them alone, and nearly as one after the other at small angles")
{
  const std::vector<Vector3d> axes{{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  for (const auto &[a, b, c] :
       {std::array{0.6, 0.0, 0.0}, {0.0, -0.7, 0.0}, {0.0, 0.0, 1.3}, {0.5, 0.0, -0.8}, {0.0, 0.4, 0.6}})
    check_driven({{"-1 0 0", a}, {"0 0 -1", b}, {"0 1 0", c}}, axes);
}

TEST_CASE("mjcf: a slide and a hinge of one body are one joint, in this order")
{
  const Scene scene =
      mjcf(on_joints(R"(<joint type="slide" axis="1 0 0" range="-1 2"/><joint type="slide" axis="0 0 1"/>
                                        <joint axis="0 -1 0" range="-30 60"/>)"));
  REQUIRE(scene.joints.size() == 1);
  const Joint &joint = scene.joints[0];
  CHECK(joint.type == JointType::six_dof);
  CHECK(joint.held_directions == Axes{true, false, false});
  CHECK(joint.held_rotations == Axes{false, true, true});
  CHECK(joint.directions[1].lower == -1.0f);
  CHECK(joint.directions[1].upper == 2.0f);
  CHECK(joint.rotations[0].upper == Approx(60 * degree));
}

TEST_CASE("mjcf: connect closes a loop by a ball joint and weld by a fixed one, where the bodies stand")
{
  const std::string bodies =
      R"(<worldbody><body name="a" pos="0 0 1" euler="0 90 0"><freejoint/><geom size="0.1"/></body>
    <body name="b" pos="1 0 1"><freejoint/><geom size="0.1"/></body></worldbody>)";
  const Scene ball_joint =
      mjcf(bodies + R"(<equality><connect name="c" body1="a" body2="b" anchor="0 0 0.5"/></equality>)");
  const Joint &ball = ball_joint.joints.at(0);
  CHECK(ball.name == "c");
  CHECK(ball.type == JointType::ball);
  for (const FrameInWorld &frame : {frame_a(ball_joint, ball), frame_b(ball_joint, ball)})
    CHECK((frame.at - Vector3d(0.5, 0, 1)).norm() < 1e-6);
  const Scene welded = mjcf(bodies + R"(<equality><weld body1="a" body2="b"/></equality>)");
  const Joint &weld = welded.joints.at(0);
  CHECK(weld.type == JointType::fixed);
  CHECK((frame_a(welded, weld).at - frame_b(welded, weld).at).norm() < 1e-6);
  CHECK((frame_a(welded, weld).axes - frame_b(welded, weld).axes).norm() < 1e-6);
  const Scene placed = mjcf(bodies + R"(<equality><weld body1="a" body2="b" relpose="0 0 2 1 0 0 0"/></equality>)");
  CHECK((frame_a(placed, placed.joints.at(0)).at - Vector3d(2, 0, 1)).norm() < 1e-6); /* z of a is x of the world */
  CHECK((frame_b(placed, placed.joints.at(0)).at - Vector3d(1, 0, 1)).norm() < 1e-6);
  const Scene world = mjcf(bodies + R"(<equality><connect body1="a" anchor="0 0 0"/></equality>)");
  CHECK(world.joints.at(0).body_b == no_body);
}

TEST_CASE("mjcf: one joint that follows another is coupled with it, whichever way the axes of its frame point")
{
  const Scene scene = mjcf(R"(<worldbody><body><joint name="p"/><geom size="1"/></body>
    <body><joint name="r" axis="-1 0 0"/><joint name="q" axis="0 -1 0"/><geom size="1"/></body></worldbody>
    <equality><joint joint1="p" joint2="q" polycoef="0.25 2 0 0 0"/><joint joint1="r" polycoef="0.5"/>
      <joint joint1="q" joint2="p" polycoef="0 1 1 0 0"/></equality>)");
  REQUIRE(scene.joints.size() == 2);
  REQUIRE(scene.couplings.size() == 2);
  const Coupling &follows = scene.couplings[0];
  CHECK((follows.type == CouplingType::mimic && follows.joint_a == 0 && follows.joint_b == 1));
  CHECK(follows.coordinate_a == JointCoordinate::rotation_x);
  CHECK(follows.coordinate_b == JointCoordinate::rotation_x);
  CHECK(follows.ratio == -2.0f);
  CHECK(follows.offset == 0.25f);
  const JointAxis &held = scene.joints[1].rotations[1];
  CHECK((held.lower == 0.5f && held.upper == 0.5f));
  CHECK(has_note(scene, "polycoef beyond its second number is not held"));
}

TEST_CASE("mjcf: in reduced coordinates one joint of a tree follows another, and a joint is held")
{
  const Scene scene = parse_scene_mjcf(R"(<mujoco><worldbody><body><joint name="p"/><geom size="1"/>
    <body><joint name="q" axis="-1 0 0"/><geom size="1"/></body><body><joint name="r"/><geom size="1"/></body>
    </body></worldbody><equality><joint joint1="p" joint2="q" polycoef="0.25 2 0 0 0"/>
    <joint joint1="r" polycoef="0.5"/></equality></mujoco>)",
                                       "tree.xml", OutsideFiles::refused, Coordinates::reduced);
  REQUIRE(scene.couplings.size() == 1);
  CHECK(scene.couplings[0].ratio == -2.0f);
  CHECK(scene.joints[2].rotations[0].lower == 0.5f);
  REQUIRE(scene.articulations.size() == 1);
  CHECK(scene.articulations[0].joints.size() == 3);
}

TEST_CASE("mjcf: joints of two trees that follow each other hold no links")
{
  const Scene scene = parse_scene_mjcf(R"(<mujoco><worldbody><body><joint name="p"/><geom size="1"/></body>
    <body><joint name="q"/><geom size="1"/></body><body><joint name="r"/><geom size="1"/></body></worldbody>
    <equality><joint joint1="p" joint2="q"/></equality></mujoco>)",
                                       "tree.xml", OutsideFiles::refused, Coordinates::reduced);
  CHECK(scene.couplings.size() == 1);
  CHECK(scene.articulations.size() == 1);
  CHECK(has_note(scene, "is coupled with none of its tree"));
}
