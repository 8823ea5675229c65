/* worlds.cpp - lets every allocation in the life of a world fail in turn: while it is made, in its steps, while it is
 * read and written.
 *
 * The method is that of SQLite's out-of-memory tests. A world that cannot be made leaves nothing behind. A step happens
 * whole or not at all, and the world then continues with the bits of a world without failures. A query changes
 * nothing. */
#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <tbb/info.h>

#include "tests/heap/attempt.h"
#include "tests/heap/heap_cases.h"
#include "tools/command/parallel.h"

using namespace tandem;
using namespace tandem::fault_scenes;
using namespace tests::heap;

namespace {

const Placement serial{"serial", {}, false}, two_threads{"tbb:threads=2", {}, false};

/* A world as it was before something failed, and as it goes on. */
void check_goes_on(World &world, const std::vector<uint64_t> &undisturbed, size_t at)
{
  REQUIRE(world.state_hash() == undisturbed[at]);
  for (size_t k = at + 1; k < undisturbed.size(); ++k) {
    world.step();
    REQUIRE(world.state_hash() == undisturbed[k]);
  }
}

std::unique_ptr<World> world_at(const Scene &scene, const Settings &settings, const Placement &placement, size_t at)
{
  auto world = std::make_unique<World>(scene, settings, placement);
  for (size_t k = 0; k < at; ++k) world->step();
  return world;
}

/* A world up to the call that fails. */
struct Story {
  Scene scene;
  Settings settings;
  Placement placement;
  size_t at;                                             /* steps before the one that fails */
  std::function<void(World &)> prepare = [](World &) {}; /* before it */
};

std::unique_ptr<World> begun(const Story &story)
{
  std::unique_ptr<World> world = world_at(story.scene, story.settings, story.placement, story.at);
  story.prepare(*world);
  return world;
}

/* Hashes before that step and after it, and of one more. */
std::vector<uint64_t> undisturbed_hashes(const Story &story)
{
  const std::unique_ptr<World> world = begun(story);
  std::vector<uint64_t> hashes{world->state_hash()};
  for (int k = 0; k < 2; ++k) {
    world->step();
    hashes.push_back(world->state_hash());
  }
  return hashes;
}

void check_nothing_happened(World &world, const Story &story)
{
  CHECK(world.statistics().steps == story.at);
  CHECK(world.quarantined().empty());
  CHECK_FALSE(world.batch_fault());
  if (story.settings.events) CHECK(world.contact_events().empty());
}

/* How many attempts failed: none of a step that allocates nothing. */
uint64_t fail_everywhere_in_step(const Story &story, uint64_t stride = 1)
{
  const std::vector<uint64_t> undisturbed = undisturbed_hashes(story);
  uint64_t failures = 0;
  for (const bool once : {true, false})
    for (uint64_t nth = 0;; nth += (once ? stride : 7 * stride) * tests::share_of_faults(1)) {
      CAPTURE(story.scene.name, story.settings.solver, story.settings.broadphase, story.placement.on, story.at, nth,
              once);
      const std::unique_ptr<World> world = begun(story);
      const Outcome outcome = attempt(nth, once, [&] { world->step(); });
      check_told(outcome);
      failures += outcome.thrown;
      if (outcome.thrown) check_nothing_happened(*world, story);
      check_goes_on(*world, undisturbed, outcome.thrown ? 0 : 1);
      if (!outcome.struck) break;
    }
  return failures;
}

void check_fails_everywhere_in_step(const Story &story, uint64_t stride = 1)
{
  CHECK(fail_everywhere_in_step(story, stride) > 0);
}

/* Long capsules side by side, slanted, so that all bounds overlap and none touch: many pairs, and little to do.
 * Every second one comes from the side and is among the others in step `meeting`: then there are more pairs than
 * there was room for. */
Scene slanted_rods(int meeting)
{
  Scene scene;
  scene.name = "slanted rods";
  scene.shapes = {capsule_shape(0.02f, 5)};
  scene.bodies.resize(52);
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    Body &body = scene.bodies[i];
    body.position = {0.1 * static_cast<double>(i), 0.1 * static_cast<double>(i), i % 2 ? 0.5 * meeting : 0};
    body.orientation = {0, 0, 0.38268343f, 0.92387953f}; /* by 45 degrees */
    body.linear_velocity = {0, 0, i % 2 ? -30.0f : 0};
  }
  return scene;
}

