/* A batch that threads of a CPU step in groups of worlds, beside the same batch in one piece: calls reach worlds of
 * several groups, all of them or none. */
#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>

#include "host/base/random.h"
#include "host/runtime/interface/faults.h"
#include "tests/host/runtime/opencl/opencl_device.h"
#include "tests/host/world/worlds.h"
#include "tests/physics/joints.h"

namespace tandem::tests {
namespace {

using namespace physics_tests;
using Catch::Matchers::ContainsSubstring;

constexpr uint32_t worlds_of_all = 8;
constexpr uint32_t ground = 0, platform = 1, first_box = 2, boxes = 5, bodies_of_each = 7;
constexpr uint32_t rail = 0, link = 1;
constexpr uint32_t loaded = 6; /* a world whose scene stays as it is, so that it can be loaded */

/* Boxes over a platform that moves and a ground; one hangs on a rail, and one on another by a joint that breaks. */
Scene busy_scene(uint32_t seed)
{
  Random random(seed);
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::kinematic, box_shape(1, 0.1f, 1), {0, 0.3, 0}).linear_velocity = {0.1f, 0, 0};
  for (uint32_t k = 0; k < boxes; ++k)
    add_body(scene, BodyType::dynamic, box_shape(0.3f, 0.3f, 0.3f), {0.1 * k, 0.9 + 0.7 * k, 0}).linear_velocity =
        vec3_of(direction(random));
  Joint &slider = connect(scene, JointType::slider, no_body, first_box, {0, 0.9, 0});
  slider.directions[0].damping = 1;
  Joint &hinge = connect(scene, JointType::hinge, first_box + 1, first_box + 2, {0, 2, 0}, Vector::UnitZ());
  hinge.rotations[0].stiffness = 5, hinge.rotations[0].damping = 1;
  hinge.break_force = 120;
  scene.materials.push_back({.name = "ice", .static_friction = 0.02f, .dynamic_friction = 0.02f});
  return scene;
}

std::vector<Scene> busy_scenes()
{
  std::vector<Scene> scenes;
  for (uint32_t seed = 1; seed <= worlds_of_all; ++seed) scenes.push_back(busy_scene(seed));
  return scenes;
}

Settings with_events()
{
  Settings settings;
  settings.events = settings.pair_events = settings.moved_bodies = true;
  return settings;
}

Worlds batch_in_groups(uint32_t of_group, const Settings &settings = with_events())
{
  const Environment groups("TANDEM_WORLDS_OF_GROUP", std::to_string(of_group));
  return Worlds(busy_scenes(), settings, {"tbb:threads=2", {}});
}

/* Worlds in an order that goes from group to group and back; some of them twice. */
std::vector<uint32_t> some_worlds(Random &random, uint32_t count)
{
  std::vector<uint32_t> worlds;
  for (uint32_t k = 0; k < count; ++k) worlds.push_back(uint32_t(random.uniform(0, worlds_of_all - 0.01)));
  return worlds;
}

std::vector<WorldBody> some_bodies(Random &random, uint32_t count)
{
  std::vector<WorldBody> bodies;
  for (const uint32_t world : some_worlds(random, count))
    bodies.push_back({world, first_box + uint32_t(random.uniform(0, boxes - 0.01))});
  return bodies;
}

/* One call of each kind in turn, with numbers that follow from the seed. */
void make_some_call(Worlds &worlds, uint32_t kind, uint64_t seed, std::vector<std::byte> &saved)
{
  Random random(seed);
  std::vector<uint32_t> given = some_worlds(random, 5);
  std::vector<WorldBody> bodies = some_bodies(random, 6);
  for (uint32_t &world : given) world = world == loaded ? 5 : world;
  for (WorldBody &body : bodies) body.world = body.world == loaded ? 5 : body.world;
  const auto numbered = [&](auto make) {
    std::vector<decltype(make())> all;
    for (size_t k = 0; k < bodies.size(); ++k) all.push_back(make());
    return all;
  };
  const auto vector = [&] { return vec3_of(direction(random)); };
  switch (kind) {
  case 0: return worlds.set_velocities(bodies, numbered([&] { return Velocity{vector(), vector()}; }));
  case 1: return worlds.add_impulses(bodies, numbered([&] { return Impulse{vector(), {}, {}}; }));
  case 2: return worlds.add_forces(bodies, numbered([&] { return Force{vector(), vector(), {}}; }));
  case 3:
    return worlds.set_properties(bodies, numbered([&] {
                                   return BodyProperties{
                                       .material = 1, .mass = float(random.uniform(1, 2)), .linear_damping = 0.5f};
                                 }));
  case 4: {
    std::vector<WorldJoint> joints;
    std::vector<JointAxisChange> changes;
    for (const uint32_t world : given) {
      joints.push_back({world, link});
      changes.push_back({3, {.stiffness = float(random.uniform(1, 9)), .damping = 2}});
    }
    return worlds.set_joint_axes(joints, changes);
  }
  case 5: {
    std::vector<float> values;
    for (size_t k = 0; k < given.size(); ++k) values.push_back(float(random.uniform(-20, 20)));
    return worlds.set_controls(given, values);
  }
  case 6: return worlds.reset(std::span(given).first(2));
  case 7: return worlds.set_gravity(std::vector<uint32_t>{6, 1, 3}, std::vector<Vec3>{vector(), vector(), vector()});
  case 8: /* what it was some calls ago */
    if (!saved.empty()) worlds.load(loaded, saved);
    saved = worlds.save(loaded);
    return;
  case 9:
    return worlds.move_to(std::vector<WorldBody>{{7, platform}, {0, platform}},
                          std::vector<Pose>{{{0.2, 0.3, 0}, {0, 0, 0, 1}}, {{0, 0.3, 0.2}, {0, 0, 0, 1}}});
  default: {
    std::vector<BodyState> states = worlds.bodies(given[1]);
    states[first_box].position[1] += 0.5;
    return worlds.reset(std::vector<uint32_t>{given[1]}, states);
  }
  }
}
constexpr uint32_t kinds_of_calls = 11;

uint64_t number_of(uint32_t body) { return body; }
uint64_t number_of(const JointBreak &one) { return one.joint.index; }
template <class Event> uint64_t number_of(const Event &event) { return uint64_t{event.a} << 32 | event.b; }

template <class Event> void require_same(const WorldEvents<Event> &one, const WorldEvents<Event> &other)
{
  REQUIRE(one.first == other.first);
  REQUIRE(one.all.size() == other.all.size());
  for (size_t k = 0; k < one.all.size(); ++k) REQUIRE(number_of(one.all[k]) == number_of(other.all[k]));
}

void require_same(Worlds &one, Worlds &other)
{
  REQUIRE(one.body_hashes() == other.body_hashes());
  REQUIRE(one.state_hashes() == other.state_hashes());
}

void require_same_answers(Worlds &one, Worlds &other)
{
  require_same(one.contact_events(), other.contact_events());
  require_same(one.hit_events(), other.hit_events());
  require_same(one.pair_events(), other.pair_events());
  require_same(one.joint_breaks(), other.joint_breaks());
  require_same(one.moved_bodies(), other.moved_bodies());
  const Statistics own = one.statistics(), theirs = other.statistics();
  CHECK(own.steps == theirs.steps);
  CHECK(own.pairs == theirs.pairs);
  CHECK(own.contacts == theirs.contacts);
  CHECK(own.manifolds == theirs.manifolds);
  CHECK(own.max_penetration == theirs.max_penetration);
  CHECK(own.mean_penetration == Approx(theirs.mean_penetration).epsilon(1e-9));
  CHECK(own.kinetic_energy == Approx(theirs.kinetic_energy).epsilon(1e-9));
  const std::vector<WorldJoint> joints{{7, rail}, {0, link}, {3, rail}, {3, link}};
  const std::vector<JointReading> read = one.read_joints(joints), expected = other.read_joints(joints);
  for (size_t k = 0; k < joints.size(); ++k) REQUIRE(read[k].force == expected[k].force);
  for (uint32_t world = 0; world < worlds_of_all; ++world) {
    CHECK(one.steps(world) == other.steps(world));
    CHECK(one.state_hash(world) == one.state_hashes()[world]);
    CHECK(one.scene(world).gravity == other.scene(world).gravity);
    CHECK(one.quarantined(world).size() == other.quarantined(world).size());
  }
}

} // namespace

