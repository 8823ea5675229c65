/* shared_memory_test.cpp - buffers that share memory lose nothing that a step still reads: what is lost is overwritten
 * with numbers that would show, and the bits are those of worlds in which each buffer has memory of its own. */
#include <tandem/error.h>

#include "host/runtime/memory.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

std::unique_ptr<World> world_that_shares(const Scene &scene, const Settings &settings, const std::string &backend)
{
  auto world = std::make_unique<World>(scene, settings, Placement{backend, {}});
  world->memory().poison_shared_memory();
  return world;
}

/* Whoever looks at single launches finds every buffer in memory of its own. */
std::unique_ptr<World> world_apart(const Scene &scene, const Settings &settings)
{
  auto world = std::make_unique<World>(scene, settings, Placement{"serial", {}});
  world->set_observer([](const Launch &) {});
  return world;
}

std::vector<uint64_t> hashes_of(World &world, int steps)
{
  std::vector<uint64_t> hashes;
  for (int k = 0; k < steps; ++k) {
    world.step();
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

void require_same_bits(const Scene &scene, const Settings &settings, int steps)
{
  CAPTURE(scene.name, settings.solver, settings.broadphase, settings.batching, settings.narrowphase);
  const auto apart = world_apart(scene, settings);
  const std::vector<uint64_t> expected = hashes_of(*apart, steps);
  REQUIRE(apart->memory().shared().empty());
  std::vector<std::string> backends = {"serial", "tbb:threads=2"};
  for (const std::string &backend : backends) {
    CAPTURE(backend);
    const auto sharing = world_that_shares(scene, settings, backend);
    CHECK(hashes_of(*sharing, steps) == expected);
    CHECK_FALSE(sharing->memory().shared().empty());
    const Statistics with = sharing->statistics(), without = apart->statistics();
    CHECK(with.contacts == without.contacts);
    CHECK(with.mean_penetration == without.mean_penetration);
    if (settings.events) CHECK(sharing->contact_events().size() == apart->contact_events().size());
  }
}

Settings with_reports(Settings settings)
{
  settings.events = settings.pair_events = settings.moved_bodies = true;
  return settings;
}

} // namespace

TEST_CASE("a scene of balls takes at most two fifths of the memory that every feature takes")
{
  Settings specialised, everything;
  specialised.broadphase = everything.broadphase = Broadphase::grid;
  everything.specialise = false;
  const Scene scene = load_scene("spheres:n=20000");
  World balls(scene, specialised, {"tbb", {}}), whole(scene, everything, {"tbb", {}});
  balls.step();
  whole.step();
  CHECK(balls.memory().total_bytes() <= 0.4 * whole.memory().total_bytes());
}

TEST_CASE("shared memory changes no bit: scenes")
{
  for (const std::string &scene : small_scenes()) require_same_bits(load_scene(scene), {}, 12);
}

TEST_CASE("shared memory changes no bit: scenes with reports", "[sanitizer]")
{
  for (const std::string &scene : small_scenes()) require_same_bits(load_scene(scene), with_reports({}), 12);
  require_same_bits(imploding_boxes(), {}, 12);
}

TEST_CASE("shared memory changes no bit: solvers, broadphases, batchings and narrowphases")
{
  const Scene scene = load_scene("mixed:n=60"), shapes = load_scene("shapes:n=40");
  for (const Solver solver : choices<Solver>()) {
    Settings settings = settings_for(solver);
    require_same_bits(scene, settings, 25);
    settings.substeps = automatic_substeps;
    if (solver == Solver::soft_step) require_same_bits(scene, settings, 25);
  }
  Settings settings;
  for (const Broadphase broadphase : choices<Broadphase>()) {
    settings.broadphase = broadphase;
    require_same_bits(scene, settings, 25);
  }
  settings = {};
  for (const Batching batching : choices<Batching>()) {
    settings.batching = batching;
    settings.check = true;
    require_same_bits(scene, settings, 25);
  }
  settings = {};
  for (const Narrowphase narrowphase : choices<Narrowphase>()) {
    settings.narrowphase = narrowphase;
    require_same_bits(shapes, settings, 12);
  }
}

TEST_CASE("shared memory changes no bit: sleep, settled contacts, and steps without pairs")
{
  Settings settings;
  settings.sleeping = true;
  require_same_bits(load_scene("box-stack:n=20"), settings, 150);
  require_same_bits(load_scene("mixed:n=40"), with_reports(settings), 150);
  require_same_bits(load_scene("pyramid:rows=5"), {}, 150);
  require_same_bits(load_scene("spheres:n=27,height=20"), {}, 150);
}

namespace {

template <class T> T any_of_choices(Random &random)
{
  const auto all = choices<T>();
  return all[random.below(static_cast<uint32_t>(all.size()))];
}

Settings any_settings(Random &random)
{
  const auto tossed = [&] { return random.below(2) == 1; };
  Settings settings = settings_for(any_of_choices<Solver>(random));
  if (settings.solver == Solver::soft_step && tossed()) settings.substeps = automatic_substeps;
  settings.broadphase = any_of_choices<Broadphase>(random);
  settings.batching = any_of_choices<Batching>(random);
  settings.narrowphase = any_of_choices<Narrowphase>(random);
  settings.midphase = any_of_choices<Midphase>(random);
  settings.bounds = any_of_choices<Bounds>(random);
  settings.sleeping = tossed();
  settings.check = tossed();
  settings.events = tossed();
  settings.pair_events = tossed();
  settings.moved_bodies = tossed();
  settings.specialise = tossed() || tossed();
  return settings;
}

} // namespace

TEST_CASE("shared memory changes no bit: any scene with any settings")
{
  Random random(17);
  for (int round = 0; round < 300; ++round) {
    CAPTURE(round);
    const std::vector<std::string> &scenes = small_scenes();
    const Scene scene = load_scene(scenes[random.below(static_cast<uint32_t>(scenes.size()))]);
    require_same_bits(scene, any_settings(random), 1 + static_cast<int>(random.below(8)));
  }
}

TEST_CASE("a buffer that lies in memory which another still needs is found by its bits")
{
  const Scene scene = load_scene("box-stack:n=20");
  const auto apart = world_apart(scene, {}), wrong = world_that_shares(scene, {}, "serial");
  apart->step();
  wrong->step();
  REQUIRE(wrong->state_hash() == apart->state_hash());
  wrong->memory().share({{Buffer::constraint_normal, Buffer::constraint_points}});
  apart->step();
  wrong->step();
  CHECK(wrong->state_hash() != apart->state_hash());
}

TEST_CASE("what another buffer has overwritten is not read, and an observer keeps it")
{
  World world(load_scene("box-stack:n=20"), {}, {"serial", {}});
  world.step();
  const auto lost = [&] {
    std::vector<Buffer> buffers;
    for (size_t i = 0; i < buffer_count; ++i)
      if (!world.memory().is_held(buffer_at(i))) buffers.push_back(buffer_at(i));
    return buffers;
  };
  const std::vector<Buffer> before = lost();
  REQUIRE_FALSE(before.empty());
  for (const Buffer buffer : before) CHECK_THROWS_AS(world.read<uint32_t>(buffer), InputError);
  world.set_observer([](const Launch &) {});
  world.step();
  CHECK(lost().empty());
  for (const Buffer buffer : before) CHECK_NOTHROW(world.read<uint32_t>(buffer));
}
