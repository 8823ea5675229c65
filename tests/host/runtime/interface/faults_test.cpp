/* Every operation that may fail fails in turn, until a run succeeds: a step happens whole or not at all.
 *
 * The method is that of SQLite's out-of-memory tests. A failed call must name the operation, leave the state unchanged,
 * and leave a world that continues with the bits of a world without failures. */
#include <array>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "host/base/out_of_memory.h"
#include "host/runtime/interface/faults.h"
#include "tests/host/runtime/interface/fault_scenes.h"
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/share_of_faults.h"

using namespace tandem;
using namespace tandem::fault_scenes;

namespace {

const uint64_t share = tests::share_of_faults(1);

/* The operation that fails, counted from 0. `once`: only that one fails; else all later ones fail, too. only:
 * operations of one kind. */
struct Plan {
  uint64_t nth = 0, seen = 0;
  bool once = true;
  std::optional<faults::Site> only = std::nullopt;
};
Plan plan;
std::atomic<bool> struck{false};
std::array<uint64_t, 4> struck_at{}; /* by kind, over the whole run */

bool strike(faults::Site site)
{
  if (plan.only && *plan.only != site) return false;
  const uint64_t number = plan.seen++;
  const bool fails = plan.once ? number == plan.nth : number >= plan.nth;
  if (fails) ++struck_at[static_cast<size_t>(site)];
  struck = struck || fails;
  return fails;
}

/* Lets the n-th place fail for the length of a call. */
class Armed {
public:
  Armed(uint64_t nth, bool once, std::optional<faults::Site> only = {})
  {
    plan = {nth, 0, once, only};
    struck = false;
    faults::hook = strike;
  }
  ~Armed() { faults::hook = nullptr; }
};

struct Outcome {
  bool struck;
  std::string message; /* of what was thrown; empty if nothing */
};

Outcome attempt(uint64_t nth, bool once, const std::function<void()> &call, std::optional<faults::Site> only = {})
{
  Outcome outcome{false, ""};
  try {
    const Armed armed(nth, once, only);
    call();
  } catch (const std::exception &error) {
    outcome.message = error.what();
  }
  outcome.struck = struck;
  return outcome;
}

/* One line that says what could not be had. */
void check_message(const std::string &message)
{
  INFO(message);
  CHECK(message.size() > 30);
  CHECK(message.find('\n') == std::string::npos);
  CHECK((message.find("bytes") != std::string::npos || message.find("launch") != std::string::npos ||
         message.find("kernel") != std::string::npos || message.find("OpenCL device") != std::string::npos ||
         message.find("out of memory") != std::string::npos));
}

/* The step `at` fails at every place in turn, in one world: each failure leaves it as it was, and in the end it goes
 * on. */
void fail_everywhere_in_step(const Scene &scene, const Settings &settings, const Placement &placement, int at,
                             uint64_t stride, bool once)
{
  const std::vector<uint64_t> undisturbed = hashes_of(scene, settings, placement, at + 3);
  uint64_t failures = 0;
  for (uint64_t nth = 0;; nth += stride * share) {
    CAPTURE(scene.name, settings.solver, settings.broadphase, placement.on, at, nth, once);
    World world(scene, settings, placement);
    for (int k = 0; k < at; ++k) world.step();
    REQUIRE(world.state_hash() == undisturbed[at]);
    const Outcome outcome = attempt(nth, once, [&] { world.step(); });
    if (!outcome.struck) break;
    if (outcome.message.empty()) continue; /* mended on the way, as by building from source */
    ++failures;
    check_message(outcome.message);
    CHECK(outcome.message.find(fmt::format("step {}", at)) != std::string::npos);
    CHECK(outcome.message.find("state is that before the step") != std::string::npos);
    CHECK(world.statistics().steps == static_cast<uint64_t>(at));
    REQUIRE(world.state_hash() == undisturbed[at]);
    if (settings.events) CHECK(world.contact_events().empty());
    for (int k = at; k < at + 3; ++k) {
      world.step();
      REQUIRE(world.state_hash() == undisturbed[k + 1]);
    }
  }
  CHECK(failures > 0);
}

/* Lets calls that read or change a world between steps fail, and checks the hash of the state that they leave. */
void fail_everywhere_between_steps(const Scene &scene, const Settings &settings, const Placement &placement,
                                   const Placement &other, uint64_t stride)
{
  const std::vector<uint64_t> undisturbed = hashes_of(scene, settings, placement, 4);
  const std::vector<std::pair<const char *, std::function<void(World &)>>> calls = {
      {"bodies", [](World &world) { world.bodies(); }},
      {"rays", [](World &world) { world.cast_rays_all(some_rays()); }},
      {"boxes", [](World &world) { world.cast_boxes(a_box()); }},
      {"shape cast", swept_ball},
      {"overlaps", overlapped_by_ball},
      {"hash", [](World &world) { world.state_hash(); }},
      {"statistics", [](World &world) { world.statistics(); }},
      {"place", [&](World &world) { world.place(other); }},
      {"set_body", [](World &world) { world.set_body(0, world.bodies()[0]); }},
      {"events",
       [&](World &world) {
         if (settings.events) world.contact_events();
       }},
  };
  uint64_t failures = 0;
  for (const auto &[name, call] : calls)
    for (uint64_t nth = 0;; nth += stride * share) {
      CAPTURE(scene.name, placement.on, name, nth);
      World world(scene, settings, placement);
      world.step();
      world.step();
      const Outcome outcome = attempt(nth, true, [&] { call(world); });
      if (outcome.struck && !outcome.message.empty()) check_message(outcome.message);
      failures += outcome.struck && !outcome.message.empty();
      if (!outcome.struck) REQUIRE(outcome.message.empty());
      REQUIRE(world.state_hash() == undisturbed[2]);
      for (int k = 3; k <= 4; ++k) {
        world.step();
        REQUIRE(world.state_hash() == undisturbed[k]);
      }
      if (!outcome.struck) break;
    }
  CHECK(failures > 0);
}

void fail_everywhere_in_creation(const Scene &scene, const Settings &settings, const Placement &placement,
                                 uint64_t stride)
{
  const uint64_t expected = hashes_of(scene, settings, placement, 2).back();
  uint64_t failures = 0;
  for (uint64_t nth = 0;; nth += stride * share) {
    CAPTURE(scene.name, placement.on, nth);
    const Outcome outcome = attempt(nth, true, [&] { World world(scene, settings, placement); });
    if (!outcome.struck) break;
    if (outcome.message.empty()) continue;
    ++failures;
    check_message(outcome.message);
    CHECK(hashes_of(scene, settings, placement, 2).back() == expected);
  }
  CHECK(failures > 0);
}

} // namespace

