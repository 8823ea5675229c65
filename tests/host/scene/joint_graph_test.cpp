/* The colours of joints: no two joints of a colour push one body, the order is by colour and type, and what finds no
 * colour is an overflow joint. */
#include <algorithm>
#include <set>

#include "host/base/random.h"
#include "host/scene/joint_graph.h"
#include "shared/counts.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

Scene bodies_of(uint32_t dynamic, uint32_t others)
{
  Scene scene;
  scene.bodies.resize(dynamic + others);
  for (uint32_t i = dynamic; i < dynamic + others; ++i)
    scene.bodies[i].type = i % 2 ? BodyType::fixed : BodyType::kinematic;
  return scene;
}

void join(Scene &scene, uint32_t a, uint32_t b, JointType type = JointType::ball)
{
  Joint joint;
  joint.type = type;
  joint.body_a = a;
  joint.body_b = b;
  scene.joints.push_back(joint);
}

uint32_t color_at(const JointGraph &graph, uint32_t place)
{
  const auto after = std::upper_bound(graph.starts.begin(), graph.starts.end(), place);
  return static_cast<uint32_t>(after - graph.starts.begin()) - 1;
}

bool is_pushed(const Scene &scene, uint32_t body)
{
  return body != no_body && scene.bodies[body].type == BodyType::dynamic;
}

/* Compares with what each statement of joint_graph.h says, one joint with each other. */
void require_proper(const Scene &scene, const JointGraph &graph)
{
  const auto count = static_cast<uint32_t>(scene.joints.size());
  REQUIRE(graph.starts.size() == 2 * COLOR_ENTRIES - 1);
  REQUIRE(graph.starts[COLOR_ENTRIES - 1] == count); /* none holds a link */
  REQUIRE(graph.starts.front() == 0);
  REQUIRE(graph.starts.back() == count);
  REQUIRE(std::is_sorted(graph.starts.begin(), graph.starts.end()));
  REQUIRE(std::set<uint32_t>(graph.order.begin(), graph.order.end()).size() == count);
  std::vector<uint64_t> used(scene.bodies.size());
  uint32_t colors = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const Joint &one = scene.joints.at(graph.order[i]);
    const uint32_t color = color_at(graph, i);
    colors = std::max(colors, color + 1);
    for (const uint32_t body : {one.body_a, one.body_b})
      if (is_pushed(scene, body) && color < COLOR_LIMIT) {
        REQUIRE((used[body] >> color & 1) == 0);
        used[body] |= uint64_t{1} << color;
      }
    if (i + 1 == count || color_at(graph, i + 1) != color) continue;
    const Joint &next = scene.joints[graph.order[i + 1]];
    REQUIRE((one.type < next.type || (one.type == next.type && graph.order[i] < graph.order[i + 1])));
  }
  REQUIRE(graph.colors == colors);
  for (size_t body = 0; body < scene.bodies.size(); ++body)
    REQUIRE((graph.body_colors.at(2 * body) | uint64_t{graph.body_colors.at(2 * body + 1)} << 32) == used[body]);
}

} // namespace

TEST_CASE("the colours of random joints are proper, and in order by colour, type and number")
{
  Random random(11);
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    const uint32_t dynamic = 2 + random.below(60);
    Scene scene = bodies_of(dynamic, 3);
    const uint32_t joints = random.below(600);
    for (uint32_t k = 0; k < joints; ++k) {
      const uint32_t a = random.below(dynamic), b = random.below(dynamic + 4);
      if (a == b) continue;
      const auto type = static_cast<JointType>(random.below(7));
      const uint32_t other = b == dynamic + 3 ? no_body : b;
      if (random.below(2) == 0) join(scene, a, other, type);
      else join(scene, other, a, type);
    }
    require_proper(scene, joint_graph_of(scene));
  }
}

