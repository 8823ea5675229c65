/* A batch of worlds: each goes on as it would alone, whatever is done to it and to those beside it. */
#include <limits>

#include "tests/host/runtime/opencl/pocl.h"
#include "tests/host/world/worlds.h"

namespace tandem::tests {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/* A slab with so many boxes on it that its contacts need more than the 63 colours. */
Scene loaded_slab(int boxes)
{
  Scene scene;
  scene.name = "loaded slab";
  scene.shapes = {half_space_shape(), box_shape(6, 0.25f, 6), box_shape(0.2f, 0.2f, 0.2f)};
  Body ground;
  ground.type = BodyType::fixed;
  Body slab;
  slab.shape = 1;
  slab.position = {0, 0.25, 0};
  slab.mass = 20;
  scene.bodies = {ground, slab};
  for (int i = 0; i < 81; ++i) {
    Body box;
    box.shape = 2;
    const double height = i < boxes ? 0.7 : 40; /* the others are still far above */
    box.position = {-4.0 + i % 9, height, -4.0 + i / 9};
    scene.bodies.push_back(box);
  }
  return scene;
}

std::vector<std::string> backends()
{
  std::vector<std::string> all = {"serial", "tbb:threads=2"};
  parity::add_pocl(all);
  return all;
}

std::vector<Scene> small_piles(uint32_t worlds) { return seeded_scenes("falling-boxes:n=8,height=0", worlds); }

} // namespace

TEST_CASE("a batch of worlds: resets at any time")
{
  for (const std::string &backend : backends()) {
    Settings settings;
    settings.events = settings.pair_events = true;
    BatchBesideWorlds both(small_piles(5), backend, settings);
    both.step(20);
    both.reset({3});
    CHECK(both.batch.steps(3) == 0);
    CHECK(both.batch.steps(2) == 20);
    CHECK(both.batch.contact_events().of(3).empty());
    CHECK_FALSE(both.batch.contact_events().of(2).empty());
    both.step(1);
    for (const auto &event : both.batch.pair_events().of(3)) CHECK(event.kind == ContactEvent::Kind::begin);
    both.step(5);
    both.reset({0, 4, 4});
    both.reset({1});
    both.step(10);
  }
}

TEST_CASE("a batch of worlds: a reset to other poses")
{
  Worlds batch(small_piles(3));
  for (int step = 0; step < 5; ++step) batch.step();
  std::vector<BodyState> states = batch.bodies(2);
  batch.reset(std::vector<uint32_t>{0}, states);
  CHECK(batch.bodies(0)[3].position == states[3].position);
  CHECK(batch.steps(0) == 0);
  Scene scene = batch.scene(0);
  World alone(scene, {}, {"serial", {}});
  for (uint32_t body = 0; body < states.size(); ++body) alone.set_state(alone.id_of(body), states[body]);
  for (int step = 0; step < 10; ++step) {
    batch.step();
    alone.step();
    CHECK(batch.state_hash(0) == alone.state_hash());
  }
}

TEST_CASE("a batch of worlds: gravity of their own")
{
  std::vector<Scene> scenes = small_piles(4);
  scenes[1].gravity = {0, -1.6f, 0};
  scenes[2].gravity = {3, -9, 1};
  for (const std::string &backend : backends()) {
    BatchBesideWorlds both(scenes, backend);
    both.step(10);
    both.batch.set_gravity(3, {0, 4, 0});
    both.alone[3]->set_gravity({0, 4, 0});
    both.step(10);
    CHECK(both.batch.scene(3).gravity == Vec3{0, 4, 0});
    both.reset({3});
    both.step(5);
    const std::vector<uint32_t> all = {0, 1, 2, 3};
    const std::vector<Vec3> gravity(4, Vec3{1, -5, 0});
    both.batch.set_gravity(all, gravity);
    for (const auto &world : both.alone) world->set_gravity({1, -5, 0});
    both.step(5);
  }
}

