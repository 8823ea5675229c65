/* Islands that fall asleep and wake: every kernel of every step has the same bits on every backend, and so do the rows
 * that move between two steps. */
#include <algorithm>

#include "tests/parity/joints.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

/* Heaps that fall asleep one after another, and what wakes some of them: balls, calls, bodies that go, and a trigger
 * that passes. */
void disturb(World &world, uint64_t step)
{
  const std::vector<BodyId> ids = world.body_ids();
  if (step % 35 == 34) world.add_impulse(ids[1 + step % (ids.size() - 1)], {{0.5f, 3, 0}});
  if (step % 60 == 50) {
    Body ball;
    ball.shape = 2;
    ball.position = {0.02 * static_cast<double>(step % 300), 6, 0};
    ball.linear_velocity = {0, -6, 0.1f};
    world.create_body(ball);
  }
  if (step == 100) world.destroy_body(ids[4]);
}

Scene heaps()
{
  Scene scene;
  scene.name = "heaps";
  scene.shapes = {half_space_shape(), box_shape(0.5f, 0.5f, 0.5f), sphere_shape(0.3f), box_shape(0.2f, 0.6f, 0.3f)};
  scene.bodies.resize(1);
  scene.bodies[0].type = BodyType::fixed;
  Random random(3);
  for (int heap = 0; heap < 4; ++heap)
    for (int k = 0; k < 3 + heap; ++k) {
      Body body;
      body.shape = random.uniform(0, 2) < 1 ? 1 : 3;
      body.position = {2.5 * heap + random.uniform(-0.1, 0.1), 0.6 + 1.05 * k, random.uniform(-0.1, 0.1)};
      scene.bodies.push_back(body);
    }
  Body trigger;
  trigger.type = BodyType::kinematic;
  trigger.trigger = true;
  trigger.shape = 1;
  trigger.position = {-3, 1, 0};
  trigger.linear_velocity = {8, 0, 0};
  scene.bodies.push_back(trigger);
  return scene;
}

/* The same with two chains in reduced coordinates that lie on the ground, of which the balls and impulses wake one or
 * the other, and a third that hangs from the world above a heap. */
Scene heaps_and_trees()
{
  Scene scene = heaps();
  scene.name = "heaps and trees";
  scene.shapes.push_back(box_shape(0.22f, 0.1f, 0.15f));
  for (uint32_t tree = 0; tree < 3; ++tree) {
    const auto first = uint32_t(scene.bodies.size());
    Articulation articulation;
    for (uint32_t k = 0; k < 4; ++k) {
      Body link;
      link.shape = uint32_t(scene.shapes.size()) - 1;
      link.position = {0.5 * k + 2.0 * tree, tree == 2 ? 5.0 : 0.1, tree == 2 ? 2.0 : 1.5};
      scene.bodies.push_back(link);
      if (k == 0 && tree != 2) continue;
      Joint joint;
      joint.type = k % 2 ? JointType::hinge : JointType::ball;
      joint.body_a = k == 0 ? no_body : first + k - 1;
      joint.body_b = first + k;
      joint.position_a = k == 0 ? Point{link.position[0] - 0.25, 5, 2} : Point{0.25, 0, 0};
      joint.position_b = {-0.25, 0, 0};
      joint.orientation_a = joint.orientation_b = {0, -0.70710678f, 0, 0.70710678f}; /* x of the frames along z */
      if (k % 2) joint.rotations[0].damping = 0.3f;
      articulation.joints.push_back(uint32_t(scene.joints.size()));
      scene.joints.push_back(joint);
    }
    if (tree != 2) articulation.root = first;
    scene.articulations.push_back(articulation);
  }
  return scene;
}

ComparisonRequest request_on(std::vector<std::string> backends, uint64_t steps, Broadphase broadphase)
{
  ComparisonRequest request;
  request.settings.sleeping = true;
  request.settings.sleep_time = 0.2f;
  request.settings.events = true;
  request.settings.broadphase = broadphase;
  request.backends = std::move(backends);
  request.steps = steps;
  request.before_step = disturb;
  return request;
}

ComparisonRequest request_on_pocl()
{
  ComparisonRequest request = request_on({"tbb", "cl:pocl"}, 120, Broadphase::grid);
  request.settings = build_of_all_features(request.settings);
  return request;
}

void require_equal(const ComparisonRequest &request, const Scene &scene = heaps())
{
  const Comparison comparison = compare_backends(scene, request);
  if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
  CHECK(comparison.steps == request.steps);
}

} // namespace

TEST_CASE("parity on CPU: islands that fall asleep and wake")
{
  require_equal(request_on(cpu_backends(), 160, Broadphase::grid));
}

