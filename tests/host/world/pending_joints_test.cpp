/* Joints that come and go one at a time: the bits are those of calls that each make all joints anew, and the time of a
 * call does not grow with the joints. */
#include <atomic>
#include <set>
#include <thread>

#include "host/scene/articulation_buffers.h"
#include "host/scene/joint_recoloring.h"
#include "host/scene/joint_rows.h"
#include "shared/counts.h"
#include "tests/parity/joints.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Boxes in a heap that is two layers high. */
Scene heap_of_boxes(uint32_t boxes)
{
  Scene scene = empty_scene();
  scene.name = "heap of boxes";
  add_ground(scene);
  for (uint32_t k = 0; k < boxes; ++k)
    add_body(scene, BodyType::dynamic, box_shape(0.25f, 0.25f, 0.25f),
             {0.52 * (k % 6), 0.26 + 0.51 * (k / 36), 0.52 * (k / 6 % 6)});
  return scene;
}

Joint ball_between(uint32_t a, uint32_t b, Random &random)
{
  Joint joint;
  joint.body_a = a;
  joint.body_b = b;
  joint.position_a = {0.25f, float(random.uniform(-0.1, 0.1)), 0};
  joint.position_b = {-0.25f, 0, float(random.uniform(-0.1, 0.1))};
  return joint;
}

/* Bodies 1 to last, of which some have more joints than there are colours. */
Joint any_joint(uint32_t last, Random &random)
{
  const uint32_t a = random.below(4) == 0 ? 1 : 1 + random.below(last), b = 1 + random.below(last);
  return ball_between(a, a == b ? no_body : b, random);
}

/* One call that creates or destroys a joint. */
void call_of_joints(World &world, std::vector<JointId> &ids, uint32_t last, Random &random)
{
  if (ids.size() > 8 && random.below(2) == 0) {
    const uint32_t at = random.below(uint32_t(ids.size()));
    world.destroy_joint(ids[at]);
    ids.erase(ids.begin() + at);
  } else ids.push_back(world.create_joint(any_joint(last, random)));
}

std::vector<uint32_t> with_new_colors(const JointGraph &before, const JointGraph &now)
{
  std::vector<uint32_t> bodies;
  for (uint32_t body = 0; 2 * body < now.body_colors.size(); ++body)
    if ((now.body_colors[2 * body] & ~before.body_colors[2 * body]) ||
        (now.body_colors[2 * body + 1] & ~before.body_colors[2 * body + 1]))
      bodies.push_back(body);
  return bodies;
}

} // namespace

TEST_CASE("pending joints: bodies get colours as if all joints were coloured anew after each change")
{
  bool had_in_between = false; /* a body a colour that it had neither before nor has now */
  for (const uint32_t last : {20u, 60u}) {
    Random random(last);
    Scene scene = heap_of_boxes(last);
    scene.bodies[3].type = BodyType::fixed;
    for (int k = 0; k < 300; ++k) scene.joints.push_back(any_joint(last, random));
    const JointedLinks links = links_of(scene);
    const JointGraph first = joint_graph_of(scene);
    CHECK(first.colors > COLOR_LIMIT);
    JointRecoloring recoloring(scene, links, first);
    Scene changing = scene;
    JointGraph before = first;
    std::set<uint32_t> expected;
    for (int k = 0; k < 400; ++k) {
      const uint32_t joint = random.below(uint32_t(changing.joints.size() + 1));
      if (joint == changing.joints.size()) changing.joints.emplace_back();
      changing.joints[joint] = random.below(2) == 0 ? vacant_joint() : any_joint(last, random);
      recoloring.change(joint, edge_of(changing.joints[joint], links));
      const JointGraph now = joint_graph_of(changing);
      for (const uint32_t body : with_new_colors(before, now)) expected.insert(body);
      before = now;
      const std::vector<uint32_t> found = recoloring.bodies_with_new_colors();
      CAPTURE(last, k, joint);
      REQUIRE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()));
      had_in_between = had_in_between || expected.size() > with_new_colors(first, now).size();
    }
  }
  CHECK(had_in_between);
}