TEST_CASE("a batch of worlds: other shapes, materials and features in each")
{
  std::vector<Scene> scenes = {load_scene("falling-boxes:n=30,height=0"), load_scene("spheres:n=30,height=0"),
                               load_scene("convex-hulls:n=26"), load_scene("mixed:n=26"), load_scene("compounds:n=30")};
  size_t bodies = 31;
  for (Scene &scene : scenes) scene.bodies.resize(std::min(bodies, scene.bodies.size()));
  for (const Scene &scene : scenes) bodies = std::min(bodies, scene.bodies.size());
  for (Scene &scene : scenes) scene.bodies.resize(bodies);
  for (const std::string &backend : backends()) BatchBesideWorlds(scenes, backend).step(25);
}

TEST_CASE("a batch of worlds: calls to bodies")
{
  BatchBesideWorlds both(small_piles(3), "tbb:threads=2");
  both.step(5);
  both.batch.add_impulses(std::vector<WorldBody>{{1, 4}, {2, 2}},
                          std::vector<Impulse>{{{1, 2, 0}, {}, {}}, {{0, 1, 1}, {}, {}}});
  both.alone[1]->add_impulse(both.alone[1]->id_of(4), {{1, 2, 0}, {}, {}});
  both.alone[2]->add_impulse(both.alone[2]->id_of(2), {{0, 1, 1}, {}, {}});
  both.step(3);
  for (int step = 0; step < 5; ++step) { /* forces in one world alone bring their stage into the steps of all */
    both.batch.add_forces(std::vector<WorldBody>{{1, 3}}, std::vector<Force>{{{0, 30, 5}, {}, {}}});
    both.alone[1]->add_force(both.alone[1]->id_of(3), {{0, 30, 5}, {}, {}});
    both.step(1);
  }
  both.batch.set_properties(std::vector<WorldBody>{{0, 2}}, std::vector<BodyProperties>{{.linear_damping = 2.0f}});
  both.alone[0]->set_damping(both.alone[0]->id_of(2), 2, 0);
  both.step(5);
  both.batch.add_forces(std::vector<WorldBody>{{1, 3}}, std::vector<Force>{{{0, 30, 5}, {}, {}}});
  both.reset({0, 1});
  both.step(5);
}

TEST_CASE("a batch of worlds: a body that stops being finite is taken out of its world alone")
{
  for (const std::string &backend : backends()) {
    BatchBesideWorlds both(small_piles(4), backend);
    both.step(12);
    for (const auto &[world, body] : std::vector<WorldBody>{{1, 5}, {3, 2}, {3, 7}}) {
      BodyState bad = both.alone[world]->bodies()[body];
      bad.linear_velocity[1] = not_a_number;
      both.batch.set_state_unchecked({world, body}, bad);
      both.alone[world]->set_body_unchecked(body, bad);
    }
    both.step(10);
    CHECK(both.batch.quarantined(0).empty());
    REQUIRE(both.batch.quarantined(3).size() == 2);
    CHECK(both.batch.quarantined(3)[1].body == both.alone[3]->quarantined()[1].body);
    CHECK(both.batch.quarantined(3)[1].step == both.alone[3]->quarantined()[1].step);
    both.reset({3});
    CHECK(both.batch.quarantined(3).empty());
    both.step(10);
  }
}

/* Alone, a world that loses more than 32 bodies in a step loses the rest at once; those beside it do not count. */
TEST_CASE("a batch of worlds: many bodies stop being finite in one step")
{
  BatchBesideWorlds both(seeded_scenes("spheres:n=48,height=0", 12), "tbb:threads=2");
  both.step(5);
  for (uint32_t world = 0; world < 12; ++world)
    for (uint32_t body = 1; body <= (world == 7 ? 40u : 5u); ++body) {
      BodyState bad = both.alone[world]->bodies()[body];
      bad.linear_velocity[0] = not_a_number;
      both.batch.set_state_unchecked({world, body}, bad);
      both.alone[world]->set_body_unchecked(body, bad);
    }
  both.step(4);
  CHECK(both.batch.quarantined(7).size() == 40);
  CHECK(both.batch.quarantined(6).size() == 5);
}