TEST_CASE("parity on CPU: islands that sleep, with broadphases that keep lists", "[sanitizer]")
{
  for (const Broadphase broadphase : {Broadphase::bvh, Broadphase::trees, Broadphase::sap3})
    require_equal(request_on({"serial", "tbb:threads=2,lanes=4"}, 150, broadphase));
}

TEST_CASE("parity on OpenCL: islands that fall asleep and wake")
{
  require_pocl();
  require_equal(request_on_pocl());
}

/* Bodies that fall asleep take other places, and a build of all features asks for the node of every body. */
TEST_CASE("joined bodies that fall asleep have the same bits in a build of all features")
{
  using namespace physics_tests;
  Settings settings;
  settings.sleeping = true;
  settings.substeps = 2;
  settings.sleep_speed = 2;
  settings.sleep_time = 0.05f;
  uint32_t slept = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    Scene scene = empty_scene();
    add_ground(scene);
    for (uint32_t k = 0; k < 24; ++k) {
      const Vector at(random.uniform(-1, 1), random.uniform(0.2, 1.5), random.uniform(-1, 1));
      add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.1f, 0.15f), point_of(at)).orientation = any_turn(random);
      if (k % 3 == 1) connect(scene, JointType::ball, k, k + 1, at + Vector(0, 0.2, 0));
    }
    World world(scene, settings, {"serial", {}, false});
    World whole(scene, build_of_all_features(settings), {"serial", {}, false});
    for (int step = 0; step < 40; ++step) {
      world.step();
      whole.step();
      CAPTURE(seed, step);
      REQUIRE(world.body_hash() == whole.body_hash());
      slept = std::max(slept, world.statistics().asleep);
    }
  }
  CHECK(slept > 2);
}

TEST_CASE("parity on CPU: articulations that fall asleep and wake", "[articulations]")
{
  require_equal(request_on(cpu_backends(), 160, Broadphase::grid), heaps_and_trees());
}

TEST_CASE("parity on PoCL: articulations that fall asleep and wake", "[articulations]")
{
  require_pocl();
  require_equal(request_on_pocl(), heaps_and_trees());
}

TEST_CASE("a snapshot with sleepers goes on with the same bits on another backend", "[sanitizer]")
{
  const Settings settings = request_on({"serial"}, 0, Broadphase::grid).settings;
  const bool has_trees = GENERATE(false, true);
  const Scene scene = has_trees ? heaps_and_trees() : heaps();
  World world(scene, settings, {"tbb:threads=2,lanes=8", {}});
  for (uint64_t step = 0; step < 130; ++step) {
    disturb(world, step);
    world.step();
  }
  REQUIRE(world.statistics().asleep > 0);
  const auto sleeps = [&](const Articulation &tree) {
    return tree.root != no_body && world.is_asleep(world.id_of(tree.root));
  };
  REQUIRE(std::any_of(scene.articulations.begin(), scene.articulations.end(), sleeps) == has_trees);
  const std::vector<std::byte> bytes = world.save();
  World other(bytes, {"serial", {}});
  CHECK(other.state_hash() == world.state_hash());
  CHECK(other.save() == bytes);
  for (uint64_t step = 130; step < 350; ++step) {
    for (World *one : {&world, &other}) {
      disturb(*one, step);
      one->step();
    }
    CAPTURE(step);
    REQUIRE(other.state_hash() == world.state_hash());
    REQUIRE(other.statistics().asleep == world.statistics().asleep);
  }
}

/* The scene must do what it is for. */
TEST_CASE("the scene of the parity of sleep falls asleep and wakes", "[sanitizer]")
{
  const ComparisonRequest request = request_on({"serial"}, 600, Broadphase::grid);
  const bool has_trees = GENERATE(false, true);
  const auto first_link = uint32_t(heaps().bodies.size());
  World world(has_trees ? heaps_and_trees() : heaps(), request.settings, {"serial", {}});
  uint32_t fell = 0, woke = 0, links_fell = 0, links_woke = 0;
  const auto is_link = [&](const BodyId &id) {
    return has_trees && id.index >= first_link && id.index < first_link + 12;
  };
  for (uint64_t step = 0; step < request.steps; ++step) {
    disturb(world, step);
    world.step();
    for (const SleepEvent &event : world.sleep_events()) {
      event.asleep ? ++fell : ++woke;
      if (is_link(event.body)) event.asleep ? ++links_fell : ++links_woke;
    }
  }
  CHECK(fell > 20);
  CHECK(woke > 12);
  CHECK((links_fell >= 12) == has_trees);
  CHECK((links_woke >= 4) == has_trees);
}
