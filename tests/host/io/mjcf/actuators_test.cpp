/* actuators_test.cpp - actuators of MJCF as maps from controls to numbers of axes, by hand. */
#include <tandem/world.h>

#include "tests/host/io/robot_text.h"

using namespace tandem;
using namespace tandem::robot_text;

namespace {

/* A box on joints to the world, with what drives them. */
std::string driven_text(const std::string &joints, const std::string &drives)
{
  return "<mujoco><worldbody><body>" + joints +
         R"(<geom type="box" size="0.1 0.2 0.3"/></body></worldbody><actuator>)" + drives + "</actuator></mujoco>";
}

Scene driven_scene(const std::string &joints, const std::string &drives, Coordinates coordinates = Coordinates::maximal)
{
  return parse_scene_mjcf(driven_text(joints, drives), mjcf_path, OutsideFiles::refused, coordinates);
}

Actuator only_actuator(const std::string &joint, const std::string &drive)
{
  const Scene scene = driven_scene("<joint name=\"j\" " + joint + "/>", drive);
  REQUIRE(scene.actuators.size() == 1);
  return scene.actuators[0];
}

} // namespace

TEST_CASE("mjcf: a motor sets the force of its axis, by its gear and within its range")
{
  const Scene scene =
      driven_scene(R"(<joint name="j"/>)", R"(<motor name="m" joint="j" gear="40" ctrlrange="-1 0.5"/>)");
  REQUIRE(scene.actuators.size() == 1);
  const Actuator &motor = scene.actuators[0];
  CHECK(motor == Actuator{"m", 0, 3, Control::force, 0, 40, -1, 0.5f});
  CHECK(number_at(motor, 7) == 20);
  CHECK(has_note(scene, "a <motor> exerts nothing until a program sets its control"));
  CHECK(only_actuator(R"(type="slide")", R"(<motor joint="j" gear="-2"/>)") ==
        Actuator{"", 0, 0, Control::force, 0, -2, -Actuator::unlimited, Actuator::unlimited});
}

TEST_CASE("mjcf: the forcerange of a motor bounds its control, before the gear")
{
  const Actuator both = only_actuator("", R"(<motor joint="j" gear="2" ctrlrange="-3 3" forcerange="-1 2"/>)");
  CHECK((both.lower == -1 && both.upper == 2 && both.factor == 2));
  const Actuator beyond = only_actuator("", R"(<motor joint="j" ctrlrange="2 3" forcerange="-1 1"/>)");
  CHECK((beyond.lower == 1 && beyond.upper == 1));
  const Actuator alone = only_actuator("", R"(<motor joint="j" forcerange="-1 2"/>)");
  CHECK((alone.lower == -1 && alone.upper == 2));
}

TEST_CASE("mjcf: what a class says of any actuator holds for all of them, and 0 0 is no range unless it limits")
{
  const auto drive = [](const std::string &defaults, const std::string &drive) {
    const std::string text = "<mujoco><default>" + defaults +
                             R"(</default><worldbody><body><joint name="j"/><geom size="1"/></body></worldbody>)" +
                             "<actuator>" + drive + "</actuator></mujoco>";
    return parse_scene_mjcf(text, mjcf_path, OutsideFiles::refused, Coordinates::maximal).actuators.at(0);
  };
  const Actuator motor = drive(R"(<general ctrlrange="-1 1"/>)", R"(<motor joint="j" gear="40"/>)");
  CHECK((motor.lower == -1 && motor.upper == 1 && motor.factor == 40));
  const Actuator inner = drive(R"(<general ctrlrange="-2 2"/><default class="c"><velocity gear="4"/></default>)",
                               R"(<position class="c" joint="j" kp="3"/>)");
  CHECK((inner.lower == -2 && inner.factor == 0.25f));
  const Actuator own = drive(R"(<motor ctrlrange="-1 1" forcerange="-9 9"/>)", R"(<motor joint="j" ctrlrange="0 5"/>)");
  CHECK((own.lower == 0 && own.upper == 5));
  const Actuator open = drive("", R"(<motor joint="j" ctrlrange="0 0" forcerange="0 0"/>)");
  CHECK((open.lower == -Actuator::unlimited && open.upper == Actuator::unlimited));
  const Actuator shut = drive("", R"(<motor joint="j" ctrllimited="true" ctrlrange="0 0"/>)");
  CHECK((shut.lower == 0 && shut.upper == 0));
}

TEST_CASE("mjcf: a position sets its target by gear and reference")
{
  const Actuator place = only_actuator(R"(ref="90")", R"(<position joint="j" kp="3" kv="0.5" gear="2"/>)");
  CHECK(place.sets == Control::target_position);
  CHECK(place.factor == 0.5f);
  CHECK(double{number_at(place, 1)} == Approx(0.5 - 90 * degree));
  const Actuator backwards = only_actuator("", R"(<position joint="j" gear="-2" ctrlrange="-1 1"/>)");
  CHECK(number_at(backwards, 0.5f) == -0.25f);
  CHECK(number_at(backwards, 5) == -0.5f);
}

TEST_CASE("mjcf: a position beside the spring of its joint sets the mean of both, by stiffness")
{
  const Scene scene = driven_scene(R"(<joint name="j" stiffness="3" springref="40"/>)",
                                   R"(<position joint="j" kp="1" gear="3" ctrlrange="1 2"/>)");
  const Actuator &place = scene.actuators.at(0);
  for (const double control : {1.0, 1.5, 2.0})
    CHECK(double{number_at(place, float(control))} == Approx((3 * 40 * degree + 9 * control / 3) / 12));
  CHECK(number_at(place, 0) == number_at(place, 1));
  CHECK(double{scene.joints[0].rotations[0].target_position} == Approx(double{number_at(place, 1)}));
}