TEST_CASE("a batch of worlds: overflow constraints in some of them")
{
  for (const std::string &backend : backends()) {
    const std::vector<Scene> scenes = {loaded_slab(9), loaded_slab(81), loaded_slab(30), loaded_slab(75)};
    BatchBesideWorlds both(scenes, backend);
    both.step(20);
    CHECK(both.alone[1]->statistics().colors > 63);
    CHECK(both.alone[0]->statistics().colors < 20);
    both.reset({1});
    both.step(8);
  }
}

TEST_CASE("a batch of worlds: buffers that overflow grow, and no bit changes")
{
  std::vector<Scene> scenes = varied_scenes("spheres:n=64,height=0", 12);
  for (size_t world = 6; world < scenes.size(); ++world)
    for (Body &body : scenes[world].bodies)
      if (body.type == BodyType::dynamic)
        for (double &x : body.position) x *= 0.2; /* all overlap with most others */
  for (const std::string &backend : backends()) {
    BatchBesideWorlds both(scenes, backend);
    both.step(4);
    CHECK(both.batch.statistics().overflow > 0);
  }
}

/* Rows of the cache that no pair has any more must decide nothing, not even the sign of a zero. */
TEST_CASE("a batch of worlds: contacts that come after all others have gone")
{
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.shapes = {box_shape(0.5f, 0.5f, 0.5f)};
  scene.bodies.resize(2);
  scene.bodies[0].linear_velocity = {3, 0.5f, -0.25f};
  scene.bodies[0].position = {-1.2, 0.1, 0.05};
  std::vector<Scene> scenes(4, scene);
  scenes[1].bodies[0].linear_velocity = {3, -0.5f, 0.5f};
  scenes[2].bodies[0].position = {-9, 0, 0};
  BatchBesideWorlds both(scenes, "tbb:threads=2");
  both.step(10);
  for (const auto &[from, velocity] : std::vector<std::pair<Point, Vec3>>{
           {{0.1, -1.3, 0}, {0.5f, 4, 0.25f}}, {{20, 0, 0}, {0, 0, 0}}, {{0, 0.1, 1.2}, {-0.5f, -0.25f, -4}}}) {
    for (const uint32_t world : {0u, 1u}) {
      const std::vector<BodyState> states = {{from, {0, 0, 0, 1}, velocity, {}}, {{0, 0, 0}, {0, 0, 0, 1}, {}, {}}};
      both.batch.set_states(std::vector<WorldBody>{{world, 0}, {world, 1}}, states);
      both.alone[world]->set_states(both.alone[world]->body_ids(), states);
    }
    both.step(8);
  }
}

TEST_CASE("a batch of worlds: a world goes on alone")
{
  BatchBesideWorlds both(small_piles(3), "tbb:threads=2");
  both.step(15);
  const std::vector<std::byte> bytes = both.batch.save(1);
  CHECK(bytes == both.alone[1]->save());
  World restored(bytes, {"serial", {}});
  const std::unique_ptr<World> taken = both.batch.alone(2, {"tbb:threads=2", {}});
  both.step(5);
  for (int step = 0; step < 5; ++step) {
    restored.step();
    taken->step();
  }
  CHECK(restored.state_hash() == both.batch.state_hash(1));
  CHECK(taken->state_hash() == both.batch.state_hash(2));
}

TEST_CASE("a batch of worlds: a saved world goes on in any place")
{
  const Scene scene = load_scene("falling-boxes:n=8,height=0");
  std::vector<Scene> scenes(5, scene);
  scenes[3].gravity = {1, -4, 0};
  BatchBesideWorlds both(scenes, "tbb:threads=2");
  both.step(18);
  BodyState bad = both.alone[3]->bodies()[2];
  bad.linear_velocity[0] = not_a_number;
  both.batch.set_state_unchecked({3, 2}, bad);
  both.alone[3]->set_body_unchecked(2, bad);
  both.step(4);
  both.reset({1});
  both.step(6);
  const std::vector<std::byte> third = both.batch.save(3), first = both.alone[1]->save();
  const auto put = [&](uint32_t world, const std::vector<std::byte> &bytes) {
    both.batch.load(world, bytes);
    both.alone[world]->restore(bytes);
    both.require_equal();
  };
  put(0, third); /* with its gravity and its body in quarantine */
  put(4, first); /* which is younger than the batch */
  put(2, third);
  CHECK(both.batch.steps(4) == 6);
  CHECK(both.batch.quarantined(2).size() == 1);
  CHECK(both.batch.scene(0).gravity == Vec3{1, -4, 0});
  both.step(10);
  both.reset({0, 2});
  both.step(5);
  Worlds other(load_scene("spheres:n=8"), 2);
  CHECK_THROWS_WITH(other.load(0, third), Catch::Matchers::ContainsSubstring("another scene than that of world 0"));
}