TEST_CASE("groups of worlds take every call as a batch in one piece does", "[sanitizer]")
{
  const uint32_t of_group = GENERATE(1, 3, 4);
  CAPTURE(of_group);
  Worlds groups = batch_in_groups(of_group), whole(busy_scenes(), with_events(), {"serial", {}});
  for (Worlds *worlds : {&groups, &whole})
    worlds->choose_controls(std::vector<ControlledAxis>{{rail, 0, Control::force}});
  require_same(groups, whole);
  BodyState lost;
  lost.position[0] = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::byte> saved, saved_of_whole;
  size_t breaks = 0;
  for (uint32_t turn = 0; turn < 3 * kinds_of_calls; ++turn) {
    CAPTURE(turn);
    make_some_call(groups, turn * 7 % kinds_of_calls, turn, saved);
    make_some_call(whole, turn * 7 % kinds_of_calls, turn, saved_of_whole);
    if (turn % 4 == 1)
      for (Worlds *worlds : {&groups, &whole}) worlds->set_state_unchecked({5, first_box + 4}, lost);
    for (uint32_t step = 0; step < turn % 3; ++step) {
      groups.step();
      whole.step();
      breaks += whole.joint_breaks().all.size();
    }
    require_same(groups, whole);
    if (turn % 3 == 2) require_same_answers(groups, whole);
  }
  CHECK(breaks > 0);
  CHECK(groups.launches() > whole.launches() * (worlds_of_all / of_group) / 2); /* so there are groups */
  for (uint32_t world = 0; world < worlds_of_all; ++world)
    CHECK(groups.alone(world)->state_hash() == whole.state_hash(world));
}