TEST_CASE("a step that fails anywhere on the CPU leaves the state as it was, and the next ones their bits",
          "[sanitizer]")
{
  for (const Case &c : cases())
    for (const char *on : {"serial", "tbb:threads=2"}) {
      const Scene scene = load_scene(c.scene);
      const uint64_t stride = std::string(on) == "serial" ? 1 : 7;
      fail_everywhere_in_step(scene, c.settings, Placement{on, {}, false}, 0, 5 * stride, true);
      fail_everywhere_in_step(scene, c.settings, Placement{on, {}, false}, 2, stride, true);
      fail_everywhere_in_step(scene, c.settings, Placement{on, {}, false}, 2, 11 * stride, false);
    }
}

TEST_CASE("a step that fails while its buffers grow leaves the state as it was", "[sanitizer]")
{
  for (const Broadphase broadphase : {Broadphase::grid, Broadphase::trees, Broadphase::sap3}) {
    Settings settings = with(Solver::soft_step, broadphase, true);
    settings.substeps = 1;
    fail_everywhere_in_step(dense_cluster(52), settings, Placement{"serial", {}, false}, 0, 131, true);
    fail_everywhere_in_step(dense_cluster(52), settings, Placement{"tbb:threads=2", {}, false}, 0, 311, false);
  }
}

TEST_CASE("what fails between steps on the CPU leaves the state as it was", "[sanitizer]")
{
  for (const Case &c : cases())
    fail_everywhere_between_steps(load_scene(c.scene), c.settings, Placement{"tbb:threads=2", {}, false},
                                  Placement{"serial", {{"solve", "tbb:threads=3"}}, false}, 1);
}

TEST_CASE("a world whose creation fails anywhere on the CPU can be made the next time", "[sanitizer]")
{
  for (const Case &c : cases())
    fail_everywhere_in_creation(load_scene(c.scene), c.settings, Placement{"serial", {}, false}, 1);
}

TEST_CASE("out of memory names the buffer, its bytes, the bodies and the pairs", "[sanitizer]")
{
  World world(dense_cluster(52), {}, Placement{"serial", {}, false});
  const Outcome outcome = attempt(0, false, [&] { world.step(); });
  INFO(outcome.message);
  for (const char *part : {"step 0: ", "out of memory: buffer ", " needs ", " bytes of the host's memory",
                           "of 52 bodies", "room for 1024 pairs"})
    CHECK(outcome.message.find(part) != std::string::npos);
}

/* --- OpenCL: PoCL, which works in the host's memory, and the same with memory of its own, as a GPU has --- */