/* scene() puts what waits into one of the worlds after each call. */
TEST_CASE("pending joints: the bits are those of joints that come and go at once")
{
  for (const bool sleeping : {false, true}) {
    Settings settings;
    settings.sleeping = sleeping;
    World waiting(heap_of_boxes(60), settings, {"serial", {}, false}),
        at_once(heap_of_boxes(60), settings, {"serial", {}, false});
    std::vector<JointId> ids, others;
    Random random(7), same(7);
    for (int step = 0; step < 40; ++step) {
      for (uint32_t call = 0; call < uint32_t(step) % 20; ++call) {
        call_of_joints(waiting, ids, 60, random);
        call_of_joints(at_once, others, 60, same);
        REQUIRE(at_once.scene().joints.size() > 0);
      }
      REQUIRE(ids == others);
      CAPTURE(sleeping, step);
      waiting.step();
      at_once.step();
      REQUIRE(waiting.state_hash() == at_once.state_hash());
      REQUIRE(waiting.save() == at_once.save());
    }
    CHECK(waiting.statistics().manifolds > 30);
    CHECK(ids.size() >= 8);
  }
}

TEST_CASE("pending joints: all that reads them has them")
{
  Random random(1);
  World world(heap_of_boxes(10), {}, {"serial", {}, false});
  const JointId first = world.create_joint(ball_between(1, 2, random)); /* brings in kernels */
  world.step();
  const JointId second = world.create_joint(ball_between(2, 3, random));
  world.destroy_joint(first);
  CHECK(world.exists(second));
  CHECK_FALSE(world.exists(first));
  CHECK(world.joint_ids() == std::vector<JointId>{second});
  CHECK(world.id_of_joint(1) == second);
  CHECK_THROWS_AS(world.destroy_joint(first), InputError);
  const JointId third = world.create_joint(ball_between(4, 5, random));
  CHECK(third.index == first.index);
  CHECK(world.read_joints(std::vector{second, third}).size() == 2);
  const JointId fourth = world.create_joint(ball_between(6, 7, random));
  CHECK(world.scene().joints.size() == 3);
  const JointId fifth = world.create_joint(ball_between(7, 8, random));
  Joint changed = world.scene().joints[fifth.index];
  changed.enabled = false;
  world.set_joint(fifth, changed);
  const JointId sixth = world.create_joint(ball_between(8, 9, random));
  world.destroy_bodies(std::vector{world.id_of(8)});
  CHECK_FALSE(world.exists(sixth));
  CHECK_FALSE(world.exists(fifth));
  CHECK(world.exists(fourth));
  world.create_joint(ball_between(9, 10, random));
  World restored(world.save(), {"serial", {}, false});
  CHECK(restored.joint_ids() == world.joint_ids());
  world.create_joint(ball_between(1, 10, random));
  world.step();
  CHECK(world.joint_ids().size() == 5);
}

TEST_CASE("pending joints: threads that read at the same time all see them")
{
  Random random(5);
  World world(heap_of_boxes(300), {}, {"serial", {}, false});
  world.create_joint(ball_between(1, 2, random));
  for (int round = 0; round < 20; ++round) {
    const size_t before = world.scene().joints.size();
    for (uint32_t k = 2; k < 200; ++k) world.create_joint(ball_between(k, k + 1, random));
    std::atomic<uint32_t> there = 0, wrong = 0;
    std::vector<std::thread> readers;
    for (int k = 0; k < 4; ++k)
      readers.emplace_back([&] {
        for (++there; there < 4;) std::this_thread::yield();
        for (int look = 0; look < 20; ++look) wrong += world.scene().joints.size() != before + 198;
      });
    for (std::thread &reader : readers) reader.join();
    REQUIRE(wrong == 0);
  }
}

/* When each call coloured all joints anew, this took longer than tests are given. */
TEST_CASE("pending joints: thousands come, go and come again by single calls")
{
  constexpr uint32_t joints = 20000;
  Random random(1);
  Scene scene = empty_scene({0, 0, 0});
  for (uint32_t k = 0; k <= joints; ++k) add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {2.0 * k, 0, 0});
  scene.joints.push_back(ball_between(0, 1, random));
  World world(scene, {}, {"serial", {}, false});
  std::vector<JointId> ids;
  for (uint32_t k = 1; k < joints; ++k) ids.push_back(world.create_joint(ball_between(k, k + 1, random)));
  world.step();
  CHECK(world.joint_ids().size() == joints);
  for (const JointId &id : ids) world.destroy_joint(id);
  world.step();
  CHECK(world.joint_ids().size() == 1);
  for (uint32_t k = 1; k < joints; ++k) world.create_joint(ball_between(k, k + 1, random));
  world.step();
  CHECK(world.joint_ids().size() == joints);
}