TEST_CASE("mjcf: a velocity sets its target, which the damping of the joint slows")
{
  const Actuator free_one = only_actuator("", R"(<velocity name="v" joint="j" kv="4" gear="-2"/>)");
  CHECK(free_one == Actuator{"v", 0, 3, Control::target_velocity, 0, -0.5f, -Actuator::unlimited, Actuator::unlimited});
  const Actuator slowed = only_actuator(R"(damping="1")", R"(<velocity joint="j" kv="4" ctrlrange="2 3"/>)");
  CHECK(double{number_at(slowed, 2.5f)} == Approx(4 * 2.5 / 5));
  CHECK(double{number_at(slowed, 0)} == Approx(4 * 2 / 5.0));
}

TEST_CASE("mjcf: a position, a velocity and a motor of one joint are controls of their own")
{
  const Scene scene = driven_scene(R"(<joint name="j"/>)", R"(<position name="p" joint="j" kp="10"/>
    <velocity name="v" joint="j" kv="2"/><motor name="m" joint="j" gear="5"/>)");
  REQUIRE(scene.actuators.size() == 3);
  const float unlimited = Actuator::unlimited;
  CHECK(scene.actuators[0] == Actuator{"p", 0, 3, Control::target_position, 0, 1, -unlimited, unlimited});
  CHECK(scene.actuators[1] == Actuator{"v", 0, 3, Control::target_velocity, 0, 1, -unlimited, unlimited});
  CHECK(scene.actuators[2] == Actuator{"m", 0, 3, Control::force, 0, 5, -unlimited, unlimited});
  const JointAxis &axis = scene.joints[0].rotations[0];
  CHECK((axis.stiffness == 10 && axis.damping == 2));
}

TEST_CASE("mjcf: a second actuator of one kind stays where it is, which is noted")
{
  const Scene scene = driven_scene(R"(<joint name="j"/>)", R"(<position name="p" joint="j" kp="3"/>
    <position name="q" joint="j" kp="1" ctrlrange="2 4"/><motor name="m" joint="j"/><motor joint="j"/>)");
  REQUIRE(scene.actuators.size() == 2);
  CHECK(double{number_at(scene.actuators[0], 1)} == Approx((3 * 1 + 1 * 2) / 4.0));
  CHECK(has_note(scene,
                 R"(<position> "q" stays at a control of 2, because <position> "p" drives joint "j" in the same)"));
  CHECK(has_note(scene, R"(a <motor> exerts nothing, because <motor> "m" drives joint "j" in the same way)"));
}

TEST_CASE("mjcf: an actuator whose control does nothing is noted")
{
  const auto notes = [](const std::string &joint, const std::string &drive, const std::string &note) {
    const Scene scene = driven_scene("<joint name=\"j\" " + joint + "/>", drive);
    CAPTURE(drive, note);
    CHECK(scene.actuators.empty());
    CHECK(has_note(scene, note));
  };
  notes("", R"(<motor name="m" joint="j" gear="0"/>)", R"(<motor> "m" has a gear of 0, so it does nothing)");
  notes("", R"(<position joint="j" gear="0"/>)", "a <position> has a gear of 0");
  notes("", R"(<position joint="j" kp="0"/>)",
        "the control of a <position> does nothing, because its stiffness, kp gear^2, is 0");
  notes("", R"(<velocity name="v" joint="j" kv="0"/>)", R"(the control of <velocity> "v" does nothing)");
  notes(R"(type="ball")", R"(<motor joint="j"/>)", "<motor> of a ball joint is not held");
}

TEST_CASE("mjcf: an actuator counts as its joint does where the axis of the scene points the other way")
{
  const std::string joints = R"(<joint name="a" axis="1 0 0"/><joint name="b" axis="0 -1 0" ref="30"/>
    <joint name="c" axis="0 0 1"/>)",
                    drives = R"(<motor joint="b" gear="3"/><position joint="b"/>)";
  const Scene scene = driven_scene(joints, drives);
  REQUIRE(scene.actuators.size() == 2);
  for (const Actuator &actuator : scene.actuators) CHECK((actuator.joint == 0 && actuator.axis == 5));
  CHECK(scene.actuators[0].factor == -3);
  CHECK(double{number_at(scene.actuators[1], 0.25f)} == Approx(30 * degree - 0.25));
  CHECK(double{scene.joints[0].rotations[2].target_position} == Approx(30 * degree));
  const Scene tree = driven_scene(joints, drives, Coordinates::reduced);
  REQUIRE(tree.actuators.size() == 2);
  for (const Actuator &actuator : tree.actuators) CHECK((actuator.joint == 1 && actuator.axis == 3));
  CHECK(tree.actuators[0].factor == 3);
  CHECK(double{number_at(tree.actuators[1], 0.25f)} == Approx(0.25 - 30 * degree));
}

TEST_CASE("mjcf: an actuator of a joint that is left out is noted")
{
  const Scene scene = mjcf(R"(<worldbody><body><freejoint/><geom size="0.1"/><body><joint name="j"/></body></body>
    </worldbody><actuator><motor name="m" joint="j"/></actuator>)");
  CHECK(scene.actuators.empty());
  CHECK(has_note(scene, R"(<motor> "m" drives joint "j", which is left out)"));
}