TEST_CASE("a chain has two colours, and joints to what cannot be pushed share one")
{
  Scene chain = bodies_of(50, 0), fence = bodies_of(50, 1);
  for (uint32_t i = 0; i + 1 < 50; ++i) join(chain, i, i + 1);
  for (uint32_t i = 0; i < 50; ++i) join(fence, i % 2 ? i : 50, i % 2 ? 50 : i);
  for (uint32_t i = 0; i < 50; ++i) join(fence, no_body, i);
  CHECK(joint_graph_of(chain).colors == 2);
  CHECK(joint_graph_of(fence).colors == 2);
  CHECK(joint_graph_of(bodies_of(3, 0)).colors == 0);
}

TEST_CASE("joints of a body past the last colour overflow, in their order, and take no colour")
{
  const uint32_t most = COLOR_LIMIT;
  Scene scene = bodies_of(200, 0);
  for (uint32_t i = 1; i < 200; ++i) join(scene, 0, i);
  const JointGraph graph = joint_graph_of(scene);
  require_proper(scene, graph);
  CHECK(graph.colors == most + 1);
  REQUIRE(graph.starts[most] == most);
  for (uint32_t i = most; i < 199; ++i) CHECK(graph.order[i] == i);
  CHECK((graph.body_colors[2 * 150] == 0 && graph.body_colors[2 * 150 + 1] == 0));
  Scene full = bodies_of(most + 1, 0);
  for (uint32_t i = 1; i <= most; ++i) join(full, 0, i);
  CHECK(joint_graph_of(full).colors == most);
}

TEST_CASE("joints that hold links stand behind all others, and no two of a colour hold one tree")
{
  Random random(12);
  Scene scene = bodies_of(40, 2);
  for (Body &body : scene.bodies) body.mass = 1, body.inertia = {1, 1, 1};
  for (uint32_t tree = 0; tree < 4; ++tree) { /* of four links each; the bodies from 16 on are single ones */
    Articulation &one = scene.articulations.emplace_back();
    one.root = 4 * tree;
    for (uint32_t k = 1; k < 4; ++k) {
      one.joints.push_back(uint32_t(scene.joints.size()));
      join(scene, 4 * tree + k - 1, 4 * tree + k, JointType::ball);
    }
  }
  for (uint32_t k = 0; k < 200; ++k) {
    const uint32_t a = random.below(40), b = random.below(42);
    if (a != b) join(scene, a, b, JointType::ball);
  }
  const size_t holding = scene.joints.size();
  join(scene, 1, 20, JointType::six_dof); /* holds nothing: it needs no colour beside a link, and has one elsewhere */
  join(scene, 20, 21, JointType::six_dof);
  const JointGraph graph = joint_graph_of(scene);
  const auto tree_of = [](uint32_t body) { return body < 16 ? 100 + body / 4 : body; };
  const auto holds_link = [&](uint32_t joint) {
    return scene.joints[joint].body_a < 16 || scene.joints[joint].body_b < 16;
  };
  const uint32_t first = graph.starts[COLOR_ENTRIES - 1], end = graph.starts.back();
  CHECK(graph.without_rows.size() == 13);
  CHECK(graph.without_rows.back() == holding);
  CHECK(end + 13 == scene.joints.size());
  CHECK(graph.link_colors > 1);
  for (uint32_t i = 0; i < end; ++i) CHECK(holds_link(graph.order[i]) == (i >= first));
  for (uint32_t color = 0; color < COLOR_LIMIT; ++color) {
    std::set<uint32_t> held;
    for (uint32_t i = graph.starts[COLOR_ENTRIES - 1 + color]; i < graph.starts[COLOR_ENTRIES + color]; ++i) {
      std::set<uint32_t> of_joint;
      for (const uint32_t body : {scene.joints[graph.order[i]].body_a, scene.joints[graph.order[i]].body_b})
        if (is_pushed(scene, body)) of_joint.insert(tree_of(body));
      for (const uint32_t node : of_joint) CHECK(held.insert(node).second);
    }
  }
}
