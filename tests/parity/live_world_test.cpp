/* Worlds in which all changes: every kernel of every step has the same bits on every backend, whichever broadphase
 * finds the pairs. */
#include "tests/host/runtime/opencl/opencl_device.h"
#include "tests/parity/full_day.h"
#include "tests/parity/parity.h"
#include "tests/parity/scripted_day.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

ComparisonRequest day_on(std::vector<std::string> backends, uint64_t steps, const Settings &settings)
{
  ComparisonRequest request;
  request.settings = settings;
  request.backends = std::move(backends);
  request.steps = steps;
  request.before_step = ScriptedDay(3);
  return request;
}

void require_equal_day(const ComparisonRequest &request, const Scene &scene = yard())
{
  const Comparison comparison = compare_backends(scene, request);
  if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
  CHECK(comparison.steps == request.steps);
  CHECK(comparison.quarantined.empty());
}

Settings watched()
{
  Settings settings;
  settings.events = true;
  settings.pair_events = true;
  settings.check = true;
  return settings;
}

/* The hash of each step of a day. */
std::vector<uint64_t> hashes_of_day(const Settings &settings, uint64_t steps)
{
  World world(yard(), settings, {"serial", {}});
  const ScriptedDay day(5);
  std::vector<uint64_t> hashes;
  for (uint64_t step = 0; step < steps; ++step) {
    day(world, step);
    world.step();
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

/* A day in which something did not happen shows nothing. */
void require_happened(const Happened &all, uint64_t days)
{
  CHECK(all.creations > 20 * days);
  CHECK(all.removals > 20 * days);
  CHECK(all.properties > 40 * days);
  CHECK(all.gravity > 0);
  CHECK(all.restored >= 2 * days);
  CHECK(all.went_back > 3 * days);
}

void require_slept(const Happened &all, uint64_t days)
{
  CHECK(all.fell_asleep > 5 * days);
  CHECK(all.woke > 4 * days);
}

void require_equal_full_days(const std::vector<std::string> &backends, uint64_t days)
{
  const FullDay day(7);
  ComparisonRequest request = day_on(backends, days * FullDay::length, FullDay::settings());
  request.settings.pair_events = request.settings.check = true;
  request.before_step = day;
  require_equal_day(request);
  require_happened(day.happened(), days * backends.size());
  require_slept(day.happened(), days * backends.size());
  CHECK(day.happened().added_shapes > 10 * backends.size());
  CHECK(day.happened().removed_shapes > 5 * backends.size());
}

/* Five thousand steps with twenty thousand creations and removals, by the hash of each step. */
void require_equal_weeks(const Scene &scene, const std::vector<std::string> &backends, Changes changes)
{
  FullDay day(11, changes, 4);
  std::vector<std::unique_ptr<World>> worlds;
  for (const std::string &backend : backends)
    worlds.push_back(std::make_unique<World>(scene, FullDay::settings(), Placement{backend, {}, false}));
  for (uint64_t step = 0; step < 5000; ++step)
    for (const auto &world : worlds) {
      day(*world, step);
      world->step();
      CAPTURE(step, &world - worlds.data());
      REQUIRE(world->state_hash() == worlds.front()->state_hash());
      REQUIRE(world->statistics().asleep == worlds.front()->statistics().asleep);
    }
  require_happened(day.happened(), 62 * backends.size());
  require_slept(day.happened(), 62 * backends.size());
  CHECK(day.happened().creations + day.happened().removals > 20'000 * backends.size());
}

} // namespace

TEST_CASE("parity on CPU: a scripted day in which all of a world changes")
{
  require_equal_full_days({"serial", "serial:order=backward", "serial:order=shuffled", "tbb:threads=2,lanes=1",
                           "tbb:threads=2,lanes=8", "tbb:threads=7,lanes=4"},
                          2);
}

TEST_CASE("a scripted day in which all of a world changes, under sanitizers", "[sanitizer]")
{
  require_equal_full_days({"tbb:threads=2,lanes=4", "serial"}, 1);
}

TEST_CASE("parity on CPU: short days of every solver", "[sanitizer]")
{
  for (const Solver solver : choices<Solver>()) {
    CAPTURE(solver);
    Settings settings = settings_for(solver);
    settings.events = true;
    require_equal_day(day_on({"serial", "tbb:threads=2,lanes=4"}, 50, settings));
  }
}

TEST_CASE("a scripted day is the same with every broadphase", "[sanitizer]")
{
  const std::vector<uint64_t> expected = hashes_of_day(watched(), 60);
  for (const Broadphase broadphase : choices<Broadphase>()) {
    CAPTURE(broadphase);
    Settings settings = watched();
    settings.broadphase = broadphase;
    CHECK(hashes_of_day(settings, 60) == expected);
  }
}

TEST_CASE("a scripted day is the same with all features from the start", "[sanitizer]")
{
  Settings general = watched();
  general.specialise = false;
  CHECK(hashes_of_day(general, 60) == hashes_of_day(watched(), 60));
}

TEST_CASE("parity on OpenCL: a scripted day in which all changes that need no other kernels")
{
  require_pocl();
  const FullDay day(7, Changes::without_features);
  ComparisonRequest request = day_on({"tbb", "cl:pocl"}, FullDay::length, FullDay::settings());
  /* Each has a parity test of its own on PoCL; here their kernels would take the compiler as long as all others. */
  request.settings.events = request.settings.sleeping = false;
  request.before_step = day;
  require_equal_day(request, plain_yard());
  require_happened(day.happened(), 2);
}

TEST_CASE("parity on CPU: weeks in which all of a world changes", "[.long]")
{
  require_equal_weeks(yard(), {"serial", "tbb:threads=2,lanes=8", "tbb:threads=7,lanes=4"}, Changes::all);
}

TEST_CASE("parity on OpenCL: weeks in which all of a world changes", "[.long]")
{
  test_device();
  require_equal_weeks(yard(), {"tbb", "cl"}, Changes::all);
}