TEST_CASE("what one group refuses, none of them takes")
{
  Worlds groups = batch_in_groups(2), untouched = batch_in_groups(2);
  groups.choose_controls(std::vector<ControlledAxis>{{rail, 0, Control::force}});
  groups.step();
  untouched.step();
  const auto refused = [&](const std::string &why, const auto &call) {
    CAPTURE(why);
    CHECK_THROWS_WITH(call(), ContainsSubstring(why));
    CHECK(groups.state_hashes() == untouched.state_hashes());
    for (uint32_t world = 0; world < worlds_of_all; ++world) {
      CHECK(groups.scene(world).bodies[first_box].mass == untouched.scene(world).bodies[first_box].mass);
      CHECK(groups.scene(world).joints[link].rotations[0] == untouched.scene(world).joints[link].rotations[0]);
    }
  };
  const std::vector<WorldBody> bodies{{1, first_box}, {7, first_box}, {4, first_box}};
  const float infinite = std::numeric_limits<float>::infinity();
  refused("set_velocities: entry 1: linear velocity", [&] {
    groups.set_velocities(bodies, std::vector<Velocity>{{{1, 0, 0}, {}}, {{infinite, 0, 0}, {}}, {}});
  });
  refused("move_to: entry 2: body 2 of world 4 is not kinematic", [&] {
    groups.move_to(std::vector<WorldBody>{{0, platform}, {7, platform}, {4, first_box}}, std::vector<Pose>(3));
  });
  refused("set_properties: world 7: body 2", [&] {
    groups.set_properties(bodies, std::vector<BodyProperties>{{.mass = 3.0f}, {.mass = -1.0f}, {.mass = 3.0f}});
  });
  const BodyProperties fixed{.type = BodyType::fixed}, weightless{.mass = -1.0f};
  refused("set_properties: world 7: body 2", [&] {
    groups.set_properties(std::vector<WorldBody>{{0, first_box + 4}, {7, first_box}},
                          std::vector<BodyProperties>{fixed, weightless});
  });
  refused("its type cannot change in a batch", [&] {
    groups.set_properties(std::vector<WorldBody>{{0, first_box + 4}, {7, first_box}},
                          std::vector<BodyProperties>{fixed, fixed});
  });
  const std::vector<WorldJoint> joints{{0, link}, {6, link}};
  refused("set_joint_axes: world 6: joint 1", [&] {
    groups.set_joint_axes(joints,
                          std::vector<JointAxisChange>{{3, {.stiffness = 7, .damping = 1}}, {4, {.damping = 1}}});
  });
  refused("set_joint_axes: entry 1: axis 6 does not exist", [&] {
    groups.set_joint_axes(joints, std::vector<JointAxisChange>{{3, {.stiffness = 7, .damping = 1}}, {6, {}}});
  });
  refused("control 0 of world 6", [&] {
    groups.set_controls(std::vector<uint32_t>{0, 6}, std::vector<float>{1, infinite});
  });
  refused("world 8 does not exist; there are 8", [&] { groups.reset(std::vector<uint32_t>{0, 8}); });
  refused("choose_controls: entry 0: world 0: joint 2", [&] {
    groups.choose_controls(std::vector<ControlledAxis>{{2, 0, Control::force}});
  });
  groups.step();
  untouched.step();
  CHECK(groups.state_hashes() == untouched.state_hashes());
}