TEST_CASE("a batch of worlds: one world, still worlds and empty ones")
{
  BatchBesideWorlds(small_piles(1), "serial").step(10);
  Scene still = load_scene("falling-boxes:n=4");
  for (Body &body : still.bodies) body.type = BodyType::fixed;
  BatchBesideWorlds(std::vector<Scene>(3, still), "serial").step(3);
  Worlds empty(Scene{}, 4);
  empty.step();
  empty.reset(2);
  CHECK(empty.bodies().empty());
  CHECK(empty.steps(2) == 0);
  CHECK(empty.steps(1) == 1);
}

TEST_CASE("a batch of worlds: what it refuses")
{
  const Scene scene = load_scene("falling-boxes:n=8");
  const auto refused = [&](const std::string &why, const auto &call) {
    CAPTURE(why);
    CHECK_THROWS_WITH(call(), Catch::Matchers::ContainsSubstring(why));
  };
  refused("0 worlds; at least 1 is needed", [&] { Worlds batch(scene, 0); });
  refused("kernels can number 268435455", [&] { Worlds batch(scene, 100000000); });
  refused("has 8 bodies and scene 0 has 9", [&] {
    Worlds batch(std::vector<Scene>{scene, load_scene("falling-boxes:n=7")});
  });
  const auto with = [&](auto change) {
    Settings settings;
    change(settings);
    return [&scene, settings] { Worlds batch(scene, 2, settings); };
  };
  refused("substeps auto", with([](Settings &s) { s.substeps = automatic_substeps; }));
  refused("sleeping", with([](Settings &s) { s.sleeping = true; }));
  refused("pgs", with([](Settings &s) { s.solver = Solver::pgs; }));
  refused("iterative", with([](Settings &s) { s.batching = Batching::iterative; }));
  refused("sap", with([](Settings &s) { s.broadphase = Broadphase::sap; }));
  refused("check", with([](Settings &s) { s.check = true; }));
  Worlds batch(scene, 2);
  refused("world 2 does not exist; there are 2", [&] { batch.reset(2); });
  refused("entry 1: body 9 does not exist; worlds have 9 bodies", [&] {
    batch.set_velocities(std::vector<WorldBody>{{0, 1}, {1, 9}}, std::vector<Velocity>(2));
  });
  refused("material 3 does not exist", [&] {
    batch.set_properties(std::vector<WorldBody>{{0, 1}}, std::vector<BodyProperties>{{.material = 3}});
  });
  refused("entry 0: continuous: bodies of a batch keep what their scene says", [&] {
    batch.set_properties(std::vector<WorldBody>{{0, 1}}, std::vector<BodyProperties>{{.continuous = true}});
  });
  refused("three finite numbers are needed", [&] { batch.set_gravity(1, {0, not_a_number, 0}); });
}

TEST_CASE("a batch of worlds: a world that was reset can bring a feature before its next step")
{
  BatchBesideWorlds both(small_piles(3), "serial");
  both.step(20);
  both.reset({1});
  both.batch.set_properties(std::vector<WorldBody>{{2, 3}}, std::vector<BodyProperties>{{.linear_damping = 1.0f}});
  both.alone[2]->set_damping(both.alone[2]->id_of(3), 1, 0);
  both.step(10);
}

