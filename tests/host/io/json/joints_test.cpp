/* A written scene with joints reads back to the same bits, and every error in a joint is reported with its place. */
#include <bit>

#include "host/io/json/scene.h"
#include "tests/catch.h"
#include "tests/physics/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string joint_fault(const std::string &joint)
{
  const std::string text = R"({"tandem_scene": 1, "shapes": [{"type": "sphere", "radius": 0.5}], "bodies": [{}, {}, )"
                           R"({"motion": "fixed"}, {"motion": "kinematic"}], "joints": [{"body_a": 0}, )" +
                           joint + "]}";
  try {
    parse_scene_json(text, "leg.json");
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

template <class Number, size_t n> bool equal_bits(const std::array<Number, n> &a, const std::array<Number, n> &b)
{
  using Bits = std::conditional_t<sizeof(Number) == 8, uint64_t, uint32_t>;
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](Number x, Number y) { return std::bit_cast<Bits>(x) == std::bit_cast<Bits>(y); });
}

bool equal_bits(const Joint &a, const Joint &b)
{
  return a.name == b.name && a.type == b.type && a.body_a == b.body_a && a.body_b == b.body_b &&
         equal_bits(a.position_a, b.position_a) && equal_bits(a.position_b, b.position_b) &&
         equal_bits(a.orientation_a, b.orientation_a) && equal_bits(a.orientation_b, b.orientation_b) &&
         a.collide == b.collide && a.held_directions == b.held_directions && a.held_rotations == b.held_rotations &&
         a.directions == b.directions && a.rotations == b.rotations;
}

Scene random_joints(uint64_t seed)
{
  Random random(seed);
  Scene scene = empty_scene();
  for (int i = 0; i < 10; ++i)
    add_body(scene, BodyType::dynamic, sphere_shape(0.4f), point_of(10 * direction(random))).orientation =
        any_turn(random);
  for (uint32_t k = 0; k < 40; ++k) {
    const uint32_t a = random.below(10), b = random.below(11);
    if (a == b) continue;
    const JointType type = all_joint_types[k % std::size(all_joint_types)];
    Joint &joint = connect(scene, type, a, b == 10 ? no_body : b, 3 * direction(random), direction(random));
    joint.name = k % 3 ? "joint \"" + std::to_string(k) + "\"\n\u00e9" : "";
    joint.collide = k % 2 == 0;
    if (k % 5 == 0) joint.position_a = {-0.0, 0x1p-1000, 1.0 / 3};
  }
  return scene;
}

} // namespace

TEST_CASE("joints are written and read back to the same bits")
{
  const uint64_t seed = GENERATE(1, 2, 3);
  const Scene scene = random_joints(seed);
  const std::string text = to_scene_json(scene);
  const Scene read = parse_scene_json(text, "joints.json");
  REQUIRE(read.joints.size() == scene.joints.size());
  for (size_t k = 0; k < scene.joints.size(); ++k) {
    CAPTURE(k);
    CHECK(equal_bits(read.joints[k], scene.joints[k]));
  }
  CHECK(to_scene_json(read) == text);
}

TEST_CASE("a joint in a file has the defaults of Joint, and a file without joints has none")
{
  const Scene scene = parse_scene_json(R"({"tandem_scene": 1, "shapes": [{"type": "sphere", "radius": 0.5}], )"
                                       R"("bodies": [{}, {}], "joints": [{"body_b": 1}]})",
                                       "joints.json");
  REQUIRE(scene.joints.size() == 1);
  Joint expected;
  expected.body_b = 1;
  CHECK(equal_bits(scene.joints[0], expected));
  CHECK(to_scene_json(empty_scene()).find("joints") == std::string::npos);
}

TEST_CASE("faults of joints in a file are named by file, joint and reason")
{
  const auto check = [](const std::string &joint, const std::string &mentions) {
    const std::string fault = joint_fault(joint);
    CAPTURE(joint, fault);
    CHECK(fault.find("leg.json") == 0);
    CHECK(fault.find('\n') == std::string::npos);
    CHECK_THAT(fault, ContainsSubstring(mentions));
  };
  CHECK(joint_fault(R"({"body_a": 0, "body_b": 1, "type": "hinge"})").empty());
  check(R"({"body_a": 0, "body_b": 1, "type": "glue"})", "glue");
  check(R"({"body_a": 0, "body_b": 1, "type": 3})", "type");
  check(R"({"body_a": 0, "body_b": 4})", "joint 1: body_b 4 does not exist");
  check(R"({"body_a": -1, "body_b": 1})", "body_a");
  check(R"({"body_a": 0.5, "body_b": 1})", "body_a");
  check(R"({"body_a": 5000000000})", "body_a");
  check(R"({"name": "nothing"})", "joint 1 'nothing': it connects the world with itself");
  check(R"({"body_a": 2, "body_b": 3})", "joint 1: neither of its bodies is dynamic");
  check(R"({"body_a": 1, "body_b": 1})", "joint 1: it connects body 1 with itself");
  check(R"({"body_a": 1, "position_a": ["nan", 0, 0]})", "position_a");
  check(R"({"body_a": 1, "position_a": [0, 0]})", "position_a");
  check(R"({"body_a": 1, "orientation_b": [0, 0, 0, 0.5]})", "joint 1: orientation_b is [0, 0, 0, 0.5]");
  check(R"({"body_a": 1, "collide": "no"})", "collide");
  check(R"({"body_a": 1, "colour": 3})", "colour");
  check(R"(7)", "joints");
}