/* The first step from `first` on that ran again with larger buffers. */
size_t first_growth(const Scene &scene, const Settings &settings, size_t first = 0)
{
  World world(scene, settings, serial);
  for (size_t k = 0; k < 20; ++k) {
    const uint32_t before = world.statistics().overflow;
    world.step();
    if (k >= first && world.statistics().overflow > before) return k;
  }
  FAIL("no buffer has grown");
  return 0;
}

BodyState spoilt(BodyState state)
{
  state.linear_velocity[1] = std::numeric_limits<float>::quiet_NaN();
  return state;
}

using Call = std::function<void(World &)>;

/* Calls that read a world, or query it, and change nothing of its state. */
std::vector<std::pair<const char *, Call>> questions(const Settings &settings)
{
  std::vector<std::pair<const char *, Call>> calls = {
      {"bodies", [](World &world) { world.bodies(); }},
      {"precise_bodies", [](World &world) { world.precise_bodies(); }},
      {"cast_rays", [](World &world) { world.cast_rays(some_rays()); }},
      {"cast_rays_any", [](World &world) { world.cast_rays_any(some_rays()); }},
      {"cast_rays_all", [](World &world) { world.cast_rays_all(some_rays()); }},
      {"cast_boxes", [](World &world) { world.cast_boxes(a_box()); }},
      {"shape cast", [](World &world) { swept_ball(world); }},
      {"overlaps", [](World &world) { overlapped_by_ball(world); }},
      {"state_hash", [](World &world) { world.state_hash(); }},
      {"body_hash", [](World &world) { world.body_hash(); }},
      {"statistics", [](World &world) { world.statistics(); }},
      {"kernels", [](World &world) { world.kernels(); }},
      {"kernel times",
       [](World &world) {
         world.set_profiling(true);
         world.take_kernel_times();
       }},
      {"place",
       [](World &world) {
         world.place(Placement{"serial", {{"solve", "tbb:threads=3"}, {"queries", "serial:order=backward"}}, false});
       }},
      {"set_body", [](World &world) { world.set_body(1, world.bodies()[1]); }},
  };
  if (settings.events) calls.push_back({"contact_events", [](World &world) { world.contact_events(); }});
  if (settings.pair_events) calls.push_back({"pair_events", [](World &world) { world.pair_events(); }});
  return calls;
}

/* Asked again with memory enough, it answers as one that was never refused; then it goes on. */
void fail_everywhere_in(const Call &call, const Story &story)
{
  const std::vector<uint64_t> undisturbed = undisturbed_hashes(story);
  for (const bool once : {true, false})
    for (uint64_t nth = 0;; nth += (once ? 1 : 7) * tests::share_of_faults(1)) {
      CAPTURE(nth, once);
      const std::unique_ptr<World> world = begun(story);
      const Outcome outcome = attempt(nth, once, [&] { call(*world); });
      check_told(outcome);
      check_goes_on(*world, undisturbed, 0);
      if (!outcome.struck) break;
    }
}

} // namespace

TEST_CASE("heap: a world that cannot be made for want of any one allocation leaves nothing", "[sanitizer]")
{
  for (const Case &c : heap_cases())
    for (const Placement &placement : {serial, two_threads}) {
      CAPTURE(c.scene, c.what, placement.on);
      const Scene scene = load_scene(c.scene);
      const uint64_t expected = hashes_of(scene, c.settings, placement, 2).back();
      fail_everywhere([&] { World world(scene, c.settings, placement); });
      CHECK(hashes_of(scene, c.settings, placement, 2).back() == expected);
    }
}

TEST_CASE(
    "heap: a step that fails for want of any one allocation leaves the state as it was, and the next ones their bits")
{
  for (const Case &c : heap_cases())
    for (const size_t at : {0, 2}) {
      const bool allocates = at == 0; /* room is made in the first step */
      CAPTURE(c.what, at);
      CHECK(((fail_everywhere_in_step({load_scene(c.scene), c.settings, serial, at}) > 0) || !allocates));
      CHECK(((fail_everywhere_in_step({load_scene(c.scene), c.settings, two_threads, at}, 7) > 0) || !allocates));
    }
}

