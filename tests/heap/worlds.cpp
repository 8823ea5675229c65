/* worlds.cpp - every allocation of a world's life fails in turn: while it is made, in its steps, while it is read and written.
 *
 * After SQLite's out-of-memory tests. A world that cannot be made leaves nothing; a step happens whole or not at all, and the world goes
 * on with the bits of one that nothing ever happened to; whoever only asks changes nothing. */
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "minicl/dispatcher.h"
#include "tests/heap/attempt.h"
#include "tests/host/fault_scenes.h"

using namespace tandem;
using namespace tandem::fault_scenes;
using namespace tests::heap;

namespace {

const Placement serial{"serial", {}, false}, two_threads{"tbb:threads=2", {}, false};

/* Islands are solved by tasks of TBB that allocate, wherever the world is placed. */
std::vector<Case> heap_cases()
{
  std::vector<Case> all = cases();
  all.push_back({"spheres:n=8", with("direct", "sap", true), "islands in tasks"});
  all.push_back({TANDEM_SOURCE_DIR "/tests/scenes/few_hulls.json", with("jacobi", "brute-force", false), "hulls, split masses"});
  all.push_back({TANDEM_SOURCE_DIR "/tests/scenes/few_trees.json", with("soft-step", "grid", true), "meshes"});
  return all;
}

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

/* The step after `at` others. */
uint64_t fail_everywhere_in_step(const Scene &scene, const Settings &settings, const Placement &placement, size_t at, uint64_t stride)
{
  const std::vector<uint64_t> undisturbed = hashes_of(scene, settings, placement, static_cast<int>(at) + 3);
  uint64_t failures = 0;
  for (const bool once : {true, false})
    for (uint64_t nth = 0;; nth += stride) {
      CAPTURE(scene.name, settings.solver, settings.broadphase, placement.on, at, nth, once);
      const std::unique_ptr<World> world = world_at(scene, settings, placement, at);
      const Outcome outcome = attempt(nth, once, [&] { world->step(); });
      check_told(outcome);
      if (outcome.thrown) {
        ++failures;
        CHECK(world->statistics().steps == at);
        CHECK(world->quarantined().empty());
        if (settings.events) CHECK(world->contact_events().empty());
      }
      check_goes_on(*world, undisturbed, outcome.thrown ? at : at + 1);
      if (!outcome.struck) break;
    }
  CHECK(failures > 0);
  return failures;
}

} // namespace

TEST_CASE("heap: a world that cannot be made for want of any one allocation leaves nothing", "[sanitizer]")
{
  for (const Case &c : heap_cases())
    for (const Placement &placement : {serial, two_threads}) {
      CAPTURE(c.scene, c.what, placement.on);
      const Scene scene = load_scene(c.scene);
      const uint64_t expected = hashes_of(scene, c.settings, placement, 2).back();
      const uint64_t n = fail_everywhere([&] { World world(scene, c.settings, placement); });
      std::printf("creation %s %s: %lu\n", c.scene, placement.on.c_str(), (unsigned long)n);
      CHECK(hashes_of(scene, c.settings, placement, 2).back() == expected);
    }
}

TEST_CASE("heap: a step that fails for want of any one allocation leaves the state as it was, and the next ones their bits", "[sanitizer]")
{
  for (const Case &c : heap_cases())
    for (const Placement &placement : {serial, two_threads})
      for (const size_t at : {0, 2}) {
        const uint64_t n = fail_everywhere_in_step(load_scene(c.scene), c.settings, placement, at, 1);
        std::printf("step %s %s %zu: %lu\n", c.scene, placement.on.c_str(), at, (unsigned long)n);
      }
}