TEST_CASE("a batch of worlds: a reset follows the types that bodies have now")
{
  std::vector<Scene> scenes = varied_scenes("falling-boxes:n=6", 2);
  scenes[1].bodies[4].type = BodyType::fixed; /* with a velocity that it would have as a dynamic one */
  BatchBesideWorlds both(scenes, "serial");
  both.step(5);
  const auto set_type = [&](uint32_t world, uint32_t body, BodyType type) {
    both.batch.set_properties(std::vector<WorldBody>{{world, body}}, std::vector<BodyProperties>{{.type = type}});
    both.alone[world]->set_type(both.alone[world]->id_of(body), type);
  };
  set_type(0, 3, BodyType::fixed);
  set_type(1, 4, BodyType::dynamic);
  both.step(5);
  both.reset({0, 1});
  both.step(10);
}

TEST_CASE("a batch of worlds: a feature that was given up is forgotten by a reset")
{
  BatchBesideWorlds both(small_piles(2), "serial");
  both.batch.set_properties(std::vector<WorldBody>{{0, 2}}, std::vector<BodyProperties>{{.linear_damping = 1.0f}});
  both.batch.step();
  both.batch.set_properties(std::vector<WorldBody>{{0, 2}}, std::vector<BodyProperties>{{.linear_damping = 0.0f}});
  for (const auto &world : both.alone) world->step();
  both.reset({0});
  both.step(5);
}

TEST_CASE("a batch of worlds: worlds of every feature are saved and loaded, too")
{
  Settings settings;
  settings.specialise = false;
  BatchBesideWorlds both(small_piles(2), "serial", settings);
  both.step(12);
  World again(both.batch.save(1));
  CHECK(again.state_hash() == both.batch.state_hash(1));
  both.batch.load(0, both.batch.save(0));
  both.step(3);
}

TEST_CASE("a batch of worlds: what load refuses leaves the batch as it was, and a loaded world has no events yet")
{
  Settings settings;
  settings.events = settings.pair_events = settings.moved_bodies = true;
  Worlds batch(load_scene("falling-boxes:n=8,height=0"), 3, settings);
  for (int step = 0; step < 30; ++step) batch.step();
  REQUIRE(!batch.pair_events().of(1).empty());
  const std::vector<std::byte> saved = batch.save(1);
  const std::vector<uint64_t> before = batch.state_hashes();
  Settings other = settings;
  other.step = 1.0f / 30;
  World lone(batch.scene(1), other);
  CHECK_THROWS_WITH(batch.load(1, lone.save()), Catch::Matchers::ContainsSubstring("other settings"));
  CHECK(batch.state_hashes() == before);
  batch.load(2, saved);
  CHECK(batch.state_hash(2) == before[1]);
  CHECK(batch.contact_events().of(2).empty());
  CHECK(batch.pair_events().of(2).empty());
  CHECK(batch.moved_bodies().of(2).empty());
  CHECK_THROWS_AS(batch.pair_events().of(UINT32_MAX), std::out_of_range);
}

TEST_CASE("a batch of worlds: no more pairs are loaded than the settings allow")
{
  const Scene scene = load_scene("falling-boxes:n=8,height=0");
  World settled(scene);
  for (int step = 0; step < 30; ++step) settled.step();
  Settings settings;
  settings.max_pairs = 2 * settled.statistics().pairs;
  Worlds batch(scene, 3, settings);
  batch.load(0, settled.save());
  batch.load(1, settled.save());
  const uint64_t before = batch.state_hash(2);
  CHECK_THROWS_WITH(batch.load(2, settled.save()), Catch::Matchers::ContainsSubstring("are the most"));
  CHECK(batch.state_hash(2) == before);
  batch.load(1, settled.save()); /* in the place of as many */
}

TEST_CASE("a batch of worlds: a reset to states that are refused changes nothing")
{
  Worlds batch(small_piles(2), {}, {"serial", {}});
  for (int step = 0; step < 5; ++step) batch.step();
  const std::vector<uint64_t> before = batch.state_hashes();
  std::vector<BodyState> states = batch.bodies(1);
  states[3].position[0] = not_a_number;
  CHECK_THROWS_AS(batch.reset(std::vector<uint32_t>{1}, states), InputError);
  CHECK(batch.state_hashes() == before);
  CHECK(batch.steps(1) == 5);
}

} // namespace tandem::tests
