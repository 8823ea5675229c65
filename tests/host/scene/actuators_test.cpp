/* Actuators that cannot be are refused by one line that says which, what and why; a file reads back what was
 * written. */
#include <cmath>
#include <functional>
#include <limits>

#include "host/io/json/scene.h"
#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

/* A wheel on a hinge and a box on a slider, both to the world, and an actuator of each, and one more of the wheel. */
Scene actuated_scene()
{
  Scene scene;
  scene.shapes = {sphere_shape(0.5f)};
  scene.bodies.resize(2);
  for (const JointType type : {JointType::hinge, JointType::slider}) {
    Joint joint;
    joint.type = type;
    joint.body_b = uint32_t(scene.joints.size());
    scene.joints.push_back(joint);
  }
  scene.actuators = {{.name = "turn", .joint = 0, .axis = 3, .factor = 1.0f / 3, .lower = -1, .upper = 0.7f},
                     {.name = "",
                      .joint = 1,
                      .axis = 0,
                      .sets = Control::target_position,
                      .offset = -0.1f,
                      .factor = 0x1.8p-3f,
                      .upper = 2},
                     {.name = "brake", .joint = 0, .axis = 3, .sets = Control::target_velocity, .factor = -2}};
  return scene;
}

void check_actuator_refused(const std::string &why, const std::function<void(Actuator &)> &spoil)
{
  Scene scene = actuated_scene();
  spoil(scene.actuators[0]);
  std::string complaint;
  try {
    validate(scene, "arm.json");
  } catch (const InputError &error) {
    complaint = error.what();
  }
  CAPTURE(why, complaint);
  CHECK(complaint.find("arm.json: actuator 0 'turn': ") == 0);
  CHECK(complaint.find('\n') == std::string::npos);
  CHECK_THAT(complaint, ContainsSubstring(why));
}

} // namespace

TEST_CASE("a control becomes a number by clamping, factor and offset")
{
  const Actuator actuator{.name = "", .offset = 10, .factor = -4, .lower = -1, .upper = 0.5f};
  CHECK(number_at(actuator, 0.25f) == 9);
  CHECK(number_at(actuator, 3) == 8);
  CHECK(number_at(actuator, -3) == 14);
  CHECK(number_at(Actuator{}, -1e30f) == -1e30f);
  CHECK(std::isinf(number_at(actuator, std::numeric_limits<float>::infinity()))); /* for the caller to refuse */
}

TEST_CASE("actuators that cannot be are refused in one line")
{
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  check_actuator_refused("joint 2 does not exist; the scene has 2 joints", [](Actuator &a) { a.joint = 2; });
  check_actuator_refused("axis 6 does not exist; 0 to 2 are directions, 3 to 5 rotations",
                         [](Actuator &a) { a.axis = 6; });
  check_actuator_refused("axis 0 is not free in joint 0, which is of type hinge", [](Actuator &a) { a.axis = 0; });
  check_actuator_refused("factor is inf; a finite number is needed", [&](Actuator &a) { a.factor = infinity; });
  check_actuator_refused("offset is nan; a finite number is needed", [&](Actuator &a) { a.offset = nan; });
  check_actuator_refused("controls are from 2 to 0.7", [](Actuator &a) { a.lower = 2; });
  check_actuator_refused("controls are from nan to 0.7", [&](Actuator &a) { a.lower = nan; });
  check_actuator_refused("controls are from inf to inf", [&](Actuator &a) { a.lower = a.upper = infinity; });
  check_actuator_refused("sets an unknown number", [](Actuator &a) { a.sets = Control(3); });
}

TEST_CASE("an actuator that sets what another one sets is refused")
{
  Scene scene = actuated_scene();
  scene.actuators[2].sets = Control::force;
  CHECK_THROWS_WITH(validate(scene, "arm.json"),
                    "arm.json: actuator 2 'brake': sets the force of axis 3 of joint 0, which actuator 0 'turn' sets "
                    "already; let each set a number of its own");
}

TEST_CASE("actuators are written and read back, and a fault of one is named by its place in the file")
{
  const Scene scene = actuated_scene();
  const std::string text = to_scene_json(scene);
  CHECK(parse_scene_json(text, "arm.json").actuators == scene.actuators);
  CHECK(to_scene_json(parse_scene_json(text, "arm.json")) == text);
  const auto with = [&](const char *from, const char *to) {
    std::string changed = text;
    changed.replace(changed.find(from), std::string(from).size(), to);
    return parse_scene_json(changed, "arm.json");
  };
  CHECK_THROWS_WITH(with("\"target_position\"", "\"torque\""), ContainsSubstring("arm.json: actuators[1].sets"));
  CHECK_THROWS_WITH(with("\"upper\"", "\"most\""),
                    ContainsSubstring("arm.json: actuators[0].most: unknown key; known here: name, joint"));
  CHECK(to_scene_json(Scene{}).find("actuators") == std::string::npos);
}