namespace {

/* The trial of whether memory is shared fails, so it is taken for a device that shares none. */
std::unique_ptr<World> world_with_own_memory(const Scene &scene, const Settings &settings)
{
  const Armed armed(0, true, faults::Site::transfer);
  return std::make_unique<World>(scene, settings, Placement{"cl:pocl", {}, false});
}

std::unique_ptr<World> world_on_pocl(const Scene &scene, const Settings &settings, bool shares)
{
  return shares ? std::make_unique<World>(scene, settings, Placement{"cl:pocl", {}, false})
                : world_with_own_memory(scene, settings);
}

/* One world, since programs take long to load: the first place of each kind fails, the second, the fourth and so on,
 * until the step gets through. */
void fail_on_pocl(const Case &c, bool shares)
{
  const Scene scene = load_scene(c.scene);
  const std::vector<uint64_t> undisturbed = hashes_of(scene, c.settings, Placement{"serial", {}, false}, 12);
  const std::unique_ptr<World> world = world_on_pocl(scene, c.settings, shares);
  size_t at = 0;
  for (const faults::Site site : {faults::Site::allocation, faults::Site::launch, faults::Site::transfer})
    for (int again = 0; again < 2; ++again, ++at)
      for (uint64_t nth = 0;; nth = 2 * nth + 1) {
        CAPTURE(c.scene, c.what, shares, at, nth, static_cast<int>(site));
        const Outcome outcome = attempt(
            nth, true, [&] { world->step(); }, site);
        if (!outcome.struck) break;
        check_message(outcome.message);
        CHECK(outcome.message.find("state is that before the step") != std::string::npos);
        REQUIRE(world->state_hash() == undisturbed[at]);
      }
  world->step();
  CHECK(world->state_hash() == undisturbed[at + 1]);
}

} // namespace

TEST_CASE("a step that fails on an OpenCL device leaves the state as it was, and the next ones their bits")
{
  parity::require_pocl();
  struck_at = {};
  fail_on_pocl(cases()[0], true);
  fail_on_pocl(cases()[1], false);
  for (const faults::Site site : {faults::Site::allocation, faults::Site::launch, faults::Site::transfer})
    CHECK(struck_at[static_cast<size_t>(site)] > 0);
}

TEST_CASE("growth that fails on an OpenCL device leaves the state as it was")
{
  parity::require_pocl();
  const Settings settings = with(Solver::soft_step, Broadphase::grid, true);
  const std::vector<uint64_t> undisturbed = hashes_of(dense_cluster(52), settings, Placement{"serial", {}, false}, 1);
  for (const bool shares : {true, false}) {
    const std::unique_ptr<World> world = world_on_pocl(dense_cluster(52), settings, shares);
    int failures = 0;
    for (uint64_t nth = 0;; nth = 2 * nth + 1) {
      CAPTURE(shares, nth);
      const Outcome outcome = attempt(nth, true, [&] { world->step(); });
      if (!outcome.struck) break;
      check_message(outcome.message);
      ++failures;
      REQUIRE(world->state_hash() == undisturbed[0]);
    }
    CHECK(failures > 3);
    CHECK(world->statistics().pairs == 52 * 51 / 2); /* more than there was room for */
    CHECK(world->state_hash() == undisturbed[1]);
  }
}

TEST_CASE(
    "a world on an OpenCL device that fails from some place on is refused in one line and can be made the next time")
{
  parity::require_pocl();
  const Case c = cases()[0];
  const Scene scene = load_scene(c.scene);
  struck_at = {};
  const Placement placement{"cl:pocl", {}, false};
  int failures = 0;
  for (uint64_t nth = 0;; nth = 2 * nth + 1) {
    CAPTURE(nth);
    const Outcome outcome = attempt(nth, false, [&] { World world(scene, c.settings, placement); });
    if (!outcome.struck) break;
    check_message(outcome.message);
    ++failures;
  }
  CHECK(failures > 3);
  CHECK(struck_at[static_cast<size_t>(faults::Site::build)] > 0);
  CHECK(hashes_of(scene, c.settings, placement, 2).back() ==
        hashes_of(scene, c.settings, Placement{"serial", {}, false}, 2).back());
}

TEST_CASE("a world on a device that fails for good can be destroyed")
{
  parity::require_pocl();
  for (const bool shares : {true, false}) {
    std::unique_ptr<World> world = world_on_pocl(load_scene("box-grid:nx=2,ny=2,nz=2"), {}, shares);
    world->step();
    const Armed armed(20, false);
    CHECK_THROWS_AS(world->step(), std::runtime_error);
    CHECK_NOTHROW(world.reset());
  }
}
