/* Couplings that cannot be simulated are refused by one line that says which, what and why; colours share no body; a
 * file reads back what was written. */
#include <functional>
#include <limits>
#include <set>

#include "host/io/json/scene.h"
#include "host/scene/coupling_graph.h"
#include "shared/counts.h"
#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

/* Wheels on hinges and boxes on sliders to the world, a rope and a ball joint, and a gear. */
Scene coupled_scene()
{
  Scene scene;
  scene.shapes = {sphere_shape(0.5f)};
  scene.bodies.resize(6);
  for (const JointType type : {JointType::hinge, JointType::hinge, JointType::slider, JointType::slider,
                               JointType::distance, JointType::ball}) {
    Joint joint;
    joint.type = type;
    joint.body_b = uint32_t(scene.joints.size());
    scene.joints.push_back(joint);
  }
  Coupling coupling;
  coupling.name = "pair";
  coupling.joint_b = 1;
  coupling.teeth_a = 12;
  coupling.teeth_b = 30;
  scene.couplings = {coupling};
  return scene;
}

std::string complaint_of(const std::function<void(Coupling &)> &spoil)
{
  Scene scene = coupled_scene();
  spoil(scene.couplings[0]);
  try {
    validate(scene, "mill.json");
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

void check_coupling_refused(const std::string &why, const std::function<void(Coupling &)> &spoil)
{
  const std::string complaint = complaint_of(spoil);
  CAPTURE(why, complaint);
  CHECK(complaint.find("mill.json: coupling 0 'pair': ") == 0);
  CHECK(complaint.find('\n') == std::string::npos);
  CHECK_THAT(complaint, ContainsSubstring(why));
}

} // namespace

TEST_CASE("couplings that hold are accepted")
{
  CHECK(complaint_of([](Coupling &) {}).empty());
  CHECK(complaint_of([](Coupling &c) { c.teeth_b = -30; }).empty());
  CHECK(complaint_of([](Coupling &c) {
          c = {.name = "", .type = CouplingType::rack_and_pinion, .joint_b = 2, .teeth_a = 9, .travel = -1};
        }).empty());
  CHECK(complaint_of([](Coupling &c) {
          c = {.name = "", .type = CouplingType::pulley, .joint_a = 2, .joint_b = 4, .offset = 3};
        }).empty());
  CHECK(complaint_of([](Coupling &c) {
          c = {.name = "", .type = CouplingType::mimic, .joint_a = 0, .joint_b = 3, .ratio = -2};
        }).empty());
}

TEST_CASE("couplings that cannot be are refused in one line")
{
  const auto refused = check_coupling_refused;
  refused("unknown type", [](Coupling &c) { c.type = CouplingType(7); });
  refused("unknown coordinate", [](Coupling &c) { c.coordinate_b = JointCoordinate(9); });
  refused("joint_a 6 does not exist; the scene has 6 joints", [](Coupling &c) { c.joint_a = 6; });
  refused("joint_b 4294967295", [](Coupling &c) { c.joint_b = no_body; });
  refused("couples a coordinate of joint 1 with itself", [](Coupling &c) { c.joint_a = 1; });
  refused("teeth_a is 0", [](Coupling &c) { c.teeth_a = 0; });
  refused("teeth_b is 1000001", [](Coupling &c) { c.teeth_b = 1000001; });
  refused("a gear has no ratio", [](Coupling &c) { c.ratio = 2; });
  refused("a gear has no travel", [](Coupling &c) { c.travel = 2; });
  refused("a gear has no only_pulls", [](Coupling &c) { c.only_pulls = false; });
  refused("coordinate_b is not free in a joint of type slider", [](Coupling &c) { c.joint_b = 2; });
  refused("coordinate_a is no rotation about x",
          [](Coupling &c) { c.joint_a = 5, c.coordinate_a = JointCoordinate::rotation_y; });
  const auto as = [&](CouplingType type, const std::string &why, const std::function<void(Coupling &)> &spoil) {
    refused(why, [&](Coupling &c) {
      c = {.name = "pair", .type = type, .joint_b = type == CouplingType::mimic ? 1u : 2u};
      if (type == CouplingType::rack_and_pinion) c.teeth_a = 10, c.travel = 1;
      if (type == CouplingType::pulley) c.joint_a = 4, c.offset = 1;
      spoil(c);
    });
  };
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  as(CouplingType::rack_and_pinion, "travel is 0", [](Coupling &c) { c.travel = 0; });
  as(CouplingType::rack_and_pinion, "has no teeth_b", [](Coupling &c) { c.teeth_b = 3; });
  as(CouplingType::rack_and_pinion, "coordinate_b is no direction",
     [](Coupling &c) { c.joint_b = 1, c.coordinate_b = JointCoordinate::rotation_x; });
  as(CouplingType::pulley, "offset is 0; it is the length of the rope", [](Coupling &c) { c.offset = 0; });
  as(CouplingType::pulley, "ratio is -1; a rope has one above 0", [](Coupling &c) { c.ratio = -1; });
  as(CouplingType::pulley, "has no teeth_a", [](Coupling &c) { c.teeth_a = 1; });
  as(CouplingType::pulley, "offset is inf", [&](Coupling &c) { c.offset = infinity; });
  as(CouplingType::mimic, "ratio is 0", [](Coupling &c) { c.ratio = 0; });
  as(CouplingType::mimic, "ratio is nan", [&](Coupling &c) { c.ratio = nan; });
  as(CouplingType::mimic, "ratio is 1000000000", [](Coupling &c) { c.ratio = 1e9f; });
  as(CouplingType::mimic, "coordinate_a is not free in a joint of type hinge",
     [](Coupling &c) { c.coordinate_a = JointCoordinate::direction_y; });
}

TEST_CASE("couplings of one colour share no body that can be pushed")
{
  Scene scene;
  scene.shapes = {sphere_shape(0.5f)};
  scene.bodies.resize(101);
  scene.bodies[100].type = BodyType::fixed;
  const auto connect_bodies = [&](uint32_t a, uint32_t b) {
    Joint joint;
    joint.type = JointType::hinge;
    joint.body_a = a;
    joint.body_b = b;
    scene.joints.push_back(joint);
  };
  for (uint32_t i = 0; i < 100; ++i) connect_bodies(i % 3 == 0 ? no_body : i % 3 == 1 ? 100 : (i + 7) % 100, i);
  for (uint32_t k = 0; k < 150; ++k)
    scene.couplings.push_back(
        {.name = "", .joint_a = k < 70 ? 0 : k % 100, .joint_b = 1 + (k * 17) % 99, .teeth_a = 9, .teeth_b = 5});
  std::erase_if(scene.couplings, [](const Coupling &c) { return c.joint_a == c.joint_b; });
  validate(scene, "graph");
  const CouplingGraph graph = coupling_graph_of(scene);
  CHECK(graph.colors == COLOR_LIMIT + 1);
  CHECK(graph.starts.back() == scene.couplings.size());
  for (uint32_t color = 0; color < COLOR_LIMIT; ++color) {
    std::set<uint32_t> pushed;
    for (uint32_t place = graph.starts[color]; place < graph.starts[color + 1]; ++place) {
      const Coupling &coupling = scene.couplings[graph.order[place]];
      std::set<uint32_t> own;
      for (const uint32_t number : {coupling.joint_a, coupling.joint_b})
        for (const uint32_t body : {scene.joints[number].body_a, scene.joints[number].body_b})
          if (body < 100) own.insert(body);
      for (const uint32_t body : own) CHECK(pushed.insert(body).second);
    }
  }
}

TEST_CASE("couplings are written and read back, and a fault of one is named by its place in the file")
{
  Scene scene = coupled_scene();
  scene.couplings.push_back({.name = "",
                             .type = CouplingType::pulley,
                             .joint_a = 2,
                             .joint_b = 4,
                             .ratio = 0x1.8p-3f,
                             .offset = 3,
                             .only_pulls = false});
  scene.couplings.push_back({.name = "",
                             .type = CouplingType::mimic,
                             .joint_a = 5,
                             .joint_b = 3,
                             .coordinate_a = JointCoordinate::rotation_z,
                             .ratio = -2});
  scene.couplings.push_back(
      {.name = "", .type = CouplingType::rack_and_pinion, .joint_b = 2, .teeth_a = -9, .travel = 1.0f / 3});
  const std::string text = to_scene_json(scene);
  CHECK(parse_scene_json(text, "mill.json").couplings == scene.couplings);
  CHECK(to_scene_json(parse_scene_json(text, "mill.json")) == text);
  const auto with = [&](const char *from, const char *to) {
    std::string changed = text;
    changed.replace(changed.find(from), std::string(from).size(), to);
    try {
      parse_scene_json(changed, "mill.json");
    } catch (const InputError &error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(with("\"teeth_a\": 12", "\"teeth_a\": 1.5"),
             ContainsSubstring("mill.json: couplings[0].teeth_a: is 1.5; a whole number"));
  CHECK_THAT(with("\"pulley\"", "\"winch\""), ContainsSubstring("couplings[1].type"));
  CHECK_THAT(with("\"teeth_a\": 12", "\"teeth\": 12"), ContainsSubstring("couplings[0].teeth: unknown key"));
}
