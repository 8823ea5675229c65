/* Joints that hold nothing or cannot be simulated are refused by one line that says which, what and why. */
#include <functional>
#include <limits>

#include <tandem/scene.h>

#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/* Two dynamic bodies and two that are not, with one joint. */
Scene joined_scene()
{
  Scene scene;
  scene.shapes = {sphere_shape(0.5f)};
  scene.bodies.resize(4);
  scene.bodies[2].type = BodyType::fixed;
  scene.bodies[3].type = BodyType::kinematic;
  Joint joint;
  joint.name = "knee";
  joint.body_a = 0;
  joint.body_b = 1;
  scene.joints = {joint};
  return scene;
}

std::string joint_complaint(const std::function<void(Joint &)> &spoil)
{
  Scene scene = joined_scene();
  spoil(scene.joints[0]);
  try {
    validate(scene, "leg.json");
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

void check_joint_refused(const std::string &why, const std::function<void(Joint &)> &spoil)
{
  const std::string complaint = joint_complaint(spoil);
  CAPTURE(complaint);
  CHECK(complaint.find("leg.json: joint 0 'knee': ") == 0);
  CHECK(complaint.find('\n') == std::string::npos);
  CHECK_THAT(complaint, ContainsSubstring(why));
}

} // namespace

TEST_CASE("sound joints pass validation")
{
  CHECK(joint_complaint([](Joint &) {}).empty());
  for (size_t k = 0; k < joint_type_names().size(); ++k) {
    CAPTURE(joint_type_names()[k]);
    CHECK(joint_complaint([&](Joint &j) { j.type = static_cast<JointType>(k); }).empty());
  }
  CHECK(joint_complaint([](Joint &j) { j.body_a = no_body; }).empty());
  CHECK(joint_complaint([](Joint &j) { j.body_b = 2; }).empty());
  CHECK(joint_complaint([](Joint &j) { j.body_a = 3; }).empty());
  CHECK(joint_complaint([](Joint &j) {
          j.body_a = no_body;
          j.position_a = {1e17, 0, -1e17};
        }).empty());
}

TEST_CASE("joints that cannot be simulated are refused by name")
{
  check_joint_refused("unknown type; ball, fixed, hinge", [](Joint &j) { j.type = static_cast<JointType>(99); });
  check_joint_refused("body_a 4 does not exist; the scene has 4 bodies", [](Joint &j) { j.body_a = 4; });
  check_joint_refused("body_b 4000000000 does not exist", [](Joint &j) { j.body_b = 4000000000u; });
  check_joint_refused("connects body 1 with itself", [](Joint &j) { j.body_a = 1; });
  check_joint_refused("connects the world with itself", [](Joint &j) { j.body_a = j.body_b = no_body; });
  check_joint_refused("neither of its bodies is dynamic", [](Joint &j) {
    j.body_a = 2;
    j.body_b = 3;
  });
  check_joint_refused("neither of its bodies is dynamic", [](Joint &j) {
    j.body_a = no_body;
    j.body_b = 2;
  });
  check_joint_refused("position_a is [", [](Joint &j) { j.position_a[1] = not_a_number; });
  check_joint_refused("position_b is ", [](Joint &j) { j.position_b[2] = std::numeric_limits<double>::infinity(); });
  check_joint_refused("position_b is 1e+30", [](Joint &j) { j.position_b[2] = 1e30; });
  check_joint_refused("orientation_a is [0, 0, 0, 2]", [](Joint &j) { j.orientation_a = {0, 0, 0, 2}; });
  check_joint_refused("orientation_b is [0, 0, 0, 0]", [](Joint &j) { j.orientation_b = {0, 0, 0, 0}; });
  check_joint_refused("orientation_b is [nan", [](Joint &j) { j.orientation_b[0] = not_a_number; });
}

TEST_CASE("the second of two joints is named by its number")
{
  Scene scene = joined_scene();
  scene.joints.resize(2);
  scene.joints[1].body_a = 7;
  CHECK_THROWS_WITH(validate(scene, "x"), ContainsSubstring("x: joint 1: body_a 7 does not exist"));
}

TEST_CASE("axes that no joint can have are refused, with the axis")
{
  const auto spoil_axis = [](const std::function<void(JointAxis &)> &spoil) {
    return [spoil](Joint &j) {
      j.type = JointType::hinge;
      spoil(j.rotations[0]);
    };
  };
  check_joint_refused("rotations[0] is from 1 to -1", spoil_axis([](JointAxis &a) { a.lower = 1, a.upper = -1; }));
  check_joint_refused("rotations[0] is from nan", spoil_axis([](JointAxis &a) { a.lower = not_a_number; }));
  check_joint_refused("rotations[0].stiffness", spoil_axis([](JointAxis &a) { a.stiffness = -1; }));
  check_joint_refused("rotations[0].damping", spoil_axis([](JointAxis &a) { a.damping = not_a_number; }));
  check_joint_refused("rotations[0].friction", spoil_axis([](JointAxis &a) { a.friction = -2; }));
  check_joint_refused("rotations[0].max_force", spoil_axis([](JointAxis &a) { a.max_force = not_a_number; }));
  check_joint_refused("rotations[0].max_speed", spoil_axis([](JointAxis &a) { a.max_speed = 0; }));
  check_joint_refused("rotations[0].target_velocity",
                      spoil_axis([](JointAxis &a) { a.target_velocity = JointAxis::unlimited; }));
  check_joint_refused("a motor has neither", spoil_axis([](JointAxis &a) { a.motor = true, a.stiffness = 1; }));
  check_joint_refused("rotations[1] is not free in a joint of type hinge", [](Joint &j) {
    j.type = JointType::hinge;
    j.rotations[1].friction = 1;
  });
  check_joint_refused("an angle has both limits", spoil_axis([](JointAxis &a) { a.lower = -1; }));
  check_joint_refused("an angle has both limits", spoil_axis([](JointAxis &a) { a.lower = 3, a.upper = 4; }));
  check_joint_refused("limit_damping is 1 without", spoil_axis([](JointAxis &a) { a.limit_damping = 1; }));
  check_joint_refused("restitution is 1.5; 0 to 1 is needed", spoil_axis([](JointAxis &a) { a.restitution = 1.5f; }));
  check_joint_refused("which hard limits of a range alone have", spoil_axis([](JointAxis &a) {
                        a.restitution = 0.5f;
                        a.limit_stiffness = 10;
                      }));
  check_joint_refused("where nothing can be", [](Joint &j) {
    j.type = JointType::slider;
    j.directions[0].lower = j.directions[0].upper = JointAxis::unlimited;
  });
  check_joint_refused("never below 0", [](Joint &j) {
    j.type = JointType::distance;
    j.directions[0].upper = -1;
  });
  check_joint_refused("rotations[2] is not free in a joint of type universal", [](Joint &j) {
    j.type = JointType::universal;
    j.rotations[2].friction = 1;
  });
  check_joint_refused("directions[1] is not free in a joint of type wheel", [](Joint &j) {
    j.type = JointType::wheel;
    j.directions[1].friction = 1;
  });
  check_joint_refused("break_torque is -1; more than 0 is needed, or infinity", [](Joint &j) { j.break_torque = -1; });
  check_joint_refused("are of a six_dof joint", [](Joint &j) { j.held_rotations.y = true; });
  check_joint_refused("x without y and z", [](Joint &j) {
    j.type = JointType::six_dof;
    j.held_rotations.x = true;
  });
}