TEST_CASE("heap: a step in which buffers grow leaves the state as it was where it fails")
{
  for (const auto &[broadphase, stride] :
       {std::pair<Broadphase, uint64_t>{Broadphase::grid, 1}, {Broadphase::trees, 17}, {Broadphase::sap3, 17}})
    for (const int meeting : {0, 2}) {
      const Settings settings = short_step(with(Solver::soft_step, broadphase, true));
      const Scene scene = slanted_rods(meeting);
      const size_t at = first_growth(scene, settings, meeting > 0 ? 1 : 0);
      CHECK((at > 0) == (meeting > 0));
      check_fails_everywhere_in_step({scene, settings, serial, at}, meeting > 0 ? stride : 17);
      check_fails_everywhere_in_step({scene, settings, two_threads, at}, 53);
    }
  check_fails_everywhere_in_step(
      {dense_cluster(52), short_step(with(Solver::soft_step, Broadphase::grid, true)), serial, 0},
      131); /* more colours than there are launches for, too */
}

TEST_CASE("heap: a step that takes a body out leaves it in where it fails")
{
  for (const Case &c : heap_cases()) {
    const Story story{load_scene(c.scene), c.settings, serial, 1,
                      [](World &world) { world.set_body_unchecked(1, spoilt(world.bodies()[1])); }};
    check_fails_everywhere_in_step(story);
  }
}

/* Few of them, as the address sanitizer takes ten times as long. */
TEST_CASE("heap: steps that fail here and there leave nothing behind", "[sanitizer]")
{
  for (const Case &c : heap_cases()) {
    check_fails_everywhere_in_step({load_scene(c.scene), c.settings, two_threads, 0}, 61);
    check_fails_everywhere_in_step({load_scene(c.scene), c.settings, serial, 1,
                                    [](World &world) { world.set_body_unchecked(1, spoilt(world.bodies()[1])); }},
                                   61);
  }
  const Settings settings = short_step(with(Solver::soft_step, Broadphase::grid, true));
  const Scene scene = slanted_rods(2);
  check_fails_everywhere_in_step({scene, settings, serial, first_growth(scene, settings)}, 211);
}

TEST_CASE("heap: what reads a world or asks it something changes nothing where it fails")
{
  for (const Case &c : heap_cases())
    for (const auto &[name, call] : questions(c.settings)) {
      CAPTURE(c.scene, c.what, name);
      fail_everywhere_in(call, {load_scene(c.scene), c.settings, two_threads, 2});
    }
}

TEST_CASE("heap: saving, restoring and going back change nothing where they fail", "[sanitizer]")
{
  const std::vector<std::pair<const char *, Call>> calls = {
      {"save", [](World &world) { world.save(); }},
      {"restore", [](World &world) { world.restore(world.save()); }},
      {"go_back", [](World &world) {
         world.keep_states(2);
         world.go_back(0);
       }}};
  const std::vector<Case> cases = heap_cases();
  for (const auto &[name, call] : calls) {
    CAPTURE(name, cases.front().what);
    fail_everywhere_in(call, {load_scene(cases.front().scene), cases.front().settings, two_threads, 2});
  }
}

TEST_CASE("heap: a step that changes the broadphase is made whole once there is memory")
{
  const auto choose_as_for_a_device = [](World &world) {
    Placement placement = serial;
    placement.broadphase_for = "cl";
    world.place(placement);
    CHECK(world.settings().broadphase == Broadphase::trees); /* until the step */
  };
  check_fails_everywhere_in_step({load_scene("box-grid:nx=5,ny=4,nz=5"),
                                  short_step(with(Solver::soft_step, Broadphase::automatic, true)), serial, 2,
                                  choose_as_for_a_device},
                                 3);
  Placement as_for_a_device = serial;
  as_for_a_device.broadphase_for = "cl";
  const auto choose_as_for_a_cpu = [](World &world) {
    world.place(serial);
    CHECK(world.settings().broadphase == Broadphase::brute_force); /* which needs less room than trees */
  };
  check_fails_everywhere_in_step({load_scene("box-grid:nx=5,ny=4,nz=6"),
                                  short_step(with(Solver::soft_step, Broadphase::automatic, true)), as_for_a_device, 2,
                                  choose_as_for_a_cpu},
                                 3);
}

