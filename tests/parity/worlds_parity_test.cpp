/* A world of a batch has the bits of that world alone, on every backend. */
#include "tests/host/world/worlds.h"
#include "tests/parity/parity.h"

namespace tandem::parity {
namespace {

/* Scenes with a seed give each world of the batch poses of its own. */
const std::vector<std::string> &seeded_worlds()
{
  static const std::vector<std::string> scenes = {"falling-boxes:n=8,height=0",
                                                  "spheres:n=27,height=0,restitution=0.5",
                                                  "mixed:n=30",
                                                  "convex-hulls:n=20",
                                                  "shapes:n=24",
                                                  "thin-wall:n=12",
                                                  "compounds:n=12"};
  return scenes;
}

const std::vector<std::string> &other_worlds()
{
  static const std::vector<std::string> scenes = {every_shape(),
                                                  few_trees(),
                                                  "rolling",
                                                  "box-stack:n=10",
                                                  "bullet-stack:rows=2,height=2",
                                                  TANDEM_SOURCE_DIR "/tests/scenes/triggers.json"};
  return scenes;
}

void require_worlds_alone(const std::string &backend, uint32_t worlds, uint32_t steps, const Settings &settings = {})
{
  CAPTURE(backend);
  for (const std::string &scene : seeded_worlds()) {
    CAPTURE(scene);
    tests::BatchBesideWorlds(tests::seeded_scenes(scene, worlds), backend, settings).step(steps);
  }
  for (const std::string &scene : other_worlds()) {
    CAPTURE(scene);
    tests::BatchBesideWorlds(tests::varied_scenes(scene, worlds), backend, settings).step(steps);
  }
}

} // namespace

TEST_CASE("parity on CPU: worlds of a batch have the bits of worlds alone")
{
  require_worlds_alone("serial", 5, 25);
  require_worlds_alone("serial:order=backward", 3, 10);
  require_worlds_alone("tbb:threads=4", 7, 10);
  require_worlds_alone("tbb:threads=3,lanes=1", 3, 5);
}

/* Bodies in one place part along lines between places that follow from their numbers. */
TEST_CASE("parity on CPU: bodies of a batch that are in one place part as they do alone")
{
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes = {sphere_shape(0.2f), capsule_shape(0.1f, 0.15f), box_shape(0.2f, 0.15f, 0.1f)};
  for (uint32_t body = 0; body < 9; ++body) {
    scene.bodies.emplace_back();
    scene.bodies.back().shape = body % 3;
    scene.bodies.back().position = {body / 3 * 5.0, 1, 0};
  }
  for (const std::string backend : {"serial", "tbb:threads=2,lanes=8"})
    for (const auto &[one, other] : {std::pair(0u, 0u), {1u, 1u}, {2u, 2u}, {0u, 1u}, {0u, 2u}, {1u, 2u}}) {
      CAPTURE(backend, one, other);
      for (uint32_t body = 0; body < 9; ++body) scene.bodies[body].shape = body % 2 ? one : other;
      tests::BatchBesideWorlds(std::vector<Scene>(5, scene), backend).step(12);
    }
}

/* So many pairs, of which most touch, are set up in their own order, and those of one world in that of constraints. */
TEST_CASE("parity on CPU: set-up by pair has the bits of set-up by constraint")
{
  for (const std::string backend : {"serial", "tbb:threads=2"}) {
    CAPTURE(backend);
    tests::BatchBesideWorlds worlds(tests::seeded_scenes("mixed:n=60", 64), backend);
    worlds.step(100);
    uint32_t pairs = 0, touching = 0;
    for (const std::unique_ptr<World> &world : worlds.alone) {
      pairs += world->statistics().pairs;
      touching += world->statistics().manifolds;
    }
    CHECK(pairs > 4096);
    CHECK(2 * touching > pairs);
  }
}

/* PoCL takes a minute and a half to compile the kernels of each of these scenes for itself; so all share a program that
 * has every feature, but for one, whose kernels the test of a batch that starts on the CPU has, too. */
TEST_CASE("parity with PoCL: worlds of a batch have the bits of worlds alone")
{
  require_pocl();
  require_worlds_alone("cl:pocl", 5, 12, build_of_all_features());
  tests::BatchBesideWorlds(tests::seeded_scenes("falling-boxes:n=8,height=0", 5), "cl:pocl").step(12);
}

TEST_CASE("parity on CPU: worlds of a batch with other settings")
{
  std::vector<Settings> variants(8);
  variants[0].bounds = Bounds::tight;
  variants[1].midphase = Midphase::subtrees;
  variants[2].narrowphase = Narrowphase::gjk_epa;
  variants[3].narrowphase = Narrowphase::sat_split;
  variants[4].narrowphase = Narrowphase::cube_map;
  variants[5].support = Support::hill_climbing;
  variants[6].iterations = 2;
  variants[6].substeps = 1;
  variants[7].specialise = false;
  variants[7].narrowphase = Narrowphase::gjk_sampled;
  for (size_t variant = 0; variant < variants.size(); ++variant) {
    CAPTURE(variant);
    for (const char *scene : {"shapes:n=16", "convex-hulls:n=12", "compounds:n=8"})
      tests::BatchBesideWorlds(tests::seeded_scenes(scene, 3), "tbb:threads=2", variants[variant]).step(12);
    tests::BatchBesideWorlds(tests::varied_scenes(few_trees(), 3), "tbb:threads=2", variants[variant]).step(6);
  }
}

TEST_CASE("parity on CPU: worlds of a batch with all that a step can list", "[sanitizer]")
{
  Settings settings;
  settings.events = settings.pair_events = settings.moved_bodies = true;
  tests::BatchBesideWorlds both(tests::seeded_scenes("falling-boxes:n=12,height=0", 4), "tbb:threads=2", settings);
  for (uint32_t step = 0; step < 30; ++step) {
    both.step(1);
    const WorldEvents<ContactEvent> contacts = both.batch.contact_events();
    const WorldEvents<PairEvent> pairs = both.batch.pair_events();
    const WorldEvents<uint32_t> moved = both.batch.moved_bodies();
    for (uint32_t world = 0; world < 4; ++world) {
      CAPTURE(step, world);
      World &alone = *both.alone[world];
      const std::vector<uint32_t> moved_alone = alone.moved_bodies();
      CHECK(std::ranges::equal(moved.of(world), moved_alone));
      CHECK(std::ranges::equal(contacts.of(world), alone.contact_events(), [](const auto &a, const auto &b) {
        return a.kind == b.kind && a.a == b.a && a.b == b.b && a.points == b.points && a.impulse == b.impulse &&
               a.point == b.point && a.normal == b.normal;
      }));
      CHECK(std::ranges::equal(pairs.of(world), alone.pair_events(), [](const auto &a, const auto &b) {
        return a.kind == b.kind && a.a == b.a && a.b == b.b;
      }));
    }
  }
}

} // namespace tandem::parity