/* A body on which a tree stands is refused by its group alone, after others have taken their calls. */
TEST_CASE("calls that groups have taken are taken back where another refuses them")
{
  std::vector<Scene> scenes = busy_scenes();
  Scene &last = scenes.back();
  connect(last, JointType::hinge, ground, first_box + 4, {0, 0.6, 0}, Vector::UnitZ());
  last.articulations.resize(1);
  last.articulations[0].joints = {uint32_t(last.joints.size() - 1)};
  const Environment groups_of_two("TANDEM_WORLDS_OF_GROUP", "2");
  Worlds groups(scenes, with_events(), {"tbb:threads=2", {}}), untouched(scenes, with_events(), {"tbb:threads=2", {}});
  std::vector<BodyState> states = groups.bodies(0);
  for (BodyState &state : states) state.position[1] += 1;
  const std::vector<BodyState> two{states[first_box], states[ground]};
  CHECK_THROWS_WITH(groups.set_states(std::vector<WorldBody>{{0, first_box}, {7, ground}}, two),
                    ContainsSubstring("set_states: world 7: body 0: it cannot be moved"));
  states.insert(states.end(), states.begin(), states.end());
  CHECK_THROWS_WITH(groups.reset(std::vector<uint32_t>{0, 7}, states),
                    ContainsSubstring("reset: world 7: body 0: it cannot be moved"));
  CHECK(groups.state_hashes() == untouched.state_hashes());
  for (int step = 0; step < 3; ++step) groups.step(), untouched.step();
  CHECK(groups.state_hashes() == untouched.state_hashes());
}

TEST_CASE("limits of a step hold for all groups together, and a step past them leaves the state as it was")
{
  Worlds groups = batch_in_groups(2), untouched = batch_in_groups(2);
  for (int step = 0; step < 40; ++step) groups.step(), untouched.step();
  const uint32_t pairs = groups.statistics().pairs;
  REQUIRE(pairs > 4);
  const std::vector<uint64_t> before = groups.state_hashes();
  CHECK_THROWS_AS(groups.step({.pairs = pairs / 2}), LimitExceeded); /* more than any group has */
  CHECK(groups.state_hashes() == before);
  CHECK(groups.statistics().steps == 40);
  for (int step = 0; step < 3; ++step) groups.step(), untouched.step();
  CHECK(groups.state_hashes() == untouched.state_hashes());
}

namespace {

std::atomic<int64_t> places_left{0};
std::atomic<bool> struck{false};

bool strike_in_turn(faults::Site)
{
  const bool strikes = places_left.fetch_sub(1) == 0;
  if (strikes) struck = true;
  return strikes;
}

/* Whether a place was reached. */
template <class Call> bool fails_at(int64_t place, const Call &call)
{
  places_left = place;
  struck = false;
  faults::hook = strike_in_turn;
  try {
    call();
  } catch (const std::exception &) {}
  faults::hook = nullptr;
  return struck;
}

} // namespace

TEST_CASE("a step that fails in one group leaves the worlds of all as they were", "[sanitizer]")
{
  Worlds untouched = batch_in_groups(3);
  for (int step = 0; step < 4; ++step) untouched.step();
  const std::vector<uint64_t> before = untouched.state_hashes();
  untouched.step();
  const std::vector<uint64_t> after = untouched.state_hashes();
  int failures = 0;
  for (int64_t place = 0;; place += 7) {
    CAPTURE(place);
    Worlds groups = batch_in_groups(3);
    for (int step = 0; step < 4; ++step) groups.step();
    if (!fails_at(place, [&] { groups.step(); })) break;
    ++failures;
    REQUIRE(groups.state_hashes() == before);
    groups.step();
    REQUIRE(groups.state_hashes() == after);
  }
  CHECK(failures > 20);
}

TEST_CASE("the size of groups for tests is a number")
{
  const Environment groups("TANDEM_WORLDS_OF_GROUP", "many");
  CHECK_THROWS_WITH(Worlds(busy_scenes(), Settings{}, Placement{"tbb", {}}),
                    ContainsSubstring("TANDEM_WORLDS_OF_GROUP 'many' is not a whole number"));
}

} // namespace tandem::tests