/* What a broadphase keeps is in buffers that a new layout sizes anew. */
TEST_CASE("heap: bodies that cannot be created for want of memory leave the next steps their bits")
{
  const Settings settings = short_step(with(Solver::soft_step, Broadphase::trees, true));
  const Story story{load_scene("box-grid:nx=3,ny=3,nz=3"), settings, serial, 6};
  const std::vector<uint64_t> undisturbed = undisturbed_hashes(story);
  std::vector<Body> more(40, story.scene.bodies[1]);
  for (size_t k = 0; k < more.size(); ++k) more[k].position = {100.0 + 3.0 * static_cast<double>(k), 50, 0};
  for (uint64_t nth = 0;; nth += 29) {
    CAPTURE(nth);
    const std::unique_ptr<World> world = begun(story);
    const Outcome outcome = attempt(nth, true, [&] { world->create_bodies(more); });
    check_told(outcome);
    if (!outcome.struck) break;
    if (outcome.thrown) check_goes_on(*world, undisturbed, 0);
  }
}

/* The new body brings in a feature, so that all buffers are laid out anew while the others sleep. */
TEST_CASE("heap: a body that cannot be created for want of memory leaves those that sleep as they were")
{
  Settings settings;
  settings.broadphase = Broadphase::brute_force;
  settings.sleeping = true;
  settings.sleep_time = 0.1f;
  const Story story{load_scene("box-grid:nx=2,ny=1,nz=2"), settings, serial, 90};
  Body damped = story.scene.bodies[1];
  damped.position = {100, 50, 0};
  damped.linear_damping = 1;
  const auto hashes_from_here = [](World &world) {
    std::vector<uint64_t> hashes{world.state_hash()};
    world.wake_bodies(world.body_ids());
    for (int k = 0; k < 3; ++k) {
      hashes.push_back(world.state_hash());
      world.step();
    }
    return hashes;
  };
  const std::unique_ptr<World> undisturbed = begun(story), called = begun(story);
  REQUIRE(undisturbed->statistics().asleep == 4);
  called->create_body(damped);
  REQUIRE(called->statistics().asleep == 4);
  const std::vector<uint64_t> without = hashes_from_here(*undisturbed), with_it = hashes_from_here(*called);
  uint64_t failures = 0;
  for (const bool once : {true, false})
    for (uint64_t nth = 0;; nth += tests::share_of_faults(1)) {
      CAPTURE(nth, once);
      const std::unique_ptr<World> world = begun(story);
      const Outcome outcome = attempt(nth, once, [&] { world->create_body(damped); });
      check_told(outcome);
      failures += outcome.thrown;
      REQUIRE(hashes_from_here(*world) == (outcome.thrown ? without : with_it));
      if (!outcome.struck) break;
    }
  CHECK(failures > 0);
}

/* The islands of `direct` are solved by tasks of TBB, for which all memory is taken before the first one starts. */
TEST_CASE("heap: a step whose tasks run in other threads allocates in the one that asked for it alone", "[sanitizer]")
{
  if (tbb::info::default_concurrency() < 2) tests::skip("one processor: TBB has no other threads");
  const Story story{load_scene("box-stack:n=64,height=1"), short_step(with(Solver::direct, Broadphase::grid, false)),
                    serial, 0};
  const std::vector<uint64_t> undisturbed = undisturbed_hashes(story);
  uint64_t failures = 0;
  for (uint64_t nth = 0;; ++nth) {
    CAPTURE(nth);
    const std::unique_ptr<World> world = begun(story);
    const Outcome outcome = attempt(nth, true, [&] { world->step(); });
    check_told(outcome);
    CHECK_FALSE(struck_another_thread());
    failures += outcome.thrown;
    check_goes_on(*world, undisturbed, outcome.thrown ? 0 : 1);
    if (!outcome.struck) break;
  }
  CHECK(failures > 0);
}

TEST_CASE("heap: work in parallel is done by fewer threads where there is no memory for more")
{
  for (uint64_t nth = 0;; ++nth)
    for (const bool once : {true, false}) {
      CAPTURE(nth, once);
      std::array<std::atomic<int>, 20> done{};
      const Outcome outcome = attempt(nth, once, [&] { in_parallel(done.size(), 4, [&](size_t i) { ++done[i]; }); });
      check_told(outcome);
      if (!outcome.thrown) CHECK(std::all_of(done.begin(), done.end(), [](const auto &times) { return times == 1; }));
      if (!outcome.struck) return;
    }
}

