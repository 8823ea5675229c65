/* The trees that joints of a scene make, against a search of the graph that shares no code with it. */
#include <set>

#include <tandem/articulations.h>

#include "host/base/random.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

Scene scene_of_balls(uint32_t dynamic, uint32_t fixed)
{
  Scene scene;
  scene.shapes = {sphere_shape(0.5f)};
  for (uint32_t k = 0; k < dynamic + fixed; ++k) {
    Body &body = scene.bodies.emplace_back();
    body.type = k < dynamic ? BodyType::dynamic : BodyType::fixed;
    body.position = {double(k), 0, 0};
    if (k < dynamic) body.mass = 1;
  }
  return scene;
}

Joint &join(Scene &scene, uint32_t a, uint32_t b, JointType type = JointType::ball)
{
  Joint &joint = scene.joints.emplace_back();
  joint.type = type;
  joint.body_a = a;
  joint.body_b = b;
  return joint;
}

/* All that stands still is one node. */
uint32_t node_of(const Scene &scene, uint32_t body)
{
  return body == no_body || scene.bodies[body].type == BodyType::fixed ? uint32_t(scene.bodies.size()) : body;
}

/* How many groups of nodes the joints leave: each search from a node that none has reached begins one. */
size_t groups_of(const Scene &scene, const std::vector<uint32_t> &joints)
{
  std::set<uint32_t> unseen;
  for (uint32_t k = 0; k < scene.bodies.size(); ++k)
    if (scene.bodies[k].type != BodyType::fixed) unseen.insert(k);
  unseen.insert(uint32_t(scene.bodies.size()));
  size_t groups = 0;
  while (!unseen.empty()) {
    ++groups;
    std::vector<uint32_t> reached{*unseen.begin()};
    unseen.erase(unseen.begin());
    for (size_t k = 0; k < reached.size(); ++k)
      for (const uint32_t joint : joints) {
        const uint32_t a = node_of(scene, scene.joints[joint].body_a), b = node_of(scene, scene.joints[joint].body_b);
        if (a == reached[k] && unseen.erase(b) > 0) reached.push_back(b);
        if (b == reached[k] && unseen.erase(a) > 0) reached.push_back(a);
      }
  }
  return groups;
}

} // namespace

TEST_CASE("the trees of a scene hold together what its joints do, and none of their joints is too many")
{
  Random random(5);
  for (int round = 0; round < 60; ++round) {
    Scene scene = scene_of_balls(3 + random.below(30), 2);
    const auto bodies = uint32_t(scene.bodies.size());
    for (uint32_t k = random.below(50); k > 0; --k) {
      const uint32_t a = random.below(bodies + 1), b = random.below(bodies);
      const uint32_t left = a == bodies ? no_body : a;
      if (node_of(scene, left) == node_of(scene, b)) continue;
      join(scene, left, b, std::array{JointType::ball, JointType::hinge, JointType::fixed}[random.below(3)]);
    }
    std::vector<uint32_t> all(scene.joints.size()), used;
    for (uint32_t k = 0; k < all.size(); ++k) all[k] = k;
    make_articulations(scene, "test");
    for (const Articulation &tree : scene.articulations)
      used.insert(used.end(), tree.joints.begin(), tree.joints.end());
    const size_t nodes = size_t(bodies) - 2 + 1;
    CHECK(groups_of(scene, used) == groups_of(scene, all));
    CHECK(used.size() == nodes - groups_of(scene, all)); /* so that each of them connects two groups */
    CHECK(scene.notes.size() == (used.size() < all.size() ? 1 : 0));
    /* A ground that no joint of a tree passes through keeps trees apart. */
    for (const Articulation &tree : scene.articulations) CHECK_NOTHROW(ArticulationTree(scene, tree, "tree"));
  }
}

TEST_CASE("joints that a tree cannot have stay as they are, and a note says which and why")
{
  Scene scene = scene_of_balls(6, 0);
  join(scene, 0, 1);
  join(scene, 1, 2, JointType::universal);
  join(scene, 2, 3, JointType::hinge).break_force = 5;
  join(scene, 3, 4).enabled = false;
  join(scene, 4, 5, JointType::hinge);
  scene.joints[4].rotations[0] = {.lower = -1, .upper = 1, .restitution = 0.5f};
  make_articulations(scene, "test");
  REQUIRE(scene.articulations.size() == 1);
  CHECK(scene.articulations[0].joints == std::vector<uint32_t>{0});
  REQUIRE(scene.notes.size() == 1);
  CHECK(scene.notes[0].starts_with("joints in maximal coordinates beside the articulations: 3, the first: test: "));
  CHECK(scene.notes[0].find("joint 1 has another type") != std::string::npos);
}

TEST_CASE("bodies that coupled joints hold are no links")
{
  Scene scene = scene_of_balls(4, 0);
  join(scene, no_body, 0, JointType::hinge);
  join(scene, no_body, 1, JointType::hinge);
  join(scene, 1, 2, JointType::hinge);
  join(scene, no_body, 3, JointType::hinge);
  Coupling gear;
  gear.type = CouplingType::mimic;
  gear.joint_a = 0;
  gear.joint_b = 1;
  scene.couplings = {gear};
  make_articulations(scene, "test");
  REQUIRE(scene.articulations.size() == 1);
  CHECK(scene.articulations[0].joints == std::vector<uint32_t>{3});
}

TEST_CASE("armatures follow their joints into the trees, and a wrong number of them is refused")
{
  Scene scene = scene_of_balls(4, 0);
  join(scene, 2, 3, JointType::hinge);
  join(scene, 0, 1, JointType::hinge);
  join(scene, no_body, 0, JointType::hinge);
  Scene other = scene;
  make_articulations(scene, "test", std::vector<float>{1, 2, 3});
  REQUIRE(scene.articulations.size() == 2);
  CHECK(scene.articulations[0].armatures == std::vector<float>{1});
  CHECK(scene.articulations[1].joints == std::vector<uint32_t>{1, 2});
  CHECK(scene.articulations[1].armatures == std::vector<float>{2, 3});
  CHECK_THROWS_WITH(make_articulations(other, "test", std::vector<float>{1}),
                    Catch::Matchers::ContainsSubstring("1 armatures for 3 joints"));
}

TEST_CASE("a scene that cannot have articulations stays as it was")
{
  Scene scene = scene_of_balls(2, 0);
  join(scene, 0, 1, JointType::hinge);
  scene.materials.emplace_back().rolling_friction = 0.1f;
  CHECK_THROWS_WITH(make_articulations(scene, "test"), Catch::Matchers::StartsWith("test: material "));
  CHECK(scene.articulations.empty());
}