namespace {

/* A net of balls, half of which hangs on the world, and a floor. Some joints have axes, some can break, and one place
 * is free. */
Scene joined_balls()
{
  Scene scene;
  scene.name = "joined balls";
  scene.shapes = {half_space_shape(), sphere_shape(0.3f)};
  scene.bodies.resize(9);
  scene.bodies[0].type = BodyType::fixed;
  for (size_t i = 1; i < scene.bodies.size(); ++i) {
    scene.bodies[i].shape = 1;
    scene.bodies[i].position = {0.55 * static_cast<double>(i % 4), 0.3 + 0.59 * static_cast<double>(i / 4), 0};
  }
  for (uint32_t i = 2; i < scene.bodies.size(); ++i) {
    Joint joint;
    joint.type = i % 2 ? JointType::ball : JointType::hinge;
    joint.body_a = i % 3 ? i - 1 : no_body;
    joint.body_b = i;
    for (size_t k = 0; k < 3; ++k)
      joint.position_a[k] =
          scene.bodies[i].position[k] - (joint.body_a == no_body ? 0 : scene.bodies[joint.body_a].position[k]);
    if (i % 2 == 0) joint.rotations[0] = {.lower = -0.5f, .upper = 0.5f, .friction = 0.1f};
    scene.joints.push_back(joint);
  }
  return scene;
}

Joint one_more_joint(uint32_t a, uint32_t b)
{
  Joint joint;
  joint.body_a = a;
  joint.body_b = b;
  joint.position_a = {0.3, 0, 0};
  joint.position_b = {-0.3, 0, 0};
  return joint;
}

/* All but the last fit the tables. */
std::vector<std::pair<const char *, Call>> calls_of_joints()
{
  return {
      {"create in a free place", [](World &world) { world.create_joint(one_more_joint(3, 8)); }},
      {"destroy", [](World &world) { world.destroy_joint(world.id_of_joint(4)); }},
      {"set", [](World &world) { world.set_joint(world.id_of_joint(4), one_more_joint(2, 6)); }},
      {"set axis", [](World &world) { world.set_joint_axis(world.id_of_joint(0), 3, {.friction = 2}); }},
      {"set to break",
       [](World &world) {
         Joint joint = one_more_joint(2, 6);
         joint.break_force = 1000;
         world.set_joint(world.id_of_joint(4), joint);
       }},
  };
}

} // namespace

TEST_CASE("heap: calls of joints that fail for want of any one allocation change nothing, and can be made again")
{
  const auto free_a_place = [](World &world) { world.destroy_joint(world.id_of_joint(3)); };
  Settings settings = short_step(with(Solver::soft_step, Broadphase::grid, true));
  for (const bool sleeping : {false, true})
    for (const auto &[name, call] : calls_of_joints()) {
      settings.sleeping = sleeping;
      settings.sleep_time = 0.02f;
      const Story story{joined_balls(), settings, serial, sleeping ? size_t{40} : size_t{3}, free_a_place};
      const std::unique_ptr<World> called = begun(story);
      const uint64_t begun_hash = called->state_hash();
      call(*called);
      const std::vector<JointId> ids = called->joint_ids();
      std::vector<uint64_t> expected{called->state_hash()};
      for (int k = 0; k < 4; ++k) {
        called->step();
        expected.push_back(called->state_hash());
      }
      uint64_t failures = 0;
      for (uint64_t nth = 0;; nth += tests::share_of_faults(1)) {
        CAPTURE(name, nth, sleeping);
        const std::unique_ptr<World> world = begun(story);
        const std::vector<JointId> before = world->joint_ids();
        const Outcome outcome = attempt(nth, true, [&] { call(*world); });
        check_told(outcome);
        failures += outcome.thrown;
        if (outcome.thrown) {
          REQUIRE(world->joint_ids() == before);
          REQUIRE(world->state_hash() == begun_hash);
          call(*world);
        }
        REQUIRE(world->joint_ids() == ids);
        for (size_t k = 0; k < expected.size(); ++k) {
          CAPTURE(k, outcome.thrown);
          if (k > 0) world->step();
          REQUIRE(world->state_hash() == expected[k]);
        }
        if (!outcome.struck) break;
      }
      CHECK(failures > 0);
    }
}
